#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/files/swc_reader.h"
#include "pipeline/vessels/files/swc_writer.h"
#include "pipeline/vessels/vessel_orders.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/vessels/random_tree.h"

namespace octascope::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SwcWriter : public ::testing::Test {
protected:
  SwcTree read(std::string_view name, LengthUnit unit) {
    TreeReadOptions options;
    options.unit = unit;
    options.forest = true;
    auto found = read_swc(folder / name, options);
    if (found)
      return std::move(*found);
    ADD_FAILURE() << found.error().message;
    return {};
  }

  tests::ScratchFolder folder;
};

void expect_same(const VesselTree& found, const VesselTree& expected) {
  EXPECT_EQ(found.positions_mm, expected.positions_mm);
  EXPECT_EQ(found.radii_mm, expected.radii_mm);
  EXPECT_EQ(found.parents, expected.parents);
  EXPECT_EQ(found.orders, expected.orders);
  EXPECT_EQ(found.branches, expected.branches);
}

TEST_F(SwcWriter, writes_what_is_read_back_to_the_last_bit) {
  for (const std::size_t segments : {1U, 125U, 20'000U}) {
    const VesselTree tree = tests::random_tree(segments, tests::fresh_seed());
    for (const LengthUnit unit : {LengthUnit::um, LengthUnit::mm}) {
      const auto written = write_swc(folder / "tree.swc", tree, unit);
      ASSERT_TRUE(written) << written.error().message;
      const SwcTree found = read("tree.swc", unit);
      expect_same(found.tree, tree);
      EXPECT_TRUE(found.counts.orders_in_file);
      EXPECT_EQ(found.counts.late_parents, 0U);
    }
  }
}

TEST_F(SwcWriter, writes_what_others_read) {
  VesselTree tree;
  tree.positions_mm = {{0, 0, 0}, {0.0125F, -1.5F, 2}};
  tree.radii_mm = {0.1F, 0.0045F};
  tree.parents = {no_parent, 0};
  tree.orders = {11, 10};
  tree.branches = {VesselBranch::lad, VesselBranch::unknown};
  ASSERT_TRUE(write_swc(folder / "tree.swc", tree));
  EXPECT_EQ(tests::whole_file(folder / "tree.swc"),
            "# octascope vessel tree: id type x y z radius parent\n"
            "# types 16, 17, 18: RCA, LAD, LCX; 0: unknown\n"
            "# octascope unit um\n"
            "# octascope roots 1\n"
            "# octascope orders ba\n"
            "1 17 0 0 0 100 -1\n"
            "2 0 12.5 -1500 2000 4.5 1\n");
}

// Somebody took a row out, or brought the rows into another sequence with the comments left where
// they were: then the orders of the file are nobody's.
TEST_F(SwcWriter, orders_that_do_not_fit_their_rows_are_computed_anew) {
  VesselTree tree = tests::random_tree(300, 5);
  ASSERT_TRUE(write_swc(folder / "tree.swc", tree));
  std::string text = tests::whole_file(folder / "tree.swc");
  text.erase(text.rfind('\n', text.size() - 2) + 1); // the last row
  folder.write("tree.swc", text);
  const SwcTree found = read("tree.swc", LengthUnit::um);
  EXPECT_FALSE(found.counts.orders_in_file);
  VesselTree anew = found.tree;
  assign_vessel_orders(anew);
  EXPECT_EQ(found.tree.orders, anew.orders);
  EXPECT_NE(found.tree.orders, std::vector<std::uint8_t>(found.tree.nodes(), 0));
}

TEST_F(SwcWriter, sorts_orders_with_their_rows) {
  folder.write("late.swc",
               "# octascope orders 123\n1 0 5 0 0 1 3\n2 0 6 0 0 1 1\n3 0 7 0 0 1 -1\n");
  EXPECT_THAT(read("late.swc", LengthUnit::um).tree.orders, ElementsAre(3, 1, 2));
}

TEST_F(SwcWriter, refuses_trees_that_could_not_be_read_back) {
  const VesselTree good = tests::random_tree(10, 1);
  const auto message = [&](auto spoil) {
    VesselTree tree = good;
    spoil(tree);
    const auto written = write_swc(folder / "bad.swc", tree);
    return written ? "" : written.error().message;
  };
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message([](VesselTree& t) { t = {}; }),
              HasSubstr("bad.swc: cannot be written: found 0 nodes"));
  EXPECT_THAT(message([](VesselTree& t) { t.orders.pop_back(); }), HasSubstr("different lengths"));
  EXPECT_THAT(message([](VesselTree& t) { t.parents[4] = 4; }),
              HasSubstr("node 4 with the parent 4"));
  EXPECT_THAT(message([](VesselTree& t) { t.positions_mm[2][1] = nan; }), HasSubstr("node 2"));
  EXPECT_THAT(message([](VesselTree& t) { t.radii_mm[3] = -1; }), HasSubstr("node 3"));
  EXPECT_THAT(message([](VesselTree& t) { t.orders[5] = 12; }), HasSubstr("node 5 of order 12"));
  EXPECT_EQ(folder.count(), 0);
  EXPECT_THAT(write_swc(folder / "nowhere" / "t.swc", good).error().message,
              HasSubstr("No such file"));
}

} // namespace
} // namespace octascope::pipeline

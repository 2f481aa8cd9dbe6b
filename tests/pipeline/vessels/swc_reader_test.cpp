// The rules of a strict SWC reader, one after the other, each with its message.
#include <clocale>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/files/swc_reader.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

// Three nodes of a vessel and a branch, in micrometres.
const std::string small = "1 16 0 0 0 100 -1\n"
                          "2 16 1000 0 0 90 1\n"
                          "3 16 2000 0 0 80 2\n"
                          "4 16 1000 500 0 40 2\n";

SwcTree good(std::string_view text, const TreeReadOptions& options = {}) {
  return tests::must(parse_swc(text, "v.swc", options));
}

// The message without the file's name: place, found and expected.
std::string refusal(std::string_view text, const TreeReadOptions& options = {}) {
  const auto read = parse_swc(text, "v.swc", options);
  if (read) {
    ADD_FAILURE() << "not refused: " << text;
    return {};
  }
  EXPECT_EQ(read.error().code, hal::ErrorCode::bad_data);
  EXPECT_THAT(read.error().message, testing::StartsWith("v.swc:"));
  return read.error().message.substr(6);
}

TreeReadOptions forest() {
  TreeReadOptions options;
  options.forest = true;
  return options;
}

TEST(SwcReader, reads_a_tree) {
  const SwcTree read = good(small);
  ASSERT_EQ(read.tree.nodes(), 4U);
  EXPECT_THAT(read.tree.parents, ElementsAre(no_parent, 0U, 1U, 1U));
  EXPECT_THAT(read.tree.radii_mm, ElementsAre(0.1F, 0.09F, 0.08F, 0.04F));
  EXPECT_THAT(read.tree.positions_mm[3], ElementsAre(1.0F, 0.5F, 0.0F));
  EXPECT_EQ(read.tree.branches, std::vector<VesselBranch>(4, VesselBranch::rca));
  EXPECT_EQ(read.tree.orders.size(), 4U);
  EXPECT_EQ(read.counts.rows, 4U);
  EXPECT_EQ(read.counts.nodes, 4U);
  EXPECT_EQ(read.counts.roots, 1U);
  EXPECT_FALSE(read.counts.orders_in_file);
}

// Rule 1.
TEST(SwcReader, takes_every_way_of_laying_out_rows) {
  const SwcTree plain = good(small);
  const SwcTree read = good("\xEF\xBB\xBF# a comment\r\n"
                            "\r\n"
                            "  1\t16 0 0 0  100 -1 \t\r\n"
                            "2 16 1e3 0.0 -0 90. 1 # the trunk\n"
                            "   \t\n"
                            "\t# another\n"
                            "3 16 +2000 .0 0 8.0e1 2\n"
                            "4 16 1000 500 0 40 2"); // no line feed
  EXPECT_EQ(read.tree.positions_mm, plain.tree.positions_mm);
  EXPECT_EQ(read.tree.radii_mm, plain.tree.radii_mm);
  EXPECT_EQ(read.tree.parents, plain.tree.parents);
  EXPECT_EQ(read.counts.comments, 2U);
  EXPECT_EQ(read.counts.blanks, 2U);
  EXPECT_EQ(read.counts.rows, 8U); // = nodes + comments + blanks
}

TEST(SwcReader, refuses_rows_of_fewer_or_more_than_seven_tokens) {
  EXPECT_EQ(refusal("1 16 0 0 0 100 -1\n2 16 1 2 3\n"),
            "2:11: found 5 of 7 numbers, expected the radius here: id type x y z radius parent");
  EXPECT_THAT(refusal("1 16 0 0 0 100 -1\n2 16 0 0 0 1 # 1\n"),
              HasSubstr("2:14: found 6 of 7 numbers, expected the parent here"));
  EXPECT_EQ(refusal("1 16 0 0 0 100 -1 8\n"),
            "1:19: found \"8\" behind the parent, expected the end of the row after 7 numbers");
  EXPECT_THAT(refusal("1,16,0,0,0,100,-1\n"), HasSubstr("1:1: found \"1,16,0,0,0,100,-1\" as id"));
  EXPECT_THAT(refusal("1 16 0 0 0 100 -1\r2 16 0 0 0 100 1\r"), HasSubstr("1:16: found \"-1?2\""));
}

// Rule 2.
TEST(SwcReader, refuses_what_is_no_finite_number) {
  for (const char* number : {"nan", "NaN", "inf", "-inf", "infinity", "0x10", "1,5", "1.5.2", "1e",
                             "--1", "1e5mm", "-", "1d3", "١"})
    EXPECT_EQ(refusal(fmt::format("1 16 {} 0 0 100 -1\n", number)),
              fmt::format("1:6: found \"{}\" as x, expected a finite decimal number", number));
  for (const char* number : {"1e39", "1e999", "-1e13"})
    EXPECT_EQ(
        refusal(fmt::format("1 16 0 0 {} 100 -1\n", number)),
        fmt::format("1:10: found \"{}\" as z, expected a number of at most 1e+09 mm", number));
  EXPECT_THAT(
      refusal("1 16 0 0 0 nan -1\n"),
      HasSubstr("1:12: found \"nan\" as radius, expected a finite decimal number, 0 or more"));
}

TEST(SwcReader, reads_alike_in_every_locale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C"}) {
    if (std::setlocale(LC_ALL, name) == nullptr)
      continue;
    EXPECT_EQ(good("1 0 1500.5 0 0 1 -1\n").tree.positions_mm[0][0], 1.5005F) << name;
  }
  std::setlocale(LC_ALL, before.c_str());
}

// Rule 3.
TEST(SwcReader, refuses_ids_that_are_none) {
  for (const char* id : {"-1", "1.0", "4294967295", "99999999999999999999", "one", "+1"})
    EXPECT_EQ(refusal(fmt::format("{} 16 0 0 0 100 -1\n", id)),
              fmt::format("1:1: found \"{}\" as id, expected a whole number, 0 to 4294967294", id));
  EXPECT_EQ(good("0 0 0 0 0 1 -1\n4294967294 0 1 0 0 1 0\n").counts.nodes, 2U);
}

TEST(SwcReader, refuses_an_id_for_the_second_time) {
  // Ids close together, and far apart: two ways to find a row by its id.
  EXPECT_EQ(refusal("1 0 0 0 0 1 -1\n# 2\n 2 0 0 0 0 1 1\n3 0 0 0 0 1 2\n  2 0 0 0 0 1 3\n"),
            "5:3: found the id 2 for the second time, expected each id once");
  EXPECT_EQ(refusal("1 0 0 0 0 1 -1\n4000000000 0 0 0 0 1 1\n\n4000000000 0 0 0 0 1 1\n"),
            "4:1: found the id 4000000000 for the second time, expected each id once");
}

TEST(SwcReader, refuses_parents_that_are_none) {
  EXPECT_EQ(refusal(small + "5 16 0 0 0 1 5\n"),
            "5:14: found \"5\" as parent, expected another node's id, or -1: no node is its own "
            "parent");
  EXPECT_EQ(refusal(small + "5 16 0 0 0 1 77\n"),
            "5:14: found the parent 77, which no row has, expected the id of a row, or -1");
  EXPECT_EQ(refusal("10 0 0 0 0 1 -1\n12 0 0 0 0 1 11\n"),
            "2:14: found the parent 11, which no row has, expected the id of a row, or -1");
  EXPECT_EQ(refusal("10 0 0 0 0 1 -1\n4000000012 0 0 0 0 1 11\n"),
            "2:22: found the parent 11, which no row has, expected the id of a row, or -1");
  for (const char* parent : {"-2", "-10", "-1.0", "1.5", "x"})
    EXPECT_EQ(
        refusal(fmt::format("1 0 0 0 0 1 {}\n", parent)),
        fmt::format("1:13: found \"{}\" as parent, expected -1 or an id, 0 to 4294967294", parent));
}

TEST(SwcReader, names_a_member_of_a_cycle) {
  EXPECT_EQ(refusal(small + "7 0 0 0 0 1 9\n8 0 0 0 0 1 7\n9 0 0 0 0 1 8\n10 0 0 0 0 1 9\n"),
            "5:13: found a cycle of 3 nodes, 7 among them, expected parents that lead to a root");
  EXPECT_EQ(refusal("1 0 0 0 0 1 2\n2 0 0 0 0 1 1\n"),
            "1:13: found a cycle of 2 nodes, 1 among them, expected parents that lead to a root");
}

// Rule 4.
TEST(SwcReader, sorts_rows_whose_parent_comes_later) {
  const std::string late = "4 16 1000 500 0 40 2\n3 16 2000 0 0 80 2\n2 17 1000 0 0 90 1\n"
                           "1 18 0 0 0 100 -1\n";
  const SwcTree read = good(late);
  EXPECT_EQ(read.counts.late_parents, 3U);
  EXPECT_THAT(read.tree.parents, ElementsAre(no_parent, 0U, 1U, 1U));
  EXPECT_THAT(read.tree.radii_mm, ElementsAre(0.1F, 0.09F, 0.04F, 0.08F));
  EXPECT_THAT(read.tree.branches, ElementsAre(VesselBranch::lcx, VesselBranch::lad,
                                              VesselBranch::rca, VesselBranch::rca));
  TreeReadOptions strict;
  strict.strict = true;
  EXPECT_EQ(refusal("# late\n" + late, strict),
            "2:20: found the parent 2 in a later row, expected it in front of its children "
            "(--strict)");
  EXPECT_EQ(good(small, strict).counts.late_parents, 0U);
}

// Rule 5.
TEST(SwcReader, wants_one_root_unless_a_forest_is_allowed) {
  const std::string two = small + "5 17 9 9 9 1 -1\n";
  EXPECT_EQ(refusal(two), "5:14: found a second root, expected one; several are allowed as a "
                          "forest (--forest)");
  EXPECT_EQ(good(two, forest()).counts.roots, 2U);
}

TEST(SwcReader, takes_as_many_roots_as_a_file_of_ours_says) {
  const std::string two = "1 0 0 0 0 1 -1\n2 0 9 0 0 1 -1\n";
  EXPECT_EQ(good("# octascope roots 2\n" + two).counts.roots, 2U);
  for (const char* other : {"1", "3", "", "-2", "two", "99999999999999999999"})
    EXPECT_THAT(refusal("# octascope roots " + std::string{other} + "\n" + two),
                HasSubstr("found a second root"))
        << other;
  EXPECT_EQ(good("# octascope roots 2\n1 0 0 0 0 1 -1\n").counts.roots, 1U);
}

TEST(SwcReader, takes_any_type) {
  const SwcTree read = good("1 0 0 0 0 1 -1\n2 0 1 0 0 1 1\n3 16 2 0 0 1 2\n4 17 3 0 0 1 3\n"
                            "5 18 4 0 0 1 4\n6 19 5 0 0 1 5\n7 4294967295 6 0 0 1 6\n");
  EXPECT_THAT(read.counts.types, ElementsAre(Pair(0U, 2U), Pair(16U, 1U), Pair(17U, 1U),
                                             Pair(18U, 1U), Pair(19U, 1U), Pair(4294967295U, 1U)));
  using enum VesselBranch;
  EXPECT_THAT(read.tree.branches, ElementsAre(unknown, unknown, rca, lad, lcx, unknown, unknown));
  EXPECT_EQ(refusal("1 -3 0 0 0 1 -1\n"),
            "1:3: found \"-3\" as type, expected a whole number, 0 to 4294967295");
}

// Rule 6.
TEST(SwcReader, refuses_negative_radii) {
  EXPECT_EQ(refusal("1 0 0 0 0 -0.5 -1\n"),
            "1:11: found \"-0.5\" as radius, expected a finite decimal number, 0 or more");
}

TEST(SwcReader, gives_nodes_without_a_radius_their_parents) {
  const std::string zeros = "1 0 0 0 0 0 -1\n2 0 1 0 0 7 1\n3 0 2 0 0 0 2\n4 0 3 0 0 -0.0 3\n"
                            "5 0 4 0 0 2 4\n";
  const SwcTree read = good(zeros);
  EXPECT_EQ(read.counts.zero_radii, 3U);
  EXPECT_THAT(read.tree.radii_mm, ElementsAre(0.002F, 0.007F, 0.007F, 0.007F, 0.002F));
  TreeReadOptions refuse;
  refuse.zero_radius = ZeroRadius::refuse;
  EXPECT_THAT(refusal(zeros, refuse), HasSubstr("found 3 nodes of radius 0, expected none"));
  EXPECT_THAT(refusal("1 0 0 0 0 0 -1\n"), HasSubstr("found no radius but 0 in 1 nodes"));
}

TEST(SwcReader, keeps_coincident_nodes_and_counts_them) {
  const SwcTree read = good("1 0 5 5 5 1 -1\n2 0 5 5 5 1 1\n3 0 6 5 5 1 2\n4 0 6 5 5 1 3\n");
  EXPECT_EQ(read.tree.nodes(), 4U);
  EXPECT_EQ(read.counts.coincident, 2U);
}

// Rule 7.
TEST(SwcReader, takes_the_unit_that_is_declared) {
  TreeReadOptions mm;
  mm.unit = LengthUnit::mm;
  EXPECT_EQ(good("1 0 1.5 0 0 0.25 -1\n", mm).tree.radii_mm[0], 0.25F);
  EXPECT_EQ(good("1 0 1.5 0 0 0.25 -1\n").tree.radii_mm[0], 0.00025F);
  EXPECT_EQ(refusal("# octascope unit um\n1 0 0 0 0 1 -1\n", mm),
            "1:18: found \"um\", the unit it was written in, expected mm, the unit declared for it "
            "(--unit)");
}

// Rule 8.
TEST(SwcReader, tells_the_first_wrong_row) {
  EXPECT_THAT(refusal("\xEF\xBB\xBF# one\n\n1 0 0 0 0 1 -1\n 2 0 0 x 0 1 1\n3 0 0 0 y 1 1\n"),
              HasSubstr("4:8: found \"x\" as y"));
  EXPECT_THAT(refusal("\xEF\xBB\xBF-1 0 0 0 0 1 -1\n"), HasSubstr("1:1: found \"-1\" as id"));
}

TEST(SwcReader, refuses_files_without_a_node) {
  for (const char* text : {"", "# nothing\n", "\n\n"})
    EXPECT_THAT(refusal(text), HasSubstr("found the end of the file and no node"));
}

TEST(SwcReader, shortens_what_it_shows) {
  EXPECT_LT(refusal(std::string(100'000, '7') + " 0 0 0 0 1 -1\n").size(), 200U);
}

// Rule 9.
TEST(SwcReader, keeps_to_its_limits) {
  TreeReadOptions options;
  options.limits.rows = 3;
  EXPECT_EQ(refusal(small, options), "4:1: found one node more, expected the end: 3 are the limit");
  options.limits.rows = 4;
  EXPECT_EQ(good(small, options).counts.nodes, 4U);
  options.limits.bytes = small.size() - 1;
  EXPECT_THAT(refusal(small, options), HasSubstr("bytes, more than the limit of"));
}

// A million nodes, each the parent of the next and of the one before: nothing may recurse.
TEST(SwcReader, reads_long_chains_in_both_directions) {
  constexpr int nodes = 1'000'000;
  std::string down;
  std::string up;
  for (int i = 1; i <= nodes; ++i) {
    down += fmt::format("{} 16 {} 0 0 5 {}\n", i, i % 1000, i == 1 ? -1 : i - 1);
    up += fmt::format("{} 16 {} 0 0 5 {}\n", i, i % 1000, i == nodes ? -1 : i + 1);
  }
  const SwcTree first = good(down);
  EXPECT_EQ(first.counts.late_parents, 0U);
  const SwcTree second = good(up);
  EXPECT_EQ(second.counts.late_parents, nodes - 1U);
  EXPECT_EQ(second.tree.parents, first.tree.parents);
  up += "2000000 0 0 0 0 5 2000001\n2000001 0 0 0 0 5 2000000\n";
  EXPECT_THAT(refusal(up), HasSubstr("found a cycle of 2 nodes, 2000000 among them"));
}

// Random trees with random ids in random sequence: the same tree comes out, by ids.
TEST(SwcReader, reads_rows_in_any_sequence) {
  std::mt19937_64 random{tests::fresh_seed()};
  for (const std::uint64_t spread : {1U, 3U, 1000U}) {
    constexpr std::size_t nodes = 3000;
    std::vector<std::uint64_t> ids{random() % 50};
    std::vector<std::string> rows{fmt::format("{} 0 0 0 0 1 -1\n", ids[0])};
    std::vector<std::size_t> parents{0};
    for (std::size_t i = 1; i < nodes; ++i) {
      ids.push_back(ids.back() + 1 + random() % spread);
      parents.push_back(random() % i);
      rows.push_back(fmt::format("{} 0 {} 0 0 1 {}\n", ids[i], i * 1000, ids[parents[i]]));
    }
    std::ranges::shuffle(rows, random);
    std::string text;
    for (const std::string& row : rows)
      text += row;
    const SwcTree read = good(text);
    ASSERT_EQ(read.tree.nodes(), nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
      const auto node = static_cast<std::size_t>(read.tree.positions_mm[i][0]);
      const std::uint32_t parent = read.tree.parents[i];
      if (node == 0) {
        ASSERT_EQ(parent, no_parent);
        continue;
      }
      ASSERT_LT(parent, i);
      ASSERT_EQ(static_cast<std::size_t>(read.tree.positions_mm[parent][0]), parents[node]);
    }
  }
}

// Files are read in pieces of 4 MiB: rows across their ends, the last without a line feed, messages
// of rows far inside.
TEST(SwcReader, reads_files_as_it_reads_text) {
  const tests::ScratchFolder folder;
  std::string text = "# large\n";
  for (int i = 1; text.size() < 9'500'000; ++i)
    text += fmt::format("{} 16 {}.{:0{}} 0 0 5.25 {}\n", i, i % 77, i % 10, 1 + i % 9,
                        i == 1 ? -1 : i / 2);
  text += "9000000 0 1 2 3 4 1";
  std::vector<double> progress;
  TreeReadOptions options;
  options.progress = [&](double done) { progress.push_back(done); };
  const auto read = read_swc(folder.write("large.swc", text), options);
  ASSERT_TRUE(read) << read.error().message;
  const SwcTree expected = good(text);
  EXPECT_EQ(read->tree.positions_mm, expected.tree.positions_mm);
  EXPECT_EQ(read->tree.parents, expected.tree.parents);
  EXPECT_EQ(read->counts.rows, expected.counts.rows);
  EXPECT_TRUE(std::ranges::is_sorted(progress));
  EXPECT_GE(progress.size(), 3U);
  EXPECT_EQ(progress.back(), 1.0);

  const auto lines = static_cast<std::uint64_t>(std::ranges::count(text, '\n')) + 1;
  const auto bad = read_swc(folder.write("bad.swc", text + "\n\n   9000000 0 1 2 3 4 1"));
  ASSERT_FALSE(bad);
  EXPECT_THAT(
      bad.error().message,
      HasSubstr(fmt::format("bad.swc:{}:4: found the id 9000000 for the second", lines + 2)));
}

TEST(SwcReader, says_what_is_wrong_with_a_file) {
  const tests::ScratchFolder folder;
  const auto message = [](const std::filesystem::path& file, const TreeReadOptions& options = {}) {
    return tests::error_of(read_swc(file, options)).message;
  };
  EXPECT_THAT(message(folder / "nowhere.swc"), HasSubstr("nowhere.swc: cannot be opened: No such"));
  EXPECT_THAT(message(folder.path()), HasSubstr("is a directory, expected an SWC file"));
  EXPECT_THAT(message("/dev/null"), HasSubstr("is not a regular file"));
  EXPECT_THAT(message(folder.write("empty.swc", "")), HasSubstr("empty.swc:1:1: found the end"));
  TreeReadOptions limited;
  limited.limits.bytes = 10;
  EXPECT_THAT(message(folder.write("small.swc", small), limited),
              HasSubstr("bytes, more than the limit of 10"));
  EXPECT_THAT(message(folder.write("long.swc", std::string(5 << 20, ' '))),
              HasSubstr("found a line of more than 4194304 bytes"));
}

} // namespace
} // namespace octascope::pipeline

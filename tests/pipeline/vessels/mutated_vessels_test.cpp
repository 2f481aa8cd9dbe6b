// Whatever is in a file of vessels, its reader gives a tree that keeps its promises or a message
// that names the file (mutated_files_test.cpp). New random files in every run.
#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "pipeline/vessels/clusters/cluster_file.h"
#include "pipeline/vessels/clusters/cluster_unpacker.h"
#include "pipeline/vessels/files/swc_reader.h"
#include "pipeline/vessels/files/vtp_reader.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/program/built_places.h"
#include "tests/support/vessels/random_tree.h"

namespace octascope::pipeline {
namespace {

namespace fs = std::filesystem;

#ifdef OCTASCOPE_SANITIZED
constexpr int usual_rounds = 4'000;
#else
constexpr int usual_rounds = 20'000;
#endif

void expect_a_tree(const VesselTree& tree) {
  ASSERT_GT(tree.nodes(), 0U);
  ASSERT_EQ(tree.radii_mm.size(), tree.nodes());
  ASSERT_EQ(tree.parents.size(), tree.nodes());
  ASSERT_EQ(tree.orders.size(), tree.nodes());
  ASSERT_EQ(tree.branches.size(), tree.nodes());
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    ASSERT_TRUE(tree.parents[i] == no_parent || tree.parents[i] < i);
    ASSERT_GT(tree.radii_mm[i], 0);
    ASSERT_LE(tree.radii_mm[i], largest_vessel_length_mm);
    ASSERT_LE(tree.orders[i], highest_vessel_order);
    for (const float mm : tree.positions_mm[i])
      ASSERT_LE(std::fabs(mm), largest_vessel_length_mm);
  }
}

// `read` gives the message of what it refuses, and checks what it does not.
void try_all(const std::string& good, int rounds,
             const std::function<std::string(std::string_view)>& read) {
  ASSERT_EQ(read(good), "") << "the good file";
  std::mt19937_64 generator{tests::fresh_seed()};
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    const std::string message = read(tests::mutate(good, generator));
    if (!message.empty()) {
      ++refused;
      ASSERT_TRUE(message.starts_with("name:")) << "round " << round << ": " << message;
      ASSERT_LT(message.size(), 600U) << "round " << round << ": " << message;
      ASSERT_EQ(message.find('\n'), std::string::npos) << "round " << round << ": " << message;
    }
    if (testing::Test::HasFatalFailure())
      return;
  }
  EXPECT_GT(refused, rounds / 20); // else nothing was tried
  EXPECT_LT(refused, rounds);
}

TEST(MutatedVessels, as_swc) {
  for (const bool late : {false, true}) {
    std::string good = "# octascope unit um\r\n# octascope roots 1\n# octascope orders 2211003\n";
    for (int i = 1; i <= 7; ++i)
      good += fmt::format("{} {} {}.5 -{}e-1 0 {} {}\n", i * (late ? 7 : 1), 15 + i, i, i, 8.0 - i,
                          late ? (i == 7 ? -1 : 7 * (i + 1)) : (i == 1 ? -1 : i / 2));
    try_all(good, 5 * usual_rounds, [](std::string_view text) -> std::string {
      const auto read = parse_swc(text, "name");
      if (!read)
        return read.error().message;
      expect_a_tree(read->tree);
      EXPECT_EQ(read->counts.rows,
                read->counts.nodes + read->counts.comments + read->counts.blanks);
      return {};
    });
  }
}

// Without its checksums set right again few changes pass; takes_no_harm_from_forgeries
// (cluster_file_test.cpp) sets them right.
TEST(MutatedVessels, as_clusters) {
  const VesselTree tree = tests::random_tree(40, 3);
  const ClusterArrays arrays = build_clusters(tree);
  const tests::ScratchFolder folder;
  ASSERT_TRUE(write_cluster_file(folder / "good.vessels", arrays.view(),
                                 facts_of(tree, arrays.error, "by hand")));
  const auto read = [](std::string_view text) -> std::string {
    std::vector<std::uint64_t> aligned(text.size() / 8 + 1);
    std::ranges::copy(text, reinterpret_cast<char*>(aligned.data()));
    const auto content =
        read_cluster_bytes(std::as_bytes(std::span{aligned}).first(text.size()), "name");
    if (!content)
      return content.error().message;
    const auto unpacked = unpack_tree(content->clusters);
    EXPECT_TRUE(unpacked);
    EXPECT_EQ(unpacked->nodes(), content->facts.nodes - content->facts.lone_roots);
    return {};
  };
  const std::string good = tests::whole_file(folder / "good.vessels");
  ASSERT_EQ(read(good), "");
  std::mt19937_64 generator{tests::fresh_seed()};
  for (int round = 0; round < usual_rounds; ++round) {
    const std::string bad = tests::mutate(good, generator);
    const std::string message = read(bad);
    if (message.empty())
      ASSERT_EQ(bad, good) << "round " << round;
    else
      ASSERT_TRUE(message.starts_with("name:")) << "round " << round << ": " << message;
  }
}

TEST(MutatedVessels, as_vtp) {
  const fs::path folder = tests::source_folder() / "tests/centrelines";
  for (const auto& entry : fs::directory_iterator{folder}) {
    SCOPED_TRACE(entry.path());
    try_all(tests::whole_file(entry.path()), usual_rounds,
            [](std::string_view text) -> std::string {
              const auto read = parse_vtp(text, "name");
              if (!read)
                return read.error().message;
              expect_a_tree(read->tree);
              return {};
            });
  }
}

} // namespace
} // namespace octascope::pipeline

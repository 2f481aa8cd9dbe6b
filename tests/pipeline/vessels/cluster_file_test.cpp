#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/clusters/cluster_checker.h"
#include "pipeline/vessels/clusters/cluster_file.h"
#include "pipeline/vessels/clusters/cluster_file_format.h"
#include "pipeline/vessels/clusters/cluster_unpacker.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"
#include "tests/support/vessels/vessel_trees.h"

namespace octascope::pipeline {
namespace {

using ::testing::HasSubstr;

// A file's bytes where they may be changed, aligned as a mapping is.
class FileBytes {
public:
  explicit FileBytes(std::string_view bytes) : words_(bytes.size() / 8 + 1), size_{bytes.size()} {
    std::memcpy(words_.data(), bytes.data(), size_);
  }

  char* data() { return reinterpret_cast<char*>(words_.data()); }
  ClusterFileHeader& header() { return *reinterpret_cast<ClusterFileHeader*>(words_.data()); }
  VesselCluster& cluster(std::size_t i) {
    return reinterpret_cast<VesselCluster*>(data() + parts_of(header()).clusters_at)[i];
  }
  PackedNode& node(std::size_t i) {
    return reinterpret_cast<PackedNode*>(data() + parts_of(header()).nodes_at)[i];
  }
  std::uint32_t& source(std::size_t i) {
    return reinterpret_cast<std::uint32_t*>(data() + parts_of(header()).sources_at)[i];
  }
  std::size_t size() const { return size_; }

  // As a forger would: all checksums are right again.
  void seal() {
    ClusterFileHeader& h = header();
    const ClusterFileParts parts = parts_of(h);
    if (parts.end == size_ && h.clusters < size_ && h.packed_nodes < size_ &&
        h.references < size_) {
      const std::span bytes = std::as_bytes(std::span{data(), size_});
      h.cluster_checksum =
          checksum(bytes.subspan(parts.clusters_at, parts.nodes_at - parts.clusters_at));
      h.node_checksum = checksum(bytes.subspan(parts.nodes_at, parts.sources_at - parts.nodes_at));
      h.source_checksum = checksum(bytes.subspan(parts.sources_at));
    }
    h.header_checksum = header_checksum(h);
  }

  hal::Result<ClusterFileContent> read() {
    return read_cluster_bytes(std::as_bytes(std::span{data(), size_}), "tree.vessels");
  }
  std::string refusal() {
    const auto content = read();
    return content ? "not refused" : content.error().message;
  }

private:
  std::vector<std::uint64_t> words_;
  std::size_t size_;
};

// What a reader does with a file that was let through; the sanitizers watch.
void use(const ClusterFileContent& content) {
  double sum = 0;
  for (const VesselCluster& cluster : content.clusters.clusters)
    for (std::uint32_t i = cluster.references; i < cluster.nodes; ++i) {
      const PackedNode node = content.clusters.nodes[cluster.first_node + i];
      const PackedNode parent = content.clusters.nodes[cluster.first_node + node.parent()];
      const VesselNode end = unpack(cluster, node);
      const VesselNode start = unpack(cluster, parent);
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum +=
            std::fabs(double{end.position_mm[axis]}) + std::fabs(double{start.position_mm[axis]});
      sum += double{end.radius_mm} + double{start.radius_mm};
    }
  EXPECT_TRUE(std::isfinite(sum));
  if (const auto tree = unpack_tree(content.clusters)) {
    EXPECT_EQ(tree->nodes(), content.facts.nodes - content.facts.lone_roots);
  }
}

class ClusterFileTest : public ::testing::Test {
protected:
  void write(const VesselTree& tree, std::string provenance = "seed 1") {
    arrays = build_clusters(tree);
    facts = facts_of(tree, arrays.error, std::move(provenance));
    const auto written = write_cluster_file(file, arrays.view(), facts);
    ASSERT_TRUE(written) << written.error().message;
  }
  FileBytes bytes() const { return FileBytes{tests::whole_file(file)}; }

  tests::ScratchFolder folder;
  std::filesystem::path file = folder / "tree.vessels";
  ClusterArrays arrays;
  VesselFacts facts;
};

TEST_F(ClusterFileTest, gives_back_what_was_written) {
  for (const auto& [name, tree] : tests::trees_of_all_shapes(3000, tests::fresh_seed())) {
    SCOPED_TRACE(name);
    write(tree, "seed 7, scale factor 1.86\nfrom β.swc");
    auto opened = tests::must(ClusterFile::open(file));
    const ClusterFile moved = std::move(opened);
    EXPECT_EQ(moved.facts(), facts);
    EXPECT_EQ(moved.clusters().segments, arrays.segments);
    EXPECT_TRUE(std::ranges::equal(std::as_bytes(moved.clusters().clusters),
                                   std::as_bytes(std::span{arrays.clusters})));
    EXPECT_TRUE(std::ranges::equal(std::as_bytes(moved.clusters().nodes),
                                   std::as_bytes(std::span{arrays.nodes})));
    EXPECT_TRUE(std::ranges::equal(moved.clusters().sources, arrays.sources));
    EXPECT_EQ(folder.count(), 1);
  }
}

TEST_F(ClusterFileTest, states_facts_that_a_walk_through_the_tree_finds) {
  tests::TreeGrower grower{1};
  grower.root(1);
  const std::uint32_t root = grower.root(1);
  const std::uint32_t fork = grower.grow(root, 3, 0.5F, 9);
  grower.grow(fork, 2, 0.4F, 8);
  grower.grow(fork, 0, 0.4F, 8);
  grower.grow(fork, 2, 0.1F, 5);
  write(grower.tree);
  const auto opened = tests::must(ClusterFile::open(file));
  const VesselFacts& found = opened.facts();
  EXPECT_EQ(found.nodes, 6U);
  EXPECT_EQ(found.roots, 2U);
  EXPECT_EQ(found.lone_roots, 1U);
  EXPECT_EQ(found.branch_points, 1U);
  EXPECT_EQ(found.zero_lengths, 1U);
  EXPECT_EQ(found.all_segments(), 4U);
  EXPECT_EQ(found.segments_of(8), 2U);
  EXPECT_EQ(found.segments_of(VesselBranch::lad), 4U);
  EXPECT_EQ(found.segments_of(VesselBranch::rca), 0U);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float least = 0;
    for (const auto& at : grower.tree.positions_mm)
      least = std::min(least, at[axis]);
    EXPECT_EQ(found.lower_mm[axis], least);
  }
}

TEST_F(ClusterFileTest, keeps_a_tree_without_segments) {
  write(VesselTree{});
  const auto opened = tests::must(ClusterFile::open(file));
  EXPECT_EQ(opened.clusters().clusters.size(), 0U);
  EXPECT_EQ(opened.facts(), facts);
}

TEST_F(ClusterFileTest, refuses_what_is_no_file_of_clusters) {
  const auto refusal = [&](const std::filesystem::path& path) {
    return tests::error_of(ClusterFile::open(path)).message;
  };
  EXPECT_THAT(refusal(folder / "none.vessels"), HasSubstr("none.vessels: cannot be opened"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("is a directory"));
  EXPECT_THAT(refusal(folder.write("empty", "")), HasSubstr("is empty"));
  EXPECT_THAT(refusal(folder.write("short", "1 1 0 0 0 1 -1\n")),
              HasSubstr("has 15 bytes, expected at least the 4096"));
  EXPECT_THAT(refusal(folder.write("long.swc", std::string(5000, '#'))),
              HasSubstr("does not begin like a .vessels file"));
}

TEST_F(ClusterFileTest, refuses_other_versions_byte_orders_and_lengths) {
  write(tests::fractal_tree(2000, 2));
  const FileBytes good = bytes();
  FileBytes changed = good;
  changed.header().version = 2;
  EXPECT_THAT(changed.refusal(), HasSubstr("tree.vessels: at byte 8: is of version 2, expected 1"));
  changed = good;
  std::reverse(changed.data() + 12, changed.data() + 16);
  EXPECT_THAT(changed.refusal(), HasSubstr("at byte 12: is big-endian, expected little-endian"));
  const std::string whole = tests::whole_file(file);
  for (std::size_t size = 0; size < whole.size(); size += 97)
    EXPECT_THAT(FileBytes{whole.substr(0, size)}.refusal(), HasSubstr("bytes, expected")) << size;
  EXPECT_THAT(FileBytes{whole + '\0'}.refusal(), HasSubstr("was it cut short?"));
}

TEST_F(ClusterFileTest, refuses_every_bit_that_was_flipped) {
  write(tests::fractal_tree(300, 3));
  FileBytes changed = bytes();
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const auto bit = static_cast<char>(1 << (i % 8));
    changed.data()[i] = static_cast<char>(changed.data()[i] ^ bit);
    const std::string message = changed.refusal();
    ASSERT_THAT(message, HasSubstr("tree.vessels")) << i;
    ASSERT_LT(message.size(), 600U) << message;
    changed.data()[i] = static_cast<char>(changed.data()[i] ^ bit);
  }
  EXPECT_TRUE(changed.read());
}

TEST_F(ClusterFileTest, names_what_a_forger_got_wrong) {
  write(tests::fractal_tree(2000, 4));
  const FileBytes good = bytes();
  const auto forged = [&](const std::function<void(FileBytes&)>& change) {
    FileBytes changed = good;
    change(changed);
    changed.seal();
    return changed.refusal();
  };
  EXPECT_EQ(forged([](FileBytes&) {}), "not refused");
  EXPECT_THAT(forged([](FileBytes& f) { f.cluster(1).first_node += 1; }),
              HasSubstr("at byte 4160: cluster 1 begins at node"));
  EXPECT_THAT(forged([](FileBytes& f) { f.cluster(0).references = f.cluster(0).nodes; }),
              HasSubstr("expected a segment at least"));
  EXPECT_THAT(forged([](FileBytes& f) { f.cluster(f.header().clusters - 1).nodes += 1; }),
              HasSubstr("the file has no more"));
  EXPECT_THAT(forged([](FileBytes& f) { f.cluster(0).step_mm[1] = NAN; }),
              HasSubstr("steps of nan mm, expected finite"));
  EXPECT_THAT(forged([](FileBytes& f) { f.cluster(0).log2_radius_step = 5; }),
              HasSubstr("expected finite numbers"));
  EXPECT_THAT(forged([](FileBytes& f) { f.cluster(0).branch = static_cast<VesselBranch>(9); }),
              HasSubstr("has branch 9"));
  EXPECT_THAT(forged([](FileBytes& f) { f.cluster(0).nodes_from_order[0] -= 1; }),
              HasSubstr("nodes from order 0"));
  EXPECT_THAT(forged([](FileBytes& f) {
                PackedNode& node = f.node(f.cluster(0).references);
                node.high = (node.high & ~0x0FF00000U) | 0x0FF00000U;
              }),
              HasSubstr("and parent 255, expected"));
  EXPECT_THAT(forged([](FileBytes& f) {
                PackedNode& node = f.node(f.cluster(0).references);
                node.high |= 0xF0000000U;
              }),
              HasSubstr("has order 15"));
  EXPECT_THAT(forged([](FileBytes& f) { f.source(0) = 0xFFFFFFF0; }),
              HasSubstr("is a copy of packed node 4294967280"));
  EXPECT_THAT(forged([](FileBytes& f) { f.header().segments[2][0] += 1; }),
              HasSubstr("expected numbers that agree"));
  EXPECT_THAT(forged([](FileBytes& f) { f.header().clusters = std::uint64_t{1} << 58; }),
              HasSubstr("bytes, expected"));
  EXPECT_THAT(forged([](FileBytes& f) { f.header().provenance_bytes = 1U << 31; }),
              HasSubstr("provenance of 2147483648 bytes"));
  EXPECT_THAT(forged([](FileBytes& f) { f.header().upper_mm[0] = INFINITY; }),
              HasSubstr("bounds from"));
}

// Changed at random and sealed again: it is refused, or reading it does no harm.
TEST_F(ClusterFileTest, takes_no_harm_from_forgeries) {
  write(tests::fractal_tree(1500, 5));
  const FileBytes good = bytes();
  FileBytes changed = good;
  std::mt19937_64 random{tests::fresh_seed()};
  int refused = 0;
#ifdef OCTASCOPE_SANITIZED
  constexpr int rounds = 3'000;
#else
  constexpr int rounds = 12'000;
#endif
  for (int round = 0; round < rounds; ++round) {
    const std::size_t changes = 1 + random() % 4;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < changes; ++i) {
      // Half of the changes in the header and the clusters, which are the smaller part.
      const std::size_t range =
          random() % 2 == 0 ? good.size() : parts_of(changed.header()).nodes_at;
      places.push_back(random() % std::min(range, good.size()));
      changed.data()[places.back()] = static_cast<char>(random());
    }
    changed.seal();
    if (const auto content = changed.read())
      use(*content);
    else
      ++refused;
    changed = good;
  }
  EXPECT_GT(refused, rounds / 4);
  EXPECT_LT(refused, rounds);
}

TEST_F(ClusterFileTest, finds_rings_when_unpacking) {
  write(tests::chain_tree(100, 6));
  FileBytes changed = bytes();
  // The root's copy becomes one of the chain's own last segment: no end is left.
  changed.source(0) = changed.cluster(0).references;
  changed.header().roots -= 1;
  changed.header().nodes -= 1;
  changed.seal();
  const auto content = tests::must(changed.read());
  EXPECT_THAT(unpack_tree(content.clusters), tests::FailsSaying("is its own ancestor"));
}

TEST_F(ClusterFileTest, writes_nothing_that_it_would_not_read) {
  const VesselTree tree = tests::chain_tree(100, 7);
  arrays = build_clusters(tree);
  facts = facts_of(tree, arrays.error, "");
  facts.segments[2][2] += 1;
  EXPECT_FALSE(write_cluster_file(file, arrays.view(), facts));
  facts = facts_of(tree, arrays.error, std::string(longest_provenance + 1, 'x'));
  EXPECT_THAT(write_cluster_file(file, arrays.view(), facts),
              tests::FailsSaying("3073 bytes, expected at most 3072"));
  EXPECT_EQ(folder.count(), 0);
}

} // namespace
} // namespace octascope::pipeline

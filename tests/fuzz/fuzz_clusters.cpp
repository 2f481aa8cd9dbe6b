// Our own file of clusters: the tree that it says it has, or a message. Checksums guard the reader,
// so half of what the fuzzer changes is sealed again, as a forger would.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include <unistd.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "pipeline/vessels/clusters/cluster_checker.h"
#include "pipeline/vessels/clusters/cluster_facts.h"
#include "pipeline/vessels/clusters/cluster_file.h"
#include "pipeline/vessels/clusters/cluster_file_format.h"
#include "pipeline/vessels/clusters/cluster_unpacker.h"
#include "tests/fuzz/expect.h"
#include "tests/support/vessels/random_tree.h"

namespace {

using namespace octascope;

std::string make_good_file() {
  const pipeline::VesselTree tree = tests::random_tree(40, 3);
  const pipeline::ClusterArrays arrays = pipeline::build_clusters(tree);
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("octascope-fuzz-" + std::to_string(::getpid()));
  tests::expect(
      pipeline::write_cluster_file(file, arrays.view(), facts_of(tree, arrays.error, "by hand"))
          .has_value(),
      "a good file can be written");
  std::ifstream in{file, std::ios::binary};
  std::string bytes{std::istreambuf_iterator<char>{in}, {}};
  std::filesystem::remove(file);
  return bytes;
}

void seal(std::span<std::uint64_t> words, std::size_t size) {
  if (size < sizeof(pipeline::ClusterFileHeader))
    return;
  pipeline::ClusterFileHeader header;
  std::memcpy(&header, words.data(), sizeof header);
  const auto bytes = std::as_bytes(words).first(size);
  if (header.clusters < size && header.packed_nodes < size && header.references < size) {
    const pipeline::ClusterFileParts parts = parts_of(header);
    if (parts.end == size) {
      header.cluster_checksum =
          pipeline::checksum(bytes.subspan(parts.clusters_at, parts.nodes_at - parts.clusters_at));
      header.node_checksum =
          pipeline::checksum(bytes.subspan(parts.nodes_at, parts.sources_at - parts.nodes_at));
      header.source_checksum = pipeline::checksum(bytes.subspan(parts.sources_at));
    }
  }
  header.header_checksum = header_checksum(header);
  std::memcpy(words.data(), &header, sizeof header);
}

} // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* bytes, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* bytes, std::size_t size,
                                               std::size_t most, unsigned seed) {
  static const std::string good = make_good_file();
  if (size < sizeof(pipeline::ClusterFileHeader) && good.size() <= most) {
    std::ranges::copy(good, bytes);
    size = good.size();
  }
  size = LLVMFuzzerMutate(bytes, size, seed % 4 == 0 ? most : size);
  if (seed % 2 == 0)
    return size;
  std::vector<std::uint64_t> words(size / 8 + 1);
  std::memcpy(words.data(), bytes, size);
  seal(words, size);
  std::memcpy(bytes, words.data(), size);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  std::vector<std::uint64_t> words(size / 8 + 1);
  if (size > 0)
    std::memcpy(words.data(), bytes, size);
  const auto content =
      pipeline::read_cluster_bytes(std::as_bytes(std::span{words}).first(size), "name");
  if (!content) {
    tests::expect_refusal(content.error().message);
    return 0;
  }
  // A forger's segments may form a ring. Without segments the tree is empty: roots without a child
  // are not in it.
  const auto tree = pipeline::unpack_tree(content->clusters);
  const std::uint64_t segments = content->facts.all_segments();
  tests::expect(tree ? segments == 0 ? tree->nodes() == 0 : tree->nodes() > segments
                     : !tree.error().message.empty(),
                "a tree of all segments, or words");
  return 0;
}

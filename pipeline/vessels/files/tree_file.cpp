#include "pipeline/vessels/files/tree_file.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "pipeline/files/input_file.h"
#include "pipeline/vessels/clusters/cluster_file.h"
#include "pipeline/vessels/clusters/cluster_file_format.h"
#include "pipeline/vessels/clusters/cluster_unpacker.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view expected_file =
    "a vessel tree: a .vessels file, SWC text or VTK XML poly data";

template <class Read> hal::Result<TreeFile> as_tree_file(hal::Result<Read> read) {
  if (!read)
    return tl::make_unexpected(std::move(read.error()));
  hal::Result<TreeFile> file; // filled in place: GCC 14 finds fault with a moved-from variant
  file->tree = std::move(read->tree);
  file->unit = read->unit;
  file->counts = std::move(read->counts);
  return file;
}

hal::Result<TreeFile> read_clusters(const fs::path& file, const TreeReadOptions& options) {
  HAL_TRY(const auto clusters, ClusterFile::open(file));
  auto tree = unpack_tree(clusters.clusters(), options.progress);
  if (!tree)
    return hal::fail(tree.error().code, "{}: {}", file.string(), tree.error().message);
  return TreeFile{std::move(*tree), LengthUnit::mm, clusters.facts()};
}

// The first half of the magic alone: where a transfer has spoilt the rest, the reader of clusters
// finds better words for it.
bool begins_like_clusters(std::string_view beginning) {
  const auto magic = std::span{cluster_file_magic}.first<4>();
  return beginning.size() >= magic.size() &&
         std::equal(magic.begin(), magic.end(), beginning.begin(),
                    [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); });
}

} // namespace

hal::Result<TreeFileKind> tree_file_kind(const fs::path& file, const TreeLimits& limits) {
  std::array<char, 512> buffer{};
  HAL_TRY(const auto input, InputFile::open(file, expected_file, limits.bytes));
  HAL_TRY(const auto filled, input.read(buffer));
  const std::string_view beginning{buffer.data(), filled};
  if (begins_like_clusters(beginning))
    return TreeFileKind::clusters;
  if (beginning.find('\0') != std::string_view::npos && !beginning.starts_with('<'))
    return hal::fail(hal::ErrorCode::bad_data, "{}: found bytes that are no text, expected {}",
                     file.string(), expected_file);
  const std::size_t first = beginning.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  const bool xml = first != std::string_view::npos && beginning[first] == '<';
  return xml ? TreeFileKind::vtp : TreeFileKind::swc;
}

hal::Result<TreeFile> read_tree(const fs::path& file, const TreeReadOptions& options) {
  HAL_TRY(const auto kind, tree_file_kind(file, options.limits));
  switch (kind) {
  case TreeFileKind::clusters: return read_clusters(file, options);
  case TreeFileKind::vtp: return as_tree_file(read_vtp(file, options));
  case TreeFileKind::swc: break;
  }
  return as_tree_file(read_swc(file, options));
}

} // namespace octascope::pipeline

#include "pipeline/vessels/clusters/cluster_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <sys/mman.h>

#include "pipeline/files/atomic_file.h"
#include "pipeline/vessels/clusters/cluster_checker.h"
#include "pipeline/vessels/clusters/cluster_file_format.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

static_assert(std::endian::native == std::endian::little, "files are little-endian");

namespace {

// So many of each, that neither 32-bit indices nor the arithmetic below run over.
constexpr std::uint64_t most_nodes = 0xFFFFFFF0;

// cluster_file_byte_order, as a big-endian machine would have left it.
constexpr std::uint32_t turned_byte_order = 0x04030201;

hal::Result<> check_beginning(std::span<const std::byte> bytes, std::string_view name) {
  const auto refuse = [&](ErrorCode fault, std::string_view what) {
    return hal::fail(fault, "{}: {}", name, what);
  };
  if (bytes.size() < sizeof(ClusterFileHeader))
    return refuse(ErrorCode::bad_data,
                  fmt::format("has {} bytes, expected at least the {} of a .vessels file's header; "
                              "make it anew",
                              bytes.size(), sizeof(ClusterFileHeader)));
  ClusterFileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != cluster_file_magic)
    return refuse(
        ErrorCode::bad_data,
        "does not begin like a .vessels file; an SWC or VTP file must be converted first");
  if (header.byte_order == turned_byte_order)
    return refuse(ErrorCode::unsupported,
                  "at byte 12: is big-endian, expected little-endian; make it "
                  "anew on this machine");
  if (header.version != cluster_file_version)
    return refuse(ErrorCode::unsupported,
                  fmt::format("at byte 8: is of version {}, expected {}; make it anew with this "
                              "program, or use one that knows it",
                              header.version, cluster_file_version));
  if (const std::uint64_t found = header_checksum(header); found != header.header_checksum)
    return damaged(name, 0,
                   fmt::format("the header's checksum is {:#x}, but it says {:#x}", found,
                               header.header_checksum));
  if (header.byte_order != cluster_file_byte_order)
    return damaged(name, 12,
                   fmt::format("the byte order is {:#x}, expected {:#x}", header.byte_order,
                               cluster_file_byte_order));
  if (header.clusters > most_nodes || header.packed_nodes > most_nodes ||
      header.references > header.packed_nodes || parts_of(header).end != bytes.size())
    return refuse(ErrorCode::bad_data,
                  fmt::format("has {} bytes, expected {} = {} of header + {} clusters × {} + {} "
                              "nodes × {} + {} references × {}; was it cut short? copy it again",
                              bytes.size(), parts_of(header).end, sizeof(ClusterFileHeader),
                              header.clusters, sizeof(VesselCluster), header.packed_nodes,
                              sizeof(PackedNode), header.references, sizeof(std::uint32_t)));
  return check_header(header, name);
}

VesselFacts facts_from(const ClusterFileHeader& header) {
  VesselFacts facts;
  facts.nodes = header.nodes;
  facts.roots = header.roots;
  facts.lone_roots = header.lone_roots;
  facts.branch_points = header.branch_points;
  facts.zero_lengths = header.zero_lengths;
  facts.segments = header.segments;
  facts.lower_mm = header.lower_mm;
  facts.upper_mm = header.upper_mm;
  facts.error = {header.position_error_um, header.relative_radius_error};
  facts.provenance.assign(header.provenance.data(), header.provenance_bytes);
  return facts;
}

ClusterFileHeader header_from(const VesselClusters& clusters, const VesselFacts& facts) {
  ClusterFileHeader header{};
  header.magic = cluster_file_magic;
  header.version = cluster_file_version;
  header.byte_order = cluster_file_byte_order;
  header.cluster_checksum = checksum(std::as_bytes(clusters.clusters));
  header.node_checksum = checksum(std::as_bytes(clusters.nodes));
  header.source_checksum = checksum(std::as_bytes(clusters.sources));
  header.clusters = clusters.clusters.size();
  header.packed_nodes = clusters.nodes.size();
  header.references = clusters.sources.size();
  header.nodes = facts.nodes;
  header.roots = facts.roots;
  header.lone_roots = facts.lone_roots;
  header.branch_points = facts.branch_points;
  header.zero_lengths = facts.zero_lengths;
  header.segments = facts.segments;
  header.lower_mm = facts.lower_mm;
  header.upper_mm = facts.upper_mm;
  header.position_error_um = facts.error.position_um;
  header.relative_radius_error = facts.error.relative_radius;
  header.provenance_bytes = static_cast<std::uint32_t>(facts.provenance.size());
  std::ranges::copy(facts.provenance, header.provenance.begin());
  header.header_checksum = header_checksum(header);
  return header;
}

} // namespace

hal::Result<ClusterFileContent> read_cluster_bytes(std::span<const std::byte> bytes,
                                                   std::string_view name) {
  HAL_CHECK(check_beginning(bytes, name));
  const auto& header = *reinterpret_cast<const ClusterFileHeader*>(bytes.data());
  const ClusterFileParts parts = parts_of(header);
  const auto part = [&]<class Element>(std::uint64_t offset, std::uint64_t count) {
    return std::span{reinterpret_cast<const Element*>(bytes.data() + offset), count};
  };
  ClusterFileContent content;
  content.facts = facts_from(header);
  content.clusters = {part.operator()<VesselCluster>(parts.clusters_at, header.clusters),
                      part.operator()<PackedNode>(parts.nodes_at, header.packed_nodes),
                      content.facts.all_segments(),
                      part.operator()<std::uint32_t>(parts.sources_at, header.references)};
  HAL_CHECK(check_clusters(header, content.clusters, name));
  return content;
}

hal::Result<ClusterFile> ClusterFile::open(const fs::path& file) {
  HAL_TRY(const auto input, InputFile::open(file, "a .vessels file", UINT64_MAX));
  if (input.bytes() == 0)
    return hal::fail(ErrorCode::bad_data, "{}: is empty, expected a .vessels file", file.string());
  HAL_TRY(auto mapped, input.map());
  // All of it is read at once by the check; where the kernel takes no advice, it is only slower.
  ::madvise(const_cast<std::byte*>(mapped.bytes().data()), mapped.bytes().size(), MADV_WILLNEED);
  HAL_TRY(auto content, read_cluster_bytes(mapped.bytes(), file.string()));
  return ClusterFile{std::move(mapped), std::move(content)};
}

hal::Result<> write_cluster_file(const fs::path& file, const VesselClusters& clusters,
                                 const VesselFacts& facts) {
  if (facts.provenance.size() > longest_provenance)
    return hal::fail(ErrorCode::invalid_argument,
                     "{}: the provenance has {} bytes, expected at most {}", file.string(),
                     facts.provenance.size(), longest_provenance);
  const ClusterFileHeader header = header_from(clusters, facts);
  // What open() would refuse is not written.
  auto good = check_header(header, file.string()).and_then([&] {
    return check_clusters(header, clusters, file.string());
  });
  if (!good)
    return hal::fail(ErrorCode::invalid_argument, good.error().message);
  HAL_TRY(auto out, AtomicFile::create(file));
  const ClusterFileParts parts = parts_of(header);
  return out.write_at(0, std::as_bytes(std::span{&header, 1}))
      .and_then([&] { return out.write_at(parts.clusters_at, std::as_bytes(clusters.clusters)); })
      .and_then([&] { return out.write_at(parts.nodes_at, std::as_bytes(clusters.nodes)); })
      .and_then([&] { return out.write_at(parts.sources_at, std::as_bytes(clusters.sources)); })
      .and_then([&] { return out.commit(); });
}

} // namespace octascope::pipeline

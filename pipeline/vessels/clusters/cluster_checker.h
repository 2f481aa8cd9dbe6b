// Checks that the content of a file of clusters is safe to follow.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "hal/result.h"
#include "pipeline/vessels/clusters.h"
#include "pipeline/vessels/clusters/cluster_file_format.h"

namespace octascope::pipeline {

// A header whose magic, version, byte order and checksum are right and whose counts are those of
// the file: are its other values in range and in agreement with each other?
hal::Result<> check_header(const ClusterFileHeader& header, std::string_view name);

// Clusters in one piece after the other, each within `nodes`; references first, then by falling
// order; parents in the same cluster; sources that are segments or roots; finite boxes; the counts
// and the checksums that the header states. One pass over the nodes.
hal::Result<> check_clusters(const ClusterFileHeader& header, const VesselClusters& clusters,
                             std::string_view name);

std::uint64_t checksum(std::span<const std::byte> bytes);
std::uint64_t header_checksum(ClusterFileHeader header);

// The offsets of the parts.
struct ClusterFileParts {
  std::uint64_t clusters_at;
  std::uint64_t nodes_at;
  std::uint64_t sources_at;
  std::uint64_t end;
};
ClusterFileParts parts_of(const ClusterFileHeader& header);

// The error of a damaged file: "<name>: at byte <offset>: <found>; …".
tl::unexpected<hal::Error> damaged(std::string_view name, std::uint64_t offset,
                                   std::string_view found_and_expected);

} // namespace octascope::pipeline

// How a vessel tree lies on disk: extension .vessels, little-endian, made to be mapped.
//
//   4096 bytes   ClusterFileHeader
//   64 bytes     VesselCluster, for each cluster (clusters.h)
//   8 bytes      PackedNode, for each node of each cluster, references included
//   4 bytes      VesselClusters::sources, for each reference
// and nothing else: counts determine every offset and the file's size. Each part has a checksum
// (XXH3, 64 bits, seed 0); the header's own is computed with its place for it at zero.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "pipeline/vessels/clusters.h"

namespace octascope::pipeline {

// Like PNG's: a byte that is not text, then line ends that a transfer in text mode would change.
inline constexpr std::array<std::uint8_t, 8> cluster_file_magic{0x89, 'V',  'S',  'L',
                                                                '\r', '\n', 0x1A, '\n'};
inline constexpr std::uint32_t cluster_file_version = 1;
inline constexpr std::uint32_t cluster_file_byte_order = 0x01020304;
inline constexpr std::size_t longest_provenance = 3072; // bytes of UTF-8

struct ClusterFileHeader {
  std::array<std::uint8_t, 8> magic;
  std::uint32_t version;
  std::uint32_t byte_order;
  std::uint64_t header_checksum;
  std::uint64_t cluster_checksum;
  std::uint64_t node_checksum;
  std::uint64_t source_checksum;
  std::uint64_t clusters;
  std::uint64_t packed_nodes; // references included
  std::uint64_t references;
  // Of the tree: VesselFacts.
  std::uint64_t nodes;
  std::uint64_t roots;
  std::uint64_t lone_roots;
  std::uint64_t branch_points;
  std::uint64_t zero_lengths;
  std::array<std::array<std::uint64_t, vessel_order_count>, vessel_branch_count> segments;
  std::array<float, 3> lower_mm;
  std::array<float, 3> upper_mm;
  float position_error_um;
  float relative_radius_error;
  std::uint32_t provenance_bytes;
  std::array<char, longest_provenance> provenance;
  std::array<std::uint8_t, 492> unused; // zero
};
static_assert(sizeof(ClusterFileHeader) == 4096);
static_assert(std::is_trivially_copyable_v<ClusterFileHeader>);

} // namespace octascope::pipeline

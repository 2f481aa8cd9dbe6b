#include "pipeline/vessels/clusters/cluster_checker.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <xxhash.h>

namespace octascope::pipeline {

namespace {

// XXH3 of what comes piece by piece.
class RunningChecksum {
public:
  RunningChecksum() : state_{XXH3_createState(), XXH3_freeState} {
    XXH3_64bits_reset(state_.get());
  }
  void add(std::span<const std::byte> bytes) {
    XXH3_64bits_update(state_.get(), bytes.data(), bytes.size());
  }
  std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }

private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

bool all_finite_and_not_negative(std::initializer_list<float> values) {
  return std::ranges::all_of(values, [](float v) { return std::isfinite(v) && v >= 0; });
}

class Checker {
public:
  Checker(const ClusterFileHeader& header, const VesselClusters& packed, std::string_view name)
      : header_{header}, packed_{packed}, name_{name}, parts_{parts_of(header)} {}

  hal::Result<> run() {
    constexpr std::size_t block = 512; // clusters: their nodes stay in the cache for the checksum
    for (std::size_t begin = 0; begin < packed_.clusters.size(); begin += block) {
      const std::uint64_t first_node = next_node_;
      const std::size_t end = std::min(begin + block, packed_.clusters.size());
      for (std::size_t c = begin; c < end; ++c)
        HAL_CHECK(check(c));
      nodes_checksum_.add(
          std::as_bytes(packed_.nodes.subspan(first_node, next_node_ - first_node)));
    }
    return compare_with_header();
  }

private:
  tl::unexpected<hal::Error> refuse_cluster(std::size_t c, std::string_view what) const {
    return damaged(name_, parts_.clusters_at + c * sizeof(VesselCluster),
                   fmt::format("cluster {} {}", c, what));
  }

  hal::Result<> check(std::size_t c) {
    const VesselCluster& cluster = packed_.clusters[c];
    if (cluster.first_node != next_node_)
      return refuse_cluster(
          c, fmt::format("begins at node {}, expected {}", cluster.first_node, next_node_));
    if (cluster.nodes <= cluster.references)
      return refuse_cluster(c, fmt::format("has {} nodes of which {} are references, expected a "
                                           "segment at least",
                                           cluster.nodes, cluster.references));
    if (cluster.nodes > packed_.nodes.size() - next_node_ ||
        cluster.references > packed_.sources.size() - next_source_)
      return refuse_cluster(c, fmt::format("has {} nodes and {} references, expected at most {} "
                                           "and {}: the file has no more",
                                           cluster.nodes, cluster.references,
                                           packed_.nodes.size() - next_node_,
                                           packed_.sources.size() - next_source_));
    if (const auto fault = fault_of_frame(cluster))
      return refuse_cluster(c, *fault);
    HAL_CHECK(check_nodes(cluster));
    HAL_CHECK(check_sources(cluster));
    count_segments(cluster);
    next_node_ += cluster.nodes;
    next_source_ += cluster.references;
    return {};
  }

  static std::optional<std::string> fault_of_frame(const VesselCluster& cluster) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float end = cluster.origin_mm[axis] + cluster.step_mm[axis] * vessel_place_steps;
      if (!(cluster.step_mm[axis] >= 0) || !std::isfinite(cluster.origin_mm[axis]) ||
          !std::isfinite(end))
        return fmt::format("has a box from {} mm by steps of {} mm, expected finite numbers",
                           cluster.origin_mm[axis], cluster.step_mm[axis]);
    }
    const float thickest =
        cluster.smallest_radius_mm * std::exp2(cluster.log2_radius_step * vessel_radius_steps);
    if (!(cluster.smallest_radius_mm > 0) || !(cluster.log2_radius_step >= 0) ||
        !all_finite_and_not_negative({cluster.smallest_radius_mm, thickest,
                                      cluster.largest_radius_mm, cluster.length_mm,
                                      cluster.side_area_mm2}))
      return fmt::format("has radii of {} mm to {} mm, a length of {} mm and an area of {} mm², "
                         "expected finite numbers that are not negative",
                         cluster.smallest_radius_mm, thickest, cluster.length_mm,
                         cluster.side_area_mm2);
    if (static_cast<int>(cluster.branch) >= vessel_branch_count || cluster.unused != 0)
      return fmt::format("has branch {} and {} in an unused byte, expected 0 to {} and 0",
                         static_cast<int>(cluster.branch), cluster.unused, vessel_branch_count - 1);
    const auto& ends = cluster.nodes_from_order;
    if (ends[0] != cluster.nodes || ends.back() < cluster.references ||
        !std::ranges::is_sorted(ends, std::greater{}))
      return fmt::format("has {} nodes from order 0 and {} from order {}, expected falling numbers "
                         "from {} to {} at least",
                         ends[0], ends.back(), highest_vessel_order, cluster.nodes,
                         cluster.references);
    return std::nullopt;
  }

  hal::Result<> check_nodes(const VesselCluster& cluster) const {
    const auto nodes = packed_.nodes.subspan(next_node_, cluster.nodes);
    // Of each order the segments from the first to the last; references have one of their own.
    std::uint32_t first = 0;
    const auto refuse = [&](std::uint32_t i, unsigned order) {
      return damaged(name_, parts_.nodes_at + (next_node_ + i) * sizeof(PackedNode),
                     fmt::format("packed node {} has order {} and parent {}, expected order {} and "
                                 "a parent below {}, not itself",
                                 next_node_ + i, nodes[i].order(), nodes[i].parent(), order,
                                 cluster.nodes));
    };
    for (; first < cluster.references; ++first)
      if (!nodes[first].is_reference() || nodes[first].parent() >= cluster.nodes)
        return refuse(first, reference_order);
    for (unsigned order = vessel_order_count; order-- > 0;)
      for (; first < cluster.nodes_from_order[order]; ++first)
        if (nodes[first].order() != order || nodes[first].parent() >= cluster.nodes ||
            nodes[first].parent() == first)
          return refuse(first, order);
    return {};
  }

  hal::Result<> check_sources(const VesselCluster& cluster) {
    for (std::uint64_t i = 0; i < cluster.references; ++i) {
      const std::uint32_t source = packed_.sources[next_source_ + i];
      const bool itself = source == next_node_ + i;
      if (!itself && (source >= packed_.nodes.size() || packed_.nodes[source].is_reference()) &&
          !is_root(source))
        return damaged(name_, parts_.sources_at + (next_source_ + i) * sizeof(std::uint32_t),
                       fmt::format("packed node {} is a copy of packed node {}, expected one below "
                                   "{} that ends a segment, or the first copy of a root",
                                   next_node_ + i, source, packed_.nodes.size()));
      if (itself)
        roots_.push_back(source);
    }
    return {};
  }

  // First copies of roots come before the others.
  bool is_root(std::uint32_t node) const { return std::ranges::binary_search(roots_, node); }

  void count_segments(const VesselCluster& cluster) {
    auto& counts = segments_[static_cast<std::size_t>(cluster.branch)];
    std::uint64_t thicker = cluster.references;
    for (std::size_t order = counts.size(); order-- > 0;) {
      counts[order] += cluster.nodes_from_order[order] - thicker;
      thicker = cluster.nodes_from_order[order];
    }
  }

  hal::Result<> compare_with_header() const {
    const auto compare = [&](std::string_view what, std::uint64_t found, std::uint64_t expected,
                             std::uint64_t offset) -> hal::Result<> {
      if (found == expected)
        return {};
      return damaged(name_, offset,
                     fmt::format("{} {:#x}, but the header says {:#x}", what, found, expected));
    };
    if (next_node_ != packed_.nodes.size() || next_source_ != packed_.sources.size())
      return damaged(name_, parts_.nodes_at,
                     fmt::format("the clusters have {} nodes and {} references, expected {} and {}",
                                 next_node_, next_source_, packed_.nodes.size(),
                                 packed_.sources.size()));
    if (segments_ != header_.segments)
      return damaged(name_, offsetof(ClusterFileHeader, segments),
                     "the header's numbers of segments are not those of the clusters");
    if (roots_.size() != header_.roots - header_.lone_roots)
      return damaged(name_, offsetof(ClusterFileHeader, roots),
                     fmt::format("{} roots have segments, but the header says {}", roots_.size(),
                                 header_.roots - header_.lone_roots));
    return compare("the clusters' checksum is", checksum(std::as_bytes(packed_.clusters)),
                   header_.cluster_checksum, parts_.clusters_at)
        .and_then([&] {
          return compare("the nodes' checksum is", nodes_checksum_.value(), header_.node_checksum,
                         parts_.nodes_at);
        })
        .and_then([&] {
          return compare("the references' checksum is", checksum(std::as_bytes(packed_.sources)),
                         header_.source_checksum, parts_.sources_at);
        });
  }

  const ClusterFileHeader& header_;
  const VesselClusters& packed_;
  std::string_view name_;
  ClusterFileParts parts_;
  std::uint64_t next_node_ = 0;
  std::uint64_t next_source_ = 0;
  std::vector<std::uint32_t> roots_; // first copies, rising
  decltype(ClusterFileHeader::segments) segments_{};
  RunningChecksum nodes_checksum_;
};

} // namespace

std::uint64_t checksum(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::uint64_t header_checksum(ClusterFileHeader header) {
  header.header_checksum = 0;
  return checksum(std::as_bytes(std::span{&header, 1}));
}

ClusterFileParts parts_of(const ClusterFileHeader& header) {
  ClusterFileParts parts{};
  parts.clusters_at = sizeof(ClusterFileHeader);
  parts.nodes_at = parts.clusters_at + header.clusters * sizeof(VesselCluster);
  parts.sources_at = parts.nodes_at + header.packed_nodes * sizeof(PackedNode);
  parts.end = parts.sources_at + header.references * sizeof(std::uint32_t);
  return parts;
}

tl::unexpected<hal::Error> damaged(std::string_view name, std::uint64_t offset,
                                   std::string_view found_and_expected) {
  return hal::fail(hal::ErrorCode::bad_data,
                   "{}: at byte {}: {}; the file is damaged, copy it again or make it anew", name,
                   offset, found_and_expected);
}

hal::Result<> check_header(const ClusterFileHeader& header, std::string_view name) {
  std::uint64_t segments = 0;
  for (const auto& of_branch : header.segments)
    for (const std::uint64_t count : of_branch) {
      if (count > header.packed_nodes)
        return damaged(name, offsetof(ClusterFileHeader, segments),
                       fmt::format("{} segments of one branch and order, expected at most {}, the "
                                   "nodes of all",
                                   count, header.packed_nodes));
      segments += count;
    }
  if (header.roots > no_parent || header.nodes != segments + header.roots ||
      header.lone_roots > header.roots || header.packed_nodes != segments + header.references ||
      header.branch_points > header.nodes || header.zero_lengths > segments)
    return damaged(
        name, offsetof(ClusterFileHeader, nodes),
        fmt::format("{} nodes, {} roots ({} alone), {} branch points, {} segments ({} of "
                    "no length), {} packed nodes, {} references: expected numbers that "
                    "agree",
                    header.nodes, header.roots, header.lone_roots, header.branch_points, segments,
                    header.zero_lengths, header.packed_nodes, header.references));
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!std::isfinite(header.lower_mm[axis]) || !std::isfinite(header.upper_mm[axis]) ||
        header.lower_mm[axis] > header.upper_mm[axis])
      return damaged(name, offsetof(ClusterFileHeader, lower_mm),
                     fmt::format("bounds from {} mm to {} mm, expected finite, rising numbers",
                                 header.lower_mm[axis], header.upper_mm[axis]));
  if (!all_finite_and_not_negative({header.position_error_um, header.relative_radius_error}))
    return damaged(name, offsetof(ClusterFileHeader, position_error_um),
                   fmt::format("errors of {} µm and {}, expected finite numbers that are not "
                               "negative",
                               header.position_error_um, header.relative_radius_error));
  if (header.provenance_bytes > longest_provenance)
    return damaged(name, offsetof(ClusterFileHeader, provenance_bytes),
                   fmt::format("a provenance of {} bytes, expected at most {}",
                               header.provenance_bytes, longest_provenance));
  return {};
}

hal::Result<> check_clusters(const ClusterFileHeader& header, const VesselClusters& clusters,
                             std::string_view name) {
  return Checker{header, clusters, name}.run();
}

} // namespace octascope::pipeline

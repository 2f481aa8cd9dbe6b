// A cluster as one camera sees it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "pipeline/vessels/clusters.h"
#include "ui/vessels/splatter/splat_frame.h"

namespace octascope::ui {

inline const float log2_widest_start = std::log2(pipeline::widest_start);

// A position on the screen before the division by distance.
struct ViewPlace {
  double column;
  double line;
  double distance_mm;
  double radius_mm;
};
struct ScreenPlace {
  float column;
  float line;
  float nearness; // 1 / distance
  float log2_radius;
};
struct ScreenSegment {
  ScreenPlace start;
  ScreenPlace end;
};

class ClusterView {
public:
  ClusterView(const SplatFrame& frame, const pipeline::VesselCluster& cluster)
      : log2_smallest_{std::log2(cluster.smallest_radius_mm)}, cluster_{cluster} {
    column_ = composed(frame.column_row, cluster);
    line_ = composed(frame.line_row, cluster);
    distance_ = composed(frame.distance_row, cluster);
    const Range distance = range(distance_);
    const float radius = cluster.largest_radius_mm;
    nearest_ = distance.lower;
    // Linear in the position, to avoid dividing by a distance that may be 0.
    const float radius_px = std::max(radius * frame.pixels_per_unit,
                                     least_vessel_radius_px * std::max(distance.upper, 0.0F));
    const auto within = [&](const std::array<float, 4>& row, int size) {
      const Range from_first = range(sum(row, distance_, 0.5F));
      const Range from_last = range(sum(row, distance_, 0.5F - static_cast<float>(size)));
      outside_ = outside_ || from_first.upper + radius_px < 0 || from_last.lower - radius_px > 0;
      return from_first.lower >= 0 && from_last.upper <= 0;
    };
    outside_ = distance.upper < frame.near_mm || distance.lower > frame.far_mm;
    const bool in_columns = within(column_, frame.width);
    inside_ = within(line_, frame.height) && in_columns;
    middle_ = (distance.lower + distance.upper) / 2;
    pixels_per_unit_ = frame.pixels_per_unit;
    crosses_near_ = distance.lower < frame.near_mm;
    widest_px_per_mm_ = pipeline::widest_start * frame.pixels_per_unit / nearest_;
  }

  bool outside() const { return outside_; }
  bool inside() const { return inside_; }             // all its nodes are in the picture
  bool crosses_near() const { return crosses_near_; } // part of it may be nearer than near_mm
  // Rows that apply to a node's packed position.
  const std::array<float, 4>& column() const { return column_; }
  const std::array<float, 4>& line() const { return line_; }
  const std::array<float, 4>& distance() const { return distance_; }
  float log2_smallest() const { return log2_smallest_; }
  // An upper bound of a segment's half-width in pixels per mm of radius at its end. Valid only if
  // the cluster does not cross the near distance.
  float widest_px_per_mm() const { return widest_px_per_mm_; }

  // The radius of that node if it were in the cluster's middle: varies smoothly with the camera.
  float radius_px(pipeline::PackedNode node) const {
    return unpack(cluster_, node).radius_mm * pixels_per_unit_ / middle_;
  }

  ViewPlace place(pipeline::PackedNode node) const {
    const auto at = [&](const std::array<float, 4>& row) {
      return double{row[0]} * node.x() + double{row[1]} * node.y() + double{row[2]} * node.z() +
             double{row[3]};
    };
    return {at(column_), at(line_), at(distance_), unpack(cluster_, node).radius_mm};
  }

private:
  struct Range {
    float lower;
    float upper;
  };

  static std::array<float, 4> composed(const AffineRow& row,
                                       const pipeline::VesselCluster& cluster) {
    double constant = row[3];
    std::array<float, 4> result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[axis] = static_cast<float>(row[axis] * double{cluster.step_mm[axis]});
      constant += row[axis] * double{cluster.origin_mm[axis]};
    }
    result[3] = static_cast<float>(constant);
    return result;
  }
  static std::array<float, 4> sum(const std::array<float, 4>& row,
                                  const std::array<float, 4>& other, float weight) {
    return {row[0] + weight * other[0], row[1] + weight * other[1], row[2] + weight * other[2],
            row[3] + weight * other[3]};
  }
  // Over the cluster's box.
  static Range range(const std::array<float, 4>& row) {
    constexpr auto half = static_cast<float>(pipeline::vessel_place_steps) / 2;
    const float middle = row[3] + half * (row[0] + row[1] + row[2]);
    const float extent = half * (std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
    return {middle - extent, middle + extent};
  }

  std::array<float, 4> column_;
  std::array<float, 4> line_;
  std::array<float, 4> distance_;
  float log2_smallest_;
  float nearest_ = 0;
  float middle_ = 0;
  float pixels_per_unit_ = 0;
  float widest_px_per_mm_ = 0;
  bool outside_ = false;
  bool inside_ = false;
  bool crosses_near_ = false;
  const pipeline::VesselCluster& cluster_;
};

// The part of a segment that is no nearer than the near distance, if any of it is in the picture.
std::optional<ScreenSegment> clip_to_near(const SplatFrame& frame, const ViewPlace& parent,
                                          const ViewPlace& end);

} // namespace octascope::ui

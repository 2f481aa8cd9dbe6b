// A volume of levels, its geometry and its history.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/volume/flow_marks.h"
#include "pipeline/volume/occupancy.h"
#include "pipeline/volume/volume_geometry.h"
#include "pipeline/volume/volume_metadata.h"

namespace octascope::pipeline {

enum class BScanState : std::uint8_t {
  missing, // not received: its voxels are 0, the display hatches it
  good,
  saturated, // has saturated lines: shown and marked
  seam,      // blank, between two volumes of which one is shown over the other (rolling_volume.h)
};

// Whether it holds what was received.
constexpr bool has_levels(BScanState state) {
  return state == BScanState::good || state == BScanState::saturated;
}

enum class FlowState : std::uint8_t {
  none,     // not received whole, no time for it, or the seam: its flow is flow_untold
  told,     // as far as its voxels could be told
  left_out, // it moved too far between its sweeps: its flow is flow_untold
};

// From `from` to before `to`.
struct BScanRange {
  int from = 0;
  int to = 0;
  bool operator==(const BScanRange&) const = default;
};

// When a B-scan was exposed, by the camera's stamps, and a worker's turn at it: conversion,
// alignment, averaging.
struct BScanWork {
  hal::TimePoint begin{}, end{};
  std::uint32_t worker = 0;
  hal::TimePoint first_line{}, last_line{}; // of the sweeps that came
};

// Levels are 8-bit counts (level_scale.h has the decibels), in the order [b][a][z], depth fastest.
// Volumes come from a pool made at start-up; the vectors never change size afterwards.
struct Volume {
  Volume() = default;
  explicit Volume(const VolumeGeometry& g)
      : geometry(g), levels(g.voxels()),
        b_scan_states(static_cast<std::size_t>(g.b_scans), BScanState::missing) {}

  // Adds room for what flows. Allocates.
  void add_flow() {
    flow.resize(geometry.voxels());
    flow_states.resize(static_cast<std::size_t>(geometry.b_scans), FlowState::none);
  }
  bool has_flow() const { return !flow.empty(); }
  // Of volumes that have it.
  std::span<std::uint8_t> b_scan_flow(int b) {
    return std::span{flow}.subspan(geometry.b_scan_voxels() * static_cast<std::size_t>(b),
                                   geometry.b_scan_voxels());
  }
  std::span<const std::uint8_t> b_scan_flow(int b) const {
    return std::span{flow}.subspan(geometry.b_scan_voxels() * static_cast<std::size_t>(b),
                                   geometry.b_scan_voxels());
  }

  std::span<std::uint8_t> b_scan(int b) {
    return std::span{levels}.subspan(geometry.b_scan_voxels() * static_cast<std::size_t>(b),
                                     geometry.b_scan_voxels());
  }
  std::span<const std::uint8_t> b_scan(int b) const {
    return std::span{levels}.subspan(geometry.b_scan_voxels() * static_cast<std::size_t>(b),
                                     geometry.b_scan_voxels());
  }
  int missing_b_scans() const {
    return static_cast<int>(std::ranges::count(b_scan_states, BScanState::missing));
  }

  VolumeGeometry geometry;
  std::vector<std::uint8_t> levels;
  std::vector<BScanState> b_scan_states;
  // What flows, in counts (flow_scale.h) in the order of the levels, and of each B-scan whether that
  // could be told: of volumes from repeated sweeps that were compared. Else empty.
  std::vector<std::uint8_t> flow;
  std::vector<FlowState> flow_states;
  // Set in volumes from the pipeline; empty() where they were not built. Marks: of volumes with flow.
  Occupancy occupancy;
  FlowMarks flow_marks;
  std::vector<BScanWork> work; // by B-scan, likewise; `end` is zero of those that nobody built
  VolumeMetadata metadata;
};

} // namespace octascope::pipeline

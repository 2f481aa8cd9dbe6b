// A rolling volume for tests: B-scans of a newer one over those of an older one, with the seam behind them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/volume/flow_scale.h"
#include "pipeline/volume/occupancy.h"
#include "tests/ui/support/synthetic_volume.h"

namespace octascope::tests {

class MixedVolume {
public:
  explicit MixedVolume(bool with_flow = false) {
    if (with_flow)
      perfuse();
    for (pipeline::Volume* volume : {&older_, &newer_}) {
      volume->occupancy = pipeline::Occupancy{volume->geometry, pipeline::blank_depth_bins};
      volume->occupancy.update(*volume);
    }
    mixed_ = older_;
  }

  const pipeline::Volume& older() const { return older_; }
  const pipeline::Volume& newer() const { return newer_; }
  const pipeline::Volume& volume() const { return mixed_; }

  // Tubes in both.
  void add_flow() {
    add_tubes(older_);
    add_tubes(newer_, 1);
    mixed_ = older_;
  }

  void become(const pipeline::Volume& whole) { mixed_ = whole; }

  // Takes these of the newer one; says what has changed, the seam included.
  pipeline::BScanRange renew(int from, int to,
                             pipeline::BScanState state = pipeline::BScanState::good) {
    for (int b = from; b < to; ++b) {
      copy(newer_.b_scan(b), b, state);
      if (newer_.has_flow())
        copy_flow(newer_.b_scan_flow(b), b, newer_.flow_states[static_cast<std::size_t>(b)]);
    }
    const bool seam = to < mixed_.geometry.b_scans;
    if (seam) {
      const std::vector<std::uint8_t> blank(mixed_.geometry.b_scan_voxels());
      copy(blank, to, pipeline::BScanState::seam);
      if (mixed_.has_flow())
        copy_flow(blank, to, pipeline::FlowState::none);
    }
    return {from, seam ? to + 1 : to};
  }

private:
  // Of the newer one, two could not be told.
  void perfuse() {
    const pipeline::Volume perfused = perfused_volume(small_geometry);
    for (pipeline::Volume* volume : {&older_, &newer_}) {
      volume->flow = perfused.flow;
      volume->flow_states = perfused.flow_states;
    }
    std::ranges::rotate(newer_.flow, newer_.flow.begin() + 4L * newer_.geometry.depths);
    for (const int b : {5, 13}) {
      std::ranges::fill(newer_.b_scan_flow(b), pipeline::flow_untold);
      newer_.flow_states[static_cast<std::size_t>(b)] = pipeline::FlowState::left_out;
    }
  }

  void copy_flow(std::span<const std::uint8_t> flow, int b, pipeline::FlowState state) {
    std::ranges::copy(flow, mixed_.b_scan_flow(b).begin());
    mixed_.flow_states[static_cast<std::size_t>(b)] = state;
  }

  void copy(std::span<const std::uint8_t> levels, int b, pipeline::BScanState state) {
    std::ranges::copy(levels, mixed_.b_scan(b).begin());
    mixed_.b_scan_states[static_cast<std::size_t>(b)] = state;
    mixed_.occupancy.update(b, mixed_.b_scan(b));
  }

  pipeline::Volume older_ = tissue_volume(small_geometry);
  pipeline::Volume newer_ = [] {
    pipeline::Volume volume = tissue_volume(small_geometry);
    for (std::uint8_t& level : volume.levels)
      level = static_cast<std::uint8_t>(level < 200 ? level + 30 : 100);
    return volume;
  }();
  pipeline::Volume mixed_;
};

} // namespace octascope::tests

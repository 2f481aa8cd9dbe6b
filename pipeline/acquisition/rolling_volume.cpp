#include "pipeline/acquisition/rolling_volume.h"

#include <algorithm>

#include "pipeline/volume/flow_scale.h"

namespace octascope::pipeline {

namespace {

BScanProgress progress_of(const VolumeInMaking& making, int b) {
  return making.progress[static_cast<std::size_t>(b)].load(std::memory_order_acquire);
}

} // namespace

RollingVolume::RollingVolume(const VolumeGeometry& geometry, bool with_flow)
    : volume_{geometry}, numbers_(volume_.b_scan_states.size()),
      changed_(volume_.b_scan_states.size()) {
  volume_.occupancy = Occupancy{geometry, blank_depth_bins};
  if (with_flow) {
    volume_.add_flow();
    volume_.flow_marks = FlowMarks{geometry, blank_depth_bins};
  }
  volume_.work.resize(volume_.b_scan_states.size());
  changes_.reserve(volume_.b_scan_states.size());
}

void RollingVolume::copy(int b, const Volume& from, std::uint64_t number) {
  const auto at = static_cast<std::size_t>(b);
  std::ranges::copy(from.b_scan(b), volume_.b_scan(b).begin());
  volume_.occupancy.copy(b, from.occupancy);
  if (volume_.has_flow()) {
    std::ranges::copy(from.b_scan_flow(b), volume_.b_scan_flow(b).begin());
    volume_.flow_marks.copy(b, from.flow_marks);
    volume_.flow_states[at] = from.flow_states[at];
  }
  state(b) = from.b_scan_states[at];
  volume_.work[at].first_line = from.work[at].first_line;
  volume_.work[at].last_line = from.work[at].last_line;
  numbers_[at] = number;
  changed_[at] = 1;
}

void RollingVolume::blank(int b, BScanState as, std::uint64_t number) {
  const auto at = static_cast<std::size_t>(b);
  std::ranges::fill(volume_.b_scan(b), std::uint8_t{0});
  volume_.occupancy.update(b, volume_.b_scan(b));
  if (volume_.has_flow()) {
    std::ranges::fill(volume_.b_scan_flow(b), flow_untold);
    volume_.flow_marks.clear(b);
    volume_.flow_states[at] = FlowState::none;
  }
  state(b) = as;
  volume_.work[at] = {};
  numbers_[at] = number;
  changed_[at] = 1;
}

void RollingVolume::take(const Volume& whole) {
  base_ = whole.metadata.index;
  fresh_ = 0;
  volume_.metadata = whole.metadata;
  for (int b = 0; b < volume_.geometry.b_scans; ++b)
    if (number_of(b) != base_ || state(b) != whole.b_scan_states[static_cast<std::size_t>(b)])
      copy(b, whole, base_);
}

int RollingVolume::count_ready(const VolumeInMaking& making, int kept_clear) const {
  int ready = fresh_;
  while (ready < volume_.geometry.b_scans && progress_of(making, ready) != BScanProgress::awaited)
    ++ready;
  return ready == kept_clear ? std::max(ready - 1, fresh_) : ready;
}

void RollingVolume::follow(const VolumeInMaking& making, int kept_clear) {
  if (base_ == 0 || making.number <= base_ || (fresh_ > 0 && making.number != newer_))
    return;
  newer_ = making.number;
  for (int b = 0; b < fresh_; ++b)
    if (state(b) == BScanState::missing && progress_of(making, b) == BScanProgress::finished)
      copy(b, *making.volume, newer_);
  const int ready = count_ready(making, kept_clear);
  if (ready == fresh_)
    return;
  for (; fresh_ < ready; ++fresh_) {
    if (progress_of(making, fresh_) == BScanProgress::finished)
      copy(fresh_, *making.volume, newer_);
    else
      blank(fresh_, BScanState::missing, newer_);
  }
  if (fresh_ < volume_.geometry.b_scans)
    blank(fresh_, BScanState::seam, 0);
}

std::span<const BScanRange> RollingVolume::take_changes() {
  changes_.clear();
  for (int b = 0; b < volume_.geometry.b_scans; ++b) {
    if (changed_[static_cast<std::size_t>(b)] == 0)
      continue;
    if (!changes_.empty() && changes_.back().to == b)
      ++changes_.back().to;
    else
      changes_.push_back({b, b + 1});
  }
  std::ranges::fill(changed_, std::uint8_t{0});
  return changes_;
}

hal::TimePoint RollingVolume::last_line_near(int b, int step) const {
  for (; b >= 0 && b < volume_.geometry.b_scans; b += step)
    if (has_levels(volume_.b_scan_states[static_cast<std::size_t>(b)]))
      return volume_.work[static_cast<std::size_t>(b)].last_line;
  return volume_.metadata.last_line; // of the last whole volume: older than all that is missing
}

std::optional<RollingVolume::Seam> RollingVolume::seam() const {
  if (fresh_ == 0 || fresh_ == volume_.geometry.b_scans)
    return std::nullopt;
  return Seam{fresh_, last_line_near(fresh_ - 1, -1), last_line_near(fresh_ + 1, 1)};
}

} // namespace octascope::pipeline

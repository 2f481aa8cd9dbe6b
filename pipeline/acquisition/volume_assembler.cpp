#include "pipeline/acquisition/volume_assembler.h"

#include <algorithm>
#include <cstddef>

namespace octascope::pipeline {

VolumeAssembler::VolumeAssembler(const VolumeGeometry& geometry, const NeighbourAverage& average)
    : geometry_{geometry}, average_{average},
      own_levels_(geometry.voxels()), progress_{std::make_unique<Progress[]>(
                                          static_cast<std::size_t>(geometry.b_scans))},
      finished_(static_cast<std::size_t>(geometry.b_scans)),
      borders_(static_cast<std::size_t>(geometry.b_scans)) {}

void VolumeAssembler::begin(Volume& volume) noexcept {
  volume_ = &volume;
  for (int b = 0; b < geometry_.b_scans; ++b) {
    Progress& progress = progress_[static_cast<std::size_t>(b)];
    progress.built.store(false, std::memory_order_relaxed);
    progress.overdue.store(false, std::memory_order_relaxed);
    progress.taken.store(false, std::memory_order_relaxed);
    finished_[static_cast<std::size_t>(b)].store(BScanProgress::awaited, std::memory_order_relaxed);
  }
}

std::span<std::uint8_t> VolumeAssembler::own_levels(int b) noexcept {
  return std::span{own_levels_}.subspan(geometry_.b_scan_voxels() * static_cast<std::size_t>(b),
                                        geometry_.b_scan_voxels());
}

bool VolumeAssembler::is_built(int b) const noexcept {
  return b >= 0 && b < geometry_.b_scans && progress_[static_cast<std::size_t>(b)].built.load();
}

// Nobody waits for it, or for what does not exist.
bool VolumeAssembler::is_settled(int b) const noexcept {
  if (b < 0 || b >= geometry_.b_scans)
    return true;
  const Progress& progress = progress_[static_cast<std::size_t>(b)];
  return progress.built.load() || progress.overdue.load();
}

bool VolumeAssembler::may_finish(int b) const noexcept {
  return is_built(b) && is_settled(b - 1) && is_settled(b + 1);
}

// Of two threads that settle neighbours at the same time, each first says that its own is built or
// overdue and then looks for the other's: in the one order of all these operations at least one of
// them sees both, and `taken` lets one of them go on.
void VolumeAssembler::built(int b) noexcept {
  progress_[static_cast<std::size_t>(b)].built.store(true);
  finish_around(b);
}

void VolumeAssembler::overdue(int b) noexcept {
  Progress& progress = progress_[static_cast<std::size_t>(b)];
  progress.overdue.store(true);
  BScanProgress awaited = BScanProgress::awaited; // else it has come after all
  finished_[static_cast<std::size_t>(b)].compare_exchange_strong(awaited, BScanProgress::overdue);
  finish_around(b);
}

void VolumeAssembler::finish_around(int b) noexcept {
  for (int candidate = std::max(b - 1, 0); candidate <= std::min(b + 1, geometry_.b_scans - 1);
       ++candidate)
    if (may_finish(candidate) &&
        !progress_[static_cast<std::size_t>(candidate)].taken.exchange(true))
      finish_b_scan(candidate);
}

void VolumeAssembler::finish() noexcept {
  for (int b = 0; b < geometry_.b_scans; ++b) {
    Progress& progress = progress_[static_cast<std::size_t>(b)];
    if (!progress.built.load())
      std::ranges::fill(volume_->b_scan(b), std::uint8_t{0});
    else if (progress.taken.exchange(true))
      continue;
    finish_b_scan(b);
  }
  volume_->metadata.upper_border = {};
  for (const BorderCount& border : borders_)
    volume_->metadata.upper_border += border;
}

void VolumeAssembler::finish_b_scan(int b) noexcept {
  const auto levels_of = [this](int of) {
    return is_built(of) ? std::span<const std::uint8_t>{own_levels(of)}
                        : std::span<const std::uint8_t>{};
  };
  if (is_built(b))
    average_.average(levels_of(b - 1), own_levels(b), levels_of(b + 1), volume_->b_scan(b));
  volume_->occupancy.update(b, volume_->b_scan(b));
  // A saturated line is bright at all depths.
  const auto at = static_cast<std::size_t>(b);
  borders_[at] =
      volume_->b_scan_states[at] == BScanState::good
          ? count_at_upper_border(volume_->b_scan(b), geometry_.depths, geometry_.a_scans)
          : BorderCount{};
  if (is_built(b))
    finished_[at].store(BScanProgress::finished, std::memory_order_release);
}

} // namespace octascope::pipeline

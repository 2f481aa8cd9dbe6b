// The volume that is shown in the mode "rolling": what is finished of the volume in the making over
// the last whole one. Between the two lies the seam, a B-scan that is blank, so that nothing is ever
// interpolated between voxels of the two; it is the next one to be renewed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "pipeline/acquisition/volume_feed.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// Never of more than two volumes. Each B-scan is of one, whole or blank: `work` has when it was
// exposed, its state that it is missing or the seam. It is a copy: whoever draws it reads no memory
// that anybody else writes.
//
// Threads: one at a time. Allocates on construction only.
class RollingVolume {
public:
  // `with_flow`: volumes have flow, which is taken with the rest of each B-scan.
  explicit RollingVolume(const VolumeGeometry& geometry, bool with_flow = false);

  // From now on all of it is of that volume, which must be a pipeline's of the same geometry and
  // newer than what was taken before. Copies what is not there yet.
  void take(const Volume& whole);

  // Takes what was finished of the volume in the making since the last call, in the order of the
  // scan up to the first B-scan that is awaited; one that is overdue is missing, unless it comes
  // after all. Nothing before the first take(), and nothing of another volume than before until the
  // whole one was taken. The seam is never moved onto B-scan `kept_clear`, which is shown by itself: the
  // one before it waits until both are there.
  void follow(const VolumeInMaking& making, int kept_clear);

  // The B-scans that changed since the last call, as ranges in order. Valid until the next call.
  std::span<const BScanRange> take_changes();

  // Its metadata are the last whole volume's.
  const Volume& volume() const { return volume_; }

  // The volume that a B-scan is of; 0: the seam.
  std::uint64_t number_of(int b) const { return numbers_[static_cast<std::size_t>(b)]; }

  struct Seam {
    int b_scan = 0;
    // Camera timestamps of the last lines beside it: of the newer and of the older volume. Where
    // nothing was received, of the nearest that was.
    hal::TimePoint newer, older;
  };
  // Empty: all is of one volume.
  std::optional<Seam> seam() const;

private:
  void copy(int b, const Volume& from, std::uint64_t number);
  void blank(int b, BScanState state, std::uint64_t number);
  int count_ready(const VolumeInMaking& making, int kept_clear) const;
  hal::TimePoint last_line_near(int b, int step) const;
  BScanState& state(int b) { return volume_.b_scan_states[static_cast<std::size_t>(b)]; }

  Volume volume_;
  std::vector<std::uint64_t> numbers_; // by B-scan
  std::uint64_t base_ = 0;             // of the last whole volume; 0: none
  std::uint64_t newer_ = 0;            // of the one shown over it; meaningless while `fresh_` is 0
  int fresh_ = 0;                      // B-scans of it, from the first
  std::vector<std::uint8_t> changed_;  // by B-scan
  std::vector<BScanRange> changes_;
};

} // namespace octascope::pipeline

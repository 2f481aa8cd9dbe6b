// Finishes the B-scans of a volume as they come: averages each with its neighbours, and notes where
// it is empty, as soon as the neighbours are there. When a sweep is over there is nothing left to
// do but its last two B-scans.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pipeline/acquisition/neighbour_average.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// Threads: begin() and finish() from one thread, with no other call at the same time; built() from
// any number of threads, once for each B-scan. Allocates when it is made, never afterwards.
class VolumeAssembler {
public:
  VolumeAssembler(const VolumeGeometry& geometry, const NeighbourAverage& average);

  // What follows is for this volume, which is borrowed until finish() and has the geometry given
  // above and an Occupancy for it.
  void begin(Volume& volume) noexcept;

  // Where B-scan `b` is to be built, as [a][z].
  std::span<std::uint8_t> own_levels(int b) noexcept;

  // B-scan `b` is built, with its state in the volume. Finishes those that waited for it.
  void built(int b) noexcept;

  // What has not come will not come: finishes what still waits, blanks what is missing, and notes
  // in the volume's metadata what lies at the upper border.
  void finish() noexcept;

private:
  struct Progress {
    std::atomic<bool> built{false};
    std::atomic<bool> taken{false}; // somebody finishes it, or has
  };

  bool is_built(int b) const noexcept;
  bool may_finish(int b) const noexcept;
  void finish_b_scan(int b) noexcept;

  VolumeGeometry geometry_;
  NeighbourAverage average_;
  Volume* volume_ = nullptr;
  std::vector<std::uint8_t> own_levels_; // before averaging, [b][a][z]
  std::unique_ptr<Progress[]> progress_; // by B-scan
  std::vector<BorderCount> borders_;     // likewise: written by whoever finishes it
};

} // namespace octascope::pipeline

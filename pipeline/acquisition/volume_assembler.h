// Finishes the B-scans of a volume while it is acquired: as soon as a B-scan and its neighbours are
// built, averages it with them and updates the volume's occupancy. When the last B-scan is built,
// only the last two are left to finish. A neighbour that is overdue is not waited for: what is
// finished without it stays so, also if it comes after all.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pipeline/acquisition/neighbour_average.h"
#include "pipeline/acquisition/volume_feed.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// Threads: begin() and finish() from one thread, with no other call at the same time; built() from
// any number of threads, once for each B-scan. Allocates on construction only.
class VolumeAssembler {
public:
  VolumeAssembler(const VolumeGeometry& geometry, const NeighbourAverage& average);

  // Starts `volume`, which is borrowed until finish(). It must have the geometry given above and an
  // Occupancy for it.
  void begin(Volume& volume) noexcept;

  // Where B-scan `b` is to be built, as [a][z].
  std::span<std::uint8_t> own_levels(int b) noexcept;

  // B-scan `b` is built and its state is set in the volume. Finishes those that waited for it.
  void built(int b) noexcept;

  // B-scan `b` was not built when it should have been: its neighbours wait for it no longer. Any
  // number of threads.
  void overdue(int b) noexcept;

  // How far each B-scan is: a finished one stays as it is until the next begin(). Any thread.
  std::span<const std::atomic<BScanProgress>> progress() const noexcept { return finished_; }

  // No more B-scans will come: finishes those that still wait, blanks the missing ones, and sets
  // upper_border in the volume's metadata.
  void finish() noexcept;

private:
  struct Progress {
    std::atomic<bool> built{false};
    std::atomic<bool> overdue{false};
    std::atomic<bool> taken{false}; // a thread is finishing it, or has finished it
  };

  bool is_built(int b) const noexcept;
  bool is_settled(int b) const noexcept;
  bool may_finish(int b) const noexcept;
  void finish_around(int b) noexcept;
  void finish_b_scan(int b) noexcept;

  VolumeGeometry geometry_;
  NeighbourAverage average_;
  Volume* volume_ = nullptr;
  std::vector<std::uint8_t> own_levels_; // before averaging, [b][a][z]
  std::unique_ptr<Progress[]> progress_; // by B-scan
  std::vector<std::atomic<BScanProgress>> finished_;
  std::vector<BorderCount> borders_; // by B-scan; written by the thread that finishes it
};

} // namespace octascope::pipeline

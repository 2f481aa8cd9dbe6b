// One volume of repeated sweeps with all that is true of it: what flow and vessels found in spectra
// are measured against.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "hal/result.h"
#include "sim/phantoms/phantom_tree.h"
#include "sim/spectra/volume_loop.h"

namespace octascope::sim {

struct RepeatedSweeps {
  // Lines of one sweep, [A-scan][sample], without the fly-back; sweeps 0 … plan().sweeps() − 1 in a
  // row are what `octascope reconstruct --shape B,A,N --repeats M` reads. Valid as long as this.
  std::span<const std::uint16_t> sweep(int number) const;

  const pipeline::ScanPlan& plan() const { return loop->plan(); }
  const Spectrometer& spectrometer() const { return loop->spectrometer(); } // for a calibration

  std::unique_ptr<VolumeLoop>
      loop;                // of one volume; 2 bytes a sample: 62 MB a repeat of the default plan
  std::vector<float> flow; // truth, [b][a][z] of plan().geometry(): flow_truth.h
  PhantomTree tree;        // truth, in the field of the phantom's suggested plan
};

// As VolumeLoop::make() with one volume, whatever config.volumes says. ErrorCode::invalid_argument
// also for a bidirectional plan: its lag decides which lines are A-scans.
hal::Result<RepeatedSweeps> simulate_repeats(VolumeLoopConfig config);

} // namespace octascope::sim

// What turns a run's frames into levels: the reconstructor that is faster here, a workspace per
// worker, and the running backgrounds.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/devices/devices.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "firmware-host/supervision/thread_roles.h"
#include "hal/result.h"
#include "pipeline/acquisition/neighbour_average.h"
#include "pipeline/acquisition/repeat_comparison.h"
#include "pipeline/acquisition/volume_thread.h"
#include "pipeline/reconstruction/background.h"
#include "pipeline/reconstruction/reconstructor.h"

namespace octascope::firmware_host {

// Must outlive the volumes' thread, whose workers use it.
class Reconstruction {
public:
  // Measures what the cache does not hold, which takes some tenths of a second, and stores it. The
  // devices' cameras and plan must exist. `flow`: repeats are compared, which the plan must allow
  // for.
  static hal::Result<std::unique_ptr<Reconstruction>> make(const Devices& devices,
                                                           const Configuration& configuration,
                                                           bool flow, ReconstructionCache& cache);

  // The parts of the volumes' thread's setup that concern reconstruction, once. `camera_buffers`:
  // frames that may be in flight.
  pipeline::VolumeThreadSetup volume_thread_setup(const pipeline::ScanPlan& plan,
                                                  int camera_buffers);

  const pipeline::Reconstructor& reconstructor() const { return reconstructor_; }
  const pipeline::Calibration& calibration() const { return calibration_; } // in use
  // A worker that has the frame: its running background, or nothing.
  std::span<const float> background_of(const hal::LineFrame& frame) const {
    return backgrounds_ ? backgrounds_->of(frame) : std::span<const float>{};
  }
  WorkerCores& worker_cores() { return worker_cores_; }
  const WorkerCores& worker_cores() const { return worker_cores_; }

private:
  Reconstruction(pipeline::Reconstructor reconstructor, pipeline::Calibration calibration,
                 const pipeline::NeighbourAverage& average, std::size_t workers,
                 const std::vector<int>& cores);

  int convert(std::size_t worker, const hal::LineFrame& frame, const pipeline::SweepBins& out);

  pipeline::Reconstructor reconstructor_;
  pipeline::Calibration calibration_;
  pipeline::NeighbourAverage average_;
  std::vector<pipeline::Reconstructor::Workspace> workspaces_; // one a worker
  std::optional<pipeline::FrameBackgrounds> backgrounds_;      // running ones
  std::optional<pipeline::RepeatComparison> comparison_;       // until somebody has it
  WorkerCores worker_cores_;
};

} // namespace octascope::firmware_host

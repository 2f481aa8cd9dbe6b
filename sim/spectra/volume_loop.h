// Precomputed volumes of a phantom's raw spectra, played in a loop.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "hal/result.h"
#include "pipeline/scan/scan_plan.h"
#include "sim/phantoms/phantom.h"
#include "sim/phantoms/phantom_profile.h"
#include "sim/spectra/beam_path.h"
#include "sim/spectra/spectra_source.h"
#include "sim/spectra/tissue_motion.h"
#include "sim/spectrometer/spectrometer.h"
#include "sim/spectrometer/spectrometer_synthesis.h"

namespace octascope::sim {

struct VolumeLoopConfig {
  std::string phantom = "anterior_eye";
  pipeline::ScanPlan plan;
  int volumes = 6; // in the loop; each takes plan.sweeps() frames of memory
  std::uint64_t seed = 1;
  double galvo_lag_us = 25; // of the mirror behind its command, bidirectional; as drivers leave it
  TissueMotion motion;      // as time goes by in the loop, so it jumps where the loop ends
  SpectrometerConfig spectrometer; // `samples` is replaced by the plan's

  hal::Result<> validate() const;
};

// The phantom with its suggested plan. ErrorCode::invalid_argument: no such phantom.
hal::Result<VolumeLoopConfig> suggested_loop(std::string_view phantom);

// Line l of sweep s of volume v shows the scene at the phase (v + (s + l/lines)/sweeps)/volumes:
// instruments move along their path once per loop, tissue keeps its speckle, flowing scatterers are new
// in each volume and move between the repeats of a B-scan (scatterer_motion.h) for as long as it
// takes the beam to come back, and noise differs from line to line. The beam is where the mirrors point
// (beam_path.h): at A-scan a, x = (a − (a_scans − 1)/2)·a_spacing; B-scan b lies at
// y = (b − (b_scans − 1)/2)·b_spacing, each of its repeats with fly-back or turn-around.
//
// make() computes the first volume, on all cores. A background thread of the lowest priority
// computes the others one by one. Until they are ready, frame() loops over the ready ones; a volume
// number keeps its place in the loop while its B-scans are read in order. The destructor stops the
// computation within a line's time.
class VolumeLoop final : public SpectraSource {
public:
  // Plans an FFT (see SpectrumSynthesis) and takes some tenths of a second.
  static hal::Result<std::unique_ptr<VolumeLoop>> make(const VolumeLoopConfig& config);
  ~VolumeLoop() override;

  const hal::LineFormat& format() const override { return format_; }
  int sweeps() const override { return config_.plan.sweeps(); }
  int alike_every() const override;
  int sweeps_per_b_scan() const override { return config_.plan.repeats; }
  std::span<const std::byte> frame(std::uint64_t volume, int sweep) const override;
  std::string description() const override;

  const Spectrometer& spectrometer() const { return spectrometer_; }
  const Phantom& phantom() const { return *phantom_; }
  const BeamPath& beam_path() const { return beam_path_; } // ground truth for tests
  const pipeline::ScanPlan& plan() const { return config_.plan; }
  int volumes() const { return config_.volumes; }
  // Thread-safe; rises from 1 to volumes().
  int ready_volumes() const { return ready_.load(std::memory_order_acquire); }
  hal::Duration loop_duration() const;

private:
  class LineMaker;

  VolumeLoop(const VolumeLoopConfig& config, const Spectrometer& spectrometer,
             std::unique_ptr<Phantom> phantom);

  std::size_t samples_per_frame() const;
  void make_first_volume();
  void make_further_volumes(const std::stop_token& stop);
  int place_of(std::uint64_t volume) const;

  VolumeLoopConfig config_;
  hal::LineFormat format_;
  Spectrometer spectrometer_;
  std::unique_ptr<Phantom> phantom_;
  BeamPath beam_path_;
  SpectrumSynthesis synthesis_;
  ProfileMaker profiles_;
  std::vector<std::unique_ptr<std::uint16_t[]>> ring_; // the first ready_ are computed
  std::atomic<int> ready_{0};
  // The last requested volume and its place in the ring: (volume + 1)·256 + place.
  mutable std::atomic<std::uint64_t> served_{0};
  std::jthread background_; // last member: stops before what it works on is destroyed
};

} // namespace octascope::sim

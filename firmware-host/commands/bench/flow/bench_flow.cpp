#include "firmware-host/commands/bench/flow/bench_flow.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <span>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "firmware-host/commands/bench/flow/true_vessels.h"
#include "firmware-host/commands/bench/flow/voxel_truth.h"
#include "pipeline/angiography/b_scan_flow.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/vessels/tracing/vessel_tracer.h"
#include "sim/spectra/repeated_sweeps.h"

namespace octascope::firmware_host {

namespace {

using pipeline::FlowMethod;

constexpr std::array methods{FlowMethod::complex_bins, FlowMethod::intensity};

sim::VolumeLoopConfig scene_config(const sim::VolumeLoopConfig& phantom, int repeats, int b_scans) {
  sim::VolumeLoopConfig config = phantom;
  config.plan.repeats = repeats;
  config.plan.b_scans = b_scans;
  config.motion = bench_motion();
  return config;
}

hal::Result<pipeline::Reconstructor> make_reconstructor(const sim::RepeatedSweeps& sweeps) {
  const sim::Spectrometer& spectrometer = sweeps.spectrometer();
  pipeline::ReconstructionSetup setup;
  setup.calibration = pipeline::Calibration::identity(spectrometer.samples());
  setup.calibration.positions = spectrometer.true_k_positions();
  setup.calibration.dispersion_rad = spectrometer.true_dispersion_rad();
  setup.calibration.background_mode = pipeline::BackgroundMode::mean;
  setup.format = pipeline::SpectrumFormat{sweeps.loop->format()};
  setup.a_scans = sweeps.plan().a_scans;
  return pipeline::Reconstructor::create(setup);
}

// What one method made of the sweeps.
struct MethodResult {
  FlowTally tally;
  int left_out_b_scans = 0;
  std::vector<float> flow; // [b][a][z]
};

// Threads take one B-scan after the other.
class FlowMeasurement {
public:
  FlowMeasurement(const sim::RepeatedSweeps& sweeps, const pipeline::Reconstructor& reconstructor)
      : sweeps_(sweeps), reconstructor_(reconstructor) {
    for (MethodResult& result : results_)
      result.flow.resize(sweeps.plan().geometry().voxels());
  }

  hal::Result<> run() {
    {
      const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
      std::vector<std::jthread> workers;
      for (unsigned i = 0; i < cores; ++i)
        workers.emplace_back([this] {
          if (auto done = work(); !done) {
            const std::scoped_lock lock{mutex_};
            outcome_ = std::move(done);
          }
        });
    }
    return outcome_;
  }

  std::array<MethodResult, methods.size()>& results() { return results_; }

private:
  hal::Result<> work() {
    const pipeline::ScanPlan& plan = sweeps_.plan();
    const std::size_t voxels = plan.geometry().b_scan_voxels();
    auto workspace = reconstructor_.make_workspace();
    std::vector<pipeline::BScanFlow> flows;
    for (const FlowMethod method : methods) {
      HAL_TRY(auto flow, pipeline::BScanFlow::create(
                             {plan.repeats, plan.a_scans, plan.geometry().depths, method}));
      flows.push_back(std::move(flow));
    }
    VoxelTruth truth{sweeps_, bench_motion()};
    std::vector<std::uint8_t> levels(voxels);
    std::vector<pipeline::PackedBin> bins(voxels * static_cast<std::size_t>(plan.repeats));
    std::vector<float> decorrelation(voxels);
    std::array<FlowTally, methods.size()> tallies;
    std::array<int, methods.size()> left_out{};
    for (int b = next_++; b < plan.b_scans; b = next_++) {
      for (int m = 0; m < plan.repeats; ++m)
        reconstructor_.reconstruct_b_scan_both(
            workspace, std::as_bytes(sweeps_.sweep(b * plan.repeats + m)),
            std::span{bins}.subspan(static_cast<std::size_t>(m) * voxels, voxels), levels);
      truth.look_at(b, bins);
      for (std::size_t i = 0; i < methods.size(); ++i) {
        const auto flow =
            std::span{results_[i].flow}.subspan(static_cast<std::size_t>(b) * voxels, voxels);
        left_out[i] += flows[i].compute(bins, flow, decorrelation).left_out ? 1 : 0;
        tallies[i].add_voxels(truth.kinds(), truth.radii_um(), flow);
      }
    }
    const std::scoped_lock lock{mutex_};
    for (std::size_t i = 0; i < methods.size(); ++i) {
      results_[i].tally.add(tallies[i]);
      results_[i].left_out_b_scans += left_out[i];
    }
    return {};
  }

  const sim::RepeatedSweeps& sweeps_;
  const pipeline::Reconstructor& reconstructor_;
  std::atomic<int> next_{0};
  std::mutex mutex_; // of the tallies and the outcome
  std::array<MethodResult, methods.size()> results_;
  hal::Result<> outcome_;
};

hal::Result<TreeFigures> trace_and_compare(const sim::RepeatedSweeps& sweeps,
                                           std::span<const float> flow) {
  const pipeline::VolumeGeometry geometry = sweeps.plan().geometry();
  HAL_TRY(const auto traced, pipeline::VesselTracer{}.trace(geometry, flow));
  return TreeFigures{
      traced.refusal, traced.quality,
      pipeline::compare_trees(traced.tree, vessels_within(geometry, sweeps.loop->phantom()),
                              {.least_radius_mm = static_cast<float>(traced_radius_um * 1e-3)})};
}

} // namespace

sim::TissueMotion bench_motion() {
  return {.axial = {{10, 20}}, .lateral = {}};
}

hal::Result<pipeline::TracedVessels> trace_bench_scene(int repeats) {
  HAL_TRY(const auto phantom, sim::suggested_loop("perfused"));
  HAL_TRY(const auto sweeps,
          sim::simulate_repeats(scene_config(phantom, repeats, pipeline::ScanPlan{}.b_scans)));
  HAL_TRY(const auto reconstructor, make_reconstructor(sweeps));
  FlowMeasurement measurement{sweeps, reconstructor};
  HAL_CHECK(measurement.run());
  return pipeline::VesselTracer{}.trace(sweeps.plan().geometry(),
                                        measurement.results().front().flow);
}

hal::Result<FlowBenchReport> bench_flow(const FlowBenchOptions& options, const FlowProbe& probe,
                                        const std::function<void(const std::string&)>& progress) {
  HAL_TRY(const auto phantom, sim::suggested_loop("perfused"));
  FlowBenchReport report;
  for (const int repeats : options.repeats) {
    const sim::VolumeLoopConfig config = scene_config(phantom, repeats, options.b_scans);
    report.plan = config.plan;
    progress(fmt::format("{} repeats: simulating {} sweeps", repeats, config.plan.sweeps()));
    HAL_TRY(const auto sweeps, sim::simulate_repeats(config));
    HAL_TRY(const auto reconstructor, make_reconstructor(sweeps));
    progress(fmt::format("{} repeats: flow", repeats));
    FlowMeasurement measurement{sweeps, reconstructor};
    HAL_CHECK(measurement.run());
    progress(fmt::format("{} repeats: vessels", repeats));
    for (std::size_t i = 0; i < methods.size(); ++i) {
      MethodResult& result = measurement.results()[i];
      HAL_TRY(auto tree, trace_and_compare(sweeps, result.flow));
      report.cases.push_back({.repeats = repeats,
                              .method = methods[i],
                              .left_out_b_scans = result.left_out_b_scans,
                              .flow = std::move(result.tally).figures(),
                              .tree = std::move(tree),
                              .live = {}});
    }
  }
  // Their memory is given back by now.
  for (FlowBenchCase& what : report.cases) {
    if (what.method != FlowMethod::complex_bins)
      continue;
    progress(fmt::format("{} repeats: live", what.repeats));
    HAL_TRY(what.live, probe(what.repeats));
  }
  return report;
}

} // namespace octascope::firmware_host

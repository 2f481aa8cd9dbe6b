#include "firmware-host/reconstruction/reconstruction.h"

#include <algorithm>
#include <span>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "firmware-host/terminal/terminal.h"
#include "hal/linux/realtime.h"

namespace octascope::firmware_host {

hal::Result<std::unique_ptr<Reconstruction>>
Reconstruction::make(const Devices& devices, const Configuration& configuration, bool flow,
                     ReconstructionCache& cache) {
  pipeline::Calibration calibration = devices.calibration();
  const pipeline::ScanPlan& plan = devices.plan();
  if (const auto words = pipeline::replace_background_of_few_lines(
          calibration, plan.converted_lines(), plan.sweeps()))
    warn("octascope run: {}\n", *words);
  HAL_TRY(auto made,
          pipeline::Reconstructor::create({.calibration = calibration,
                                           .format = pipeline::SpectrumFormat{devices.format()},
                                           .a_scans = plan.converted_lines(),
                                           .memory = &cache,
                                           .limit_saturated_lines = true}));
  static_cast<void>(cache.save()); // what was not kept is measured again; the doctor says why
  HAL_TRY(const auto average, pipeline::NeighbourAverage::create(configuration.neighbour_weights));
  const std::size_t workers = configuration.workers > 0
                                  ? configuration.workers
                                  : std::max(1U, std::thread::hardware_concurrency());
  std::unique_ptr<Reconstruction> reconstruction{new Reconstruction{
      std::move(made), std::move(calibration), average, workers, configuration.worker_cores}};
  if (flow) {
    HAL_TRY(auto comparison,
            pipeline::RepeatComparison::create(
                plan, workers,
                [made = reconstruction.get()](std::size_t worker, const hal::LineFrame& frame,
                                              const pipeline::SweepBins& out) {
                  return made->convert(worker, frame, out);
                }));
    reconstruction->comparison_ = std::move(comparison);
  }
  return reconstruction;
}

int Reconstruction::convert(std::size_t worker, const hal::LineFrame& frame,
                            const pipeline::SweepBins& out) {
  const int saturated = reconstructor_
                            .reconstruct_b_scan_both(workspaces_[worker], frame.bytes, out.bins,
                                                     out.levels, background_of(frame))
                            .saturated_lines;
  const auto by_line = reconstructor_.saturated_lines(workspaces_[worker]);
  for (std::size_t line = 0; saturated > 0 && line < out.saturated.size(); ++line)
    out.saturated[line] |= by_line[line];
  return saturated;
}

Reconstruction::Reconstruction(pipeline::Reconstructor reconstructor,
                               pipeline::Calibration calibration,
                               const pipeline::NeighbourAverage& average, std::size_t workers,
                               const std::vector<int>& cores)
    : reconstructor_{std::move(reconstructor)}, calibration_{std::move(calibration)},
      average_{average}, worker_cores_{workers, cores, hal::linux_backend::allowed_cores()} {
  for (std::size_t worker = 0; worker < workers; ++worker)
    workspaces_.push_back(reconstructor_.make_workspace());
}

pipeline::VolumeThreadSetup Reconstruction::volume_thread_setup(const pipeline::ScanPlan& plan,
                                                                int camera_buffers) {
  if (auto running = reconstructor_.make_running_background(plan.sweeps()))
    backgrounds_.emplace(std::move(*running), reconstructor_.samples(), camera_buffers);
  return {
      .plan = plan,
      .trigger = {},
      .workers = workspaces_.size(),
      .reconstruct =
          [this](std::size_t worker, const hal::LineFrame& frame, std::span<std::uint8_t> levels) {
            return reconstructor_
                .reconstruct_b_scan(workspaces_[worker], frame.bytes, levels, background_of(frame))
                .saturated_lines;
          },
      .observe =
          [this](const hal::LineFrame& frame) {
            if (backgrounds_)
              backgrounds_->take(frame);
          },
      .observe_volume = {},
      .average = average_,
      .most_volumes = {},
      .comparison = std::exchange(comparison_, std::nullopt)};
}

} // namespace octascope::firmware_host

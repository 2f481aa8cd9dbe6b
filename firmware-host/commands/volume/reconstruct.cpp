#include "firmware-host/commands/volume/reconstruct.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "firmware-host/commands/level_picture.h"
#include "firmware-host/commands/volume/flow_volumes.h"
#include "firmware-host/commands/volume/reconstruct_input.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/acquisition/b_scan_builder.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/scan/sweep_alignment.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::firmware_host {

namespace {

using hal::ErrorCode;

// The mean of the levels of several sweeps, as the display has it (b_scan_builder.h).
void average_sweeps(const std::vector<std::vector<float>>& sweeps, std::vector<float>& average) {
  average = sweeps.front();
  for (std::size_t m = 1; m < sweeps.size(); ++m)
    std::ranges::transform(average, sweeps[m], average.begin(), std::plus<>{});
  const float part = 1.0F / static_cast<float>(sweeps.size());
  for (float& level : average)
    level *= part;
}

void average_sweeps(const std::vector<std::vector<std::uint8_t>>& sweeps,
                    std::vector<std::uint8_t>& average) {
  std::vector<std::uint8_t> all;
  for (const auto& sweep : sweeps)
    all.insert(all.end(), sweep.begin(), sweep.end());
  pipeline::average_repeats(all, static_cast<int>(sweeps.size()), average);
}

// The workers take one B-scan, with its repeats, after the other; the first error ends the work.
class VolumeReconstruction {
public:
  VolumeReconstruction(const ReconstructOptions& options, const ReconstructInput& input,
                       const pipeline::Reconstructor& reconstructor,
                       const pipeline::NrrdWriter& writer, FlowVolumes* flow)
      : options_(options), input_(input), spectra_(input.spectra), reconstructor_(reconstructor),
        writer_(writer), flow_(flow), b_scans_(input.b_scans()) {
    if (input.backgrounds.empty())
      running_background_ = reconstructor.make_running_background(spectra_.shape().b_scans);
    if (input.plan)
      alignment_ = pipeline::SweepAlignment{*input.plan, input.plan->scan_lag_a_scans};
  }

  hal::Result<> run(unsigned threads);

  int saturated_lines() const { return saturated_lines_.load(); }
  // Levels in dB of the B-scan that a picture was asked of.
  const std::vector<float>& picture_levels() const { return picture_levels_; }

private:
  void work();
  void look_ahead();
  int take_next(std::vector<std::vector<float>>& running);
  std::span<const float> recorded_background(int sweep) const;
  hal::Result<> check_counts(int sweep) const;
  template <class Level> hal::Result<> reconstruct_all();
  template <class Level>
  void reconstruct_sweep(pipeline::Reconstructor::Workspace& workspace, int sweep,
                         const std::vector<float>& running, std::vector<Level>& lines,
                         std::vector<Level>& a_scans);
  template <class Level> void keep_for_picture(const std::vector<Level>& levels);
  void show_progress();

  const ReconstructOptions& options_;
  const ReconstructInput& input_;
  const pipeline::SpectraFile& spectra_;
  const pipeline::Reconstructor& reconstructor_;
  const pipeline::NrrdWriter& writer_;
  FlowVolumes* const flow_; // may be null
  const int b_scans_;       // of the volume
  std::mutex taking_;       // B-scans are taken in order, and so is their running background
  int next_ = 0;
  std::optional<pipeline::RunningBackground> running_background_;
  pipeline::SweepAlignment alignment_; // of a recording
  std::atomic<int> done_{0};
  std::atomic<int> saturated_lines_{0};
  std::vector<float> picture_levels_; // written by the one worker that has the B-scan

  std::mutex mutex_;
  std::condition_variable finished_; // a worker has
  unsigned running_ = 0;
  hal::Result<> outcome_;
};

hal::Result<> VolumeReconstruction::run(unsigned threads) {
  look_ahead();
  running_ = threads;
  std::vector<std::jthread> workers;
  for (unsigned i = 0; i < threads; ++i)
    workers.emplace_back([this] { work(); });
  show_progress();
  workers.clear(); // joins
  return outcome_;
}

void VolumeReconstruction::work() {
  auto result =
      options_.display_counts ? reconstruct_all<std::uint8_t>() : reconstruct_all<float>();
  if (!result) {
    const std::scoped_lock lock{taking_};
    next_ = b_scans_;
  }
  const std::scoped_lock lock{mutex_};
  if (!result && outcome_)
    outcome_ = std::move(result);
  --running_;
  finished_.notify_all();
}

// Nothing was before the first B-scan, but what comes after it is at hand: as if the volume had
// been before.
void VolumeReconstruction::look_ahead() {
  for (int b = 0; running_background_ && b < spectra_.shape().b_scans; ++b)
    running_background_->add(spectra_.b_scan(b));
}

// The number of a B-scan that nobody has yet, and the running background of each of its sweeps; the
// volume's count when all are taken.
int VolumeReconstruction::take_next(std::vector<std::vector<float>>& running) {
  const std::scoped_lock lock{taking_};
  if (next_ == b_scans_)
    return next_;
  for (std::size_t m = 0; m < running.size(); ++m) {
    const int sweep = next_ * input_.repeats + static_cast<int>(m);
    const auto mean = running_background_ ? running_background_->add(spectra_.b_scan(sweep))
                                          : recorded_background(sweep);
    running[m].assign(mean.begin(), mean.end());
  }
  return next_++;
}

std::span<const float> VolumeReconstruction::recorded_background(int sweep) const {
  const auto samples = static_cast<std::size_t>(input_.format.samples);
  return input_.backgrounds.empty() ? std::span<const float>{}
                                    : std::span{input_.backgrounds}.subspan(
                                          samples * static_cast<std::size_t>(sweep), samples);
}

hal::Result<> VolumeReconstruction::check_counts(int sweep) const {
  if (const auto fault = spectra_.find_fault(sweep))
    return hal::fail(ErrorCode::bad_data, *fault);
  if (const auto fault = spectra_.find_above_full_scale(sweep, input_.format))
    return hal::fail(ErrorCode::bad_data, *fault + "; another --dtype or --shift");
  return {};
}

template <class Level>
void VolumeReconstruction::reconstruct_sweep(pipeline::Reconstructor::Workspace& workspace,
                                             int sweep, const std::vector<float>& running,
                                             std::vector<Level>& lines,
                                             std::vector<Level>& a_scans) {
  const bool bidirectional = input_.plan && input_.plan->bidirectional;
  std::vector<Level>& levels = bidirectional ? lines : a_scans;
  pipeline::BScanOutcome outcome;
  if constexpr (std::is_same_v<Level, float>)
    outcome =
        reconstructor_.reconstruct_b_scan_db(workspace, spectra_.b_scan(sweep), levels, running);
  else
    outcome = reconstructor_.reconstruct_b_scan(workspace, spectra_.b_scan(sweep), levels, running);
  saturated_lines_.fetch_add(outcome.saturated_lines);
  if (bidirectional)
    alignment_.apply(std::span<const Level>{lines}, input_.plan->runs_backwards(sweep),
                     std::span{a_scans});
}

template <class Level> hal::Result<> VolumeReconstruction::reconstruct_all() {
  auto workspace = reconstructor_.make_workspace();
  const auto repeats = static_cast<std::size_t>(input_.repeats);
  const std::size_t size = input_.geometry().b_scan_voxels();
  std::vector<std::vector<Level>> sweeps(repeats, std::vector<Level>(size));
  std::vector<Level> average(repeats > 1 ? size : 0);
  std::vector<Level> lines(reconstructor_.levels());
  std::vector<std::vector<float>> running(repeats);
  std::optional<FlowVolumes::Worker> flow;
  std::vector<std::uint8_t> levels_of_bins(flow_ != nullptr ? reconstructor_.levels() : 0);
  if (flow_ != nullptr) {
    HAL_TRY(flow, flow_->make_worker());
  }
  for (int b = take_next(running); b < b_scans_; b = take_next(running)) {
    for (std::size_t m = 0; m < repeats; ++m) {
      const int sweep = b * input_.repeats + static_cast<int>(m);
      HAL_CHECK(check_counts(sweep));
      reconstruct_sweep(workspace, sweep, running[m], lines, sweeps[m]);
      if (flow)
        reconstructor_.reconstruct_b_scan_both(workspace, spectra_.b_scan(sweep), flow->bins(m),
                                               levels_of_bins, running[m]);
    }
    if (repeats > 1)
      average_sweeps(sweeps, average);
    const std::vector<Level>& levels = repeats > 1 ? average : sweeps.front();
    HAL_CHECK(writer_.write_b_scan(b, levels));
    if (flow)
      HAL_CHECK(flow->write_b_scan(b));
    if (options_.picture && b == options_.picture_b_scan)
      keep_for_picture(levels);
    done_.fetch_add(1);
  }
  return {};
}

template <class Level>
void VolumeReconstruction::keep_for_picture(const std::vector<Level>& levels) {
  picture_levels_.resize(levels.size());
  std::transform(levels.begin(), levels.end(), picture_levels_.begin(), [](Level level) {
    if constexpr (std::is_same_v<Level, float>)
      return level;
    else
      return pipeline::level_db(level);
  });
}

// Returns when all workers have finished.
void VolumeReconstruction::show_progress() {
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  std::unique_lock lock{mutex_};
  while (!finished_.wait_for(lock, std::chrono::milliseconds{200}, [&] { return running_ == 0; })) {
    if (terminal)
      firmware_host::show_progress(fmt::format("{} of {} B-scans", done_.load(), b_scans_));
  }
  if (terminal)
    firmware_host::show_progress("");
}

unsigned worker_count(const ReconstructOptions& options, int b_scans) {
  const unsigned wanted =
      options.threads > 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
  return std::min(wanted, static_cast<unsigned>(b_scans));
}

hal::Result<> check(const ReconstructOptions& options) {
  if (options.picture && options.picture->lexically_normal() == options.volume.lexically_normal())
    return hal::fail(ErrorCode::invalid_argument, "--out and --png are both {}, expected two files",
                     options.volume.string());
  return {};
}

hal::Result<> check(const ReconstructOptions& options, const ReconstructInput& input) {
  if (options.picture && (options.picture_b_scan < 0 || options.picture_b_scan >= input.b_scans()))
    return hal::fail(ErrorCode::invalid_argument, "--bscan is {}, expected 0 to {}",
                     options.picture_b_scan, input.b_scans() - 1);
  if ((options.flow || options.decorrelation) && input.plan && input.plan->bidirectional)
    return hal::fail(ErrorCode::invalid_argument,
                     "--flow and --decorrelation compare sweeps of one direction, and {} is of a "
                     "bidirectional scan",
                     options.spectra.string());
  return {};
}

// A recording's levels are to be what they were, so the same instructions compute them where this
// processor has them; else those it has.
hal::Result<pipeline::Reconstructor> make_reconstructor(const ReconstructOptions& options,
                                                        const ReconstructInput& input,
                                                        ReconstructionCache& cache) {
  pipeline::ReconstructionSetup setup{.calibration = input.calibration,
                                      .format = input.format,
                                      .a_scans = input.spectra.shape().a_scans,
                                      .path = input.path,
                                      .fused_isa = input.isa,
                                      .memory = &cache,
                                      .limit_saturated_lines =
                                          input.plan && options.display_counts};
  auto made = pipeline::Reconstructor::create(setup);
  if (made || input.isa.empty())
    return made;
  setup.fused_isa = {};
  made = pipeline::Reconstructor::create(setup);
  if (made)
    warn("warning: the recording's levels were computed with {}, these with {}: some differ by one "
         "count\n",
         input.isa, made->isa());
  return made;
}

} // namespace

hal::Result<> reconstruct_volume(const ReconstructOptions& options) {
  HAL_CHECK(check(options));
  HAL_TRY(auto input, open_input(options));
  HAL_CHECK(check(options, input));
  if (const auto words = pipeline::replace_background_of_few_lines(
          input.calibration, input.spectra.shape().a_scans, input.spectra.shape().b_scans))
    warn("warning: {}\n", *words);
  if (options.calibration)
    if (const auto doubt = pipeline::doubt_about_k_table(input.calibration, *options.calibration))
      warn("warning: {}\n", *doubt);
  ReconstructionCache cache;
  HAL_TRY(const auto reconstructor, make_reconstructor(options, input, cache));
  static_cast<void>(cache.save()); // what was not kept is measured again; the doctor says why

  const pipeline::VolumeGeometry geometry = input.geometry();
  HAL_TRY(auto writer,
          pipeline::NrrdWriter::create(options.volume, geometry,
                                       options.display_counts ? pipeline::NrrdType::uint8
                                                              : pipeline::NrrdType::float32));
  std::optional<FlowVolumes> flow;
  if (options.flow || options.decorrelation) {
    HAL_TRY(auto volumes, FlowVolumes::create({.repeats = input.repeats,
                                               .a_scans = geometry.a_scans,
                                               .depths = reconstructor.depths()},
                                              geometry, options.flow, options.decorrelation));
    flow.emplace(std::move(volumes));
  }
  VolumeReconstruction work{options, input, reconstructor, writer, flow ? &*flow : nullptr};
  HAL_CHECK(work.run(worker_count(options, input.b_scans())));
  HAL_CHECK(writer.commit());
  if (flow) {
    HAL_CHECK(flow->commit());
    if (flow->left_out() > 0)
      warn("warning: the flow of {} of {} B-scans is not told: their repeats have nothing in "
           "common, or moved too far\n",
           flow->left_out(), geometry.b_scans);
  }
  if (geometry.assumed.any())
    warn("octascope reconstruct: warning: spacings are assumed: {} ({:.4g}, {:.4g}, {:.4g} "
         "µm); [depth] of a calibration gives them\n",
         geometry.assumed.words(), geometry.depth_spacing_um, geometry.a_spacing_um,
         geometry.b_spacing_um);
  if (work.saturated_lines() > 0)
    warn("warning: {} of {} lines are saturated\n", work.saturated_lines(),
         input.spectra.shape().lines());
  if (!options.picture)
    return {};
  return pipeline::write_png(*options.picture,
                             draw_b_scan(work.picture_levels(), geometry.depths, geometry.a_scans));
}

} // namespace octascope::firmware_host

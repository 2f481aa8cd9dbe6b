#include "firmware-host/commands/reconstruct.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "firmware-host/commands/level_picture.h"
#include "pipeline/level_scale.h"
#include "pipeline/nrrd.h"
#include "pipeline/reconstructor.h"

namespace octascope::firmware_host {

namespace {

using hal::Fault;

// The workers take B-scans from a shared counter; the first error ends the work.
class VolumeReconstruction {
public:
  VolumeReconstruction(const ReconstructOptions& options, const pipeline::SpectraFile& spectra,
                       const pipeline::Reconstructor& reconstructor,
                       const pipeline::NrrdWriter& writer)
      : options_(options), spectra_(spectra), reconstructor_(reconstructor), writer_(writer) {}

  hal::Result<> run(unsigned threads);

  int saturated_lines() const { return saturated_lines_.load(); }
  // Levels in dB of the B-scan that a picture was asked of.
  const std::vector<float>& picture_levels() const { return picture_levels_; }

private:
  void work();
  template <class Level> hal::Result<> reconstruct_all();
  template <class Level> void keep_for_picture(const std::vector<Level>& levels);
  void show_progress();

  const ReconstructOptions& options_;
  const pipeline::SpectraFile& spectra_;
  const pipeline::Reconstructor& reconstructor_;
  const pipeline::NrrdWriter& writer_;
  std::atomic<int> next_{0};
  std::atomic<int> done_{0};
  std::atomic<int> saturated_lines_{0};
  std::vector<float> picture_levels_; // written by the one worker that has the B-scan

  std::mutex mutex_;
  std::condition_variable finished_; // a worker has
  unsigned running_ = 0;
  hal::Result<> outcome_;
};

hal::Result<> VolumeReconstruction::run(unsigned threads) {
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
  const std::scoped_lock lock{mutex_};
  if (!result && outcome_) {
    outcome_ = std::move(result);
    next_.store(spectra_.shape().b_scans);
  }
  --running_;
  finished_.notify_all();
}

template <class Level> hal::Result<> VolumeReconstruction::reconstruct_all() {
  auto workspace = reconstructor_.make_workspace();
  std::vector<Level> levels(reconstructor_.levels());
  for (int b = next_.fetch_add(1); b < spectra_.shape().b_scans; b = next_.fetch_add(1)) {
    if (const auto fault = spectra_.find_non_finite(b))
      return hal::fail(Fault::bad_data, *fault);
    pipeline::BScanOutcome outcome;
    if constexpr (std::is_same_v<Level, float>)
      outcome = reconstructor_.reconstruct_b_scan_db(workspace, spectra_.b_scan(b), levels);
    else
      outcome = reconstructor_.reconstruct_b_scan(workspace, spectra_.b_scan(b), levels);
    saturated_lines_.fetch_add(outcome.saturated_lines);
    if (auto written = writer_.write_b_scan(b, levels); !written)
      return written;
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
      fmt::print(stderr, "\r{} of {} B-scans", done_.load(), spectra_.shape().b_scans);
  }
  if (terminal)
    fmt::print(stderr, "\r\033[K");
}

unsigned worker_count(const ReconstructOptions& options, const pipeline::Calibration& calibration) {
  // A running background depends on the B-scans before: in order, whatever the machine has.
  if (calibration.background_mode == pipeline::BackgroundMode::running)
    return 1;
  const unsigned wanted =
      options.threads > 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
  return std::min(wanted, static_cast<unsigned>(options.shape.b_scans));
}

hal::Result<> check(const ReconstructOptions& options) {
  if (options.picture &&
      (options.picture_b_scan < 0 || options.picture_b_scan >= options.shape.b_scans))
    return hal::fail(Fault::invalid_argument,
                     fmt::format("--bscan is {}, expected 0 to {}", options.picture_b_scan,
                                 options.shape.b_scans - 1));
  if (options.picture && options.picture->lexically_normal() == options.volume.lexically_normal())
    return hal::fail(
        Fault::invalid_argument,
        fmt::format("--out and --png are both {}, expected two files", options.volume.string()));
  return {};
}

} // namespace

hal::Result<> reconstruct_volume(const ReconstructOptions& options) {
  if (auto checked = check(options); !checked)
    return checked;
  const int samples = options.shape.samples;
  auto spectra = pipeline::SpectraFile::open(options.spectra, options.shape, options.type);
  if (!spectra)
    return tl::make_unexpected(spectra.error());
  hal::Result<pipeline::Calibration> calibration = pipeline::Calibration::identity(samples);
  if (options.calibration)
    calibration = pipeline::Calibration::load(*options.calibration, samples);
  if (!calibration)
    return tl::make_unexpected(calibration.error());
  const auto reconstructor = pipeline::Reconstructor::create(
      {*calibration, pipeline::SpectrumFormat{samples, options.type}, options.shape.a_scans});
  if (!reconstructor)
    return tl::make_unexpected(reconstructor.error());

  const pipeline::VolumeGeometry geometry{reconstructor->depths(),   options.shape.a_scans,
                                          options.shape.b_scans,     calibration->depth_spacing_um,
                                          calibration->a_spacing_um, calibration->b_spacing_um};
  auto writer = pipeline::NrrdWriter::create(options.volume, geometry,
                                             options.display_counts ? pipeline::NrrdType::uint8
                                                                    : pipeline::NrrdType::float32);
  if (!writer)
    return tl::make_unexpected(writer.error());
  VolumeReconstruction work{options, *spectra, *reconstructor, *writer};
  if (auto done = work.run(worker_count(options, *calibration)); !done)
    return done;
  if (auto committed = writer->commit(); !committed)
    return committed;
  if (work.saturated_lines() > 0)
    fmt::print(stderr, "warning: {} of {} lines are saturated\n", work.saturated_lines(),
               options.shape.lines());
  if (!options.picture)
    return {};
  return pipeline::write_png(*options.picture,
                             draw_b_scan(work.picture_levels(), geometry.depths, geometry.a_scans));
}

} // namespace octascope::firmware_host

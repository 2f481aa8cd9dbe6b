#include "firmware-host/commands/volume/reconstruct.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "firmware-host/commands/level_picture.h"
#include "firmware-host/commands/spectra_type.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::firmware_host {

namespace {

using hal::ErrorCode;

// The workers take one B-scan after the other; the first error ends the work.
class VolumeReconstruction {
public:
  VolumeReconstruction(const ReconstructOptions& options, const pipeline::SpectrumFormat& format,
                       const pipeline::SpectraFile& spectra,
                       const pipeline::Reconstructor& reconstructor,
                       const pipeline::NrrdWriter& writer)
      : options_(options), format_(format), spectra_(spectra), reconstructor_(reconstructor),
        writer_(writer),
        running_background_(reconstructor.make_running_background(spectra.shape().b_scans)) {}

  hal::Result<> run(unsigned threads);

  int saturated_lines() const { return saturated_lines_.load(); }
  // Levels in dB of the B-scan that a picture was asked of.
  const std::vector<float>& picture_levels() const { return picture_levels_; }

private:
  void work();
  void look_ahead();
  int take_next(std::vector<float>& running);
  hal::Result<> check_counts(int b_scan) const;
  template <class Level> hal::Result<> reconstruct_all();
  template <class Level> void keep_for_picture(const std::vector<Level>& levels);
  void show_progress();

  const ReconstructOptions& options_;
  const pipeline::SpectrumFormat& format_;
  const pipeline::SpectraFile& spectra_;
  const pipeline::Reconstructor& reconstructor_;
  const pipeline::NrrdWriter& writer_;
  std::mutex taking_; // B-scans are taken in order, and so is their running background
  int next_ = 0;
  std::optional<pipeline::RunningBackground> running_background_;
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
    next_ = spectra_.shape().b_scans;
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

// The number of a B-scan that nobody has yet, and its running background; B when all are taken.
int VolumeReconstruction::take_next(std::vector<float>& running) {
  const std::scoped_lock lock{taking_};
  if (next_ == spectra_.shape().b_scans)
    return next_;
  if (running_background_) {
    const auto mean = running_background_->add(spectra_.b_scan(next_));
    running.assign(mean.begin(), mean.end());
  }
  return next_++;
}

hal::Result<> VolumeReconstruction::check_counts(int b_scan) const {
  if (const auto fault = spectra_.find_non_finite(b_scan))
    return hal::fail(ErrorCode::bad_data, *fault);
  if (const auto fault = spectra_.find_above_full_scale(b_scan, format_))
    return hal::fail(ErrorCode::bad_data, *fault + "; another --dtype or --shift");
  return {};
}

template <class Level> hal::Result<> VolumeReconstruction::reconstruct_all() {
  auto workspace = reconstructor_.make_workspace();
  std::vector<Level> levels(reconstructor_.levels());
  std::vector<float> running;
  for (int b = take_next(running); b < spectra_.shape().b_scans; b = take_next(running)) {
    HAL_CHECK(check_counts(b));
    pipeline::BScanOutcome outcome;
    if constexpr (std::is_same_v<Level, float>)
      outcome =
          reconstructor_.reconstruct_b_scan_db(workspace, spectra_.b_scan(b), levels, running);
    else
      outcome = reconstructor_.reconstruct_b_scan(workspace, spectra_.b_scan(b), levels, running);
    saturated_lines_.fetch_add(outcome.saturated_lines);
    HAL_CHECK(writer_.write_b_scan(b, levels));
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
      firmware_host::show_progress(
          fmt::format("{} of {} B-scans", done_.load(), spectra_.shape().b_scans));
  }
  if (terminal)
    firmware_host::show_progress("");
}

unsigned worker_count(const ReconstructOptions& options) {
  const unsigned wanted =
      options.threads > 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
  return std::min(wanted, static_cast<unsigned>(options.shape.b_scans));
}

hal::Result<> check(const ReconstructOptions& options) {
  if (options.picture &&
      (options.picture_b_scan < 0 || options.picture_b_scan >= options.shape.b_scans))
    return hal::fail(ErrorCode::invalid_argument, "--bscan is {}, expected 0 to {}",
                     options.picture_b_scan, options.shape.b_scans - 1);
  if (options.picture && options.picture->lexically_normal() == options.volume.lexically_normal())
    return hal::fail(ErrorCode::invalid_argument, "--out and --png are both {}, expected two files",
                     options.volume.string());
  return {};
}

} // namespace

hal::Result<> reconstruct_volume(const ReconstructOptions& options) {
  HAL_CHECK(check(options));
  const int samples = options.shape.samples;
  HAL_TRY(const auto format,
          spectrum_format(samples, {options.type, options.significant_bits}, options.right_shift));
  HAL_TRY(auto spectra, pipeline::SpectraFile::open(options.spectra, options.shape, options.type));
  hal::Result<pipeline::Calibration> calibration = pipeline::Calibration::identity(samples);
  if (options.calibration)
    calibration = pipeline::Calibration::load(*options.calibration, samples);
  if (!calibration)
    return tl::make_unexpected(calibration.error());
  if (const auto words = pipeline::replace_background_of_few_lines(
          *calibration, options.shape.a_scans, options.shape.b_scans))
    warn("warning: {}\n", *words);
  if (options.calibration)
    if (const auto doubt = pipeline::doubt_about_k_table(*calibration, *options.calibration))
      warn("warning: {}\n", *doubt);
  ReconstructionCache cache;
  HAL_TRY(const auto reconstructor,
          pipeline::Reconstructor::create({.calibration = *calibration,
                                           .format = format,
                                           .a_scans = options.shape.a_scans,
                                           .memory = &cache}));
  static_cast<void>(cache.save()); // what was not kept is measured again; the doctor says why

  const pipeline::VolumeGeometry geometry{
      reconstructor.depths(),        options.shape.a_scans,        options.shape.b_scans,
      calibration->bin_spacing_um(), calibration->a_spacing_um,    calibration->b_spacing_um,
      calibration->refractive_index, calibration->assumed_spacings};
  HAL_TRY(auto writer,
          pipeline::NrrdWriter::create(options.volume, geometry,
                                       options.display_counts ? pipeline::NrrdType::uint8
                                                              : pipeline::NrrdType::float32));
  VolumeReconstruction work{options, format, spectra, reconstructor, writer};
  HAL_CHECK(work.run(worker_count(options)));
  HAL_CHECK(writer.commit());
  if (geometry.assumed.any())
    warn("octascope reconstruct: warning: spacings are assumed: {} ({:.4g}, {:.4g}, {:.4g} "
         "µm); [depth] of a calibration gives them\n",
         geometry.assumed.words(), geometry.depth_spacing_um, geometry.a_spacing_um,
         geometry.b_spacing_um);
  if (work.saturated_lines() > 0)
    warn("warning: {} of {} lines are saturated\n", work.saturated_lines(), options.shape.lines());
  if (!options.picture)
    return {};
  return pipeline::write_png(*options.picture,
                             draw_b_scan(work.picture_levels(), geometry.depths, geometry.a_scans));
}

} // namespace octascope::firmware_host

#include "firmware-host/devices/twins.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "pipeline/reconstruction/spectra_file.h"
#include "pipeline/recordings/raw/raw_reader.h"
#include "sim/devices/control_script.h"
#include "sim/faults/fault_script.h"
#include "sim/phantoms/phantom.h"
#include "sim/spectra/recorded_spectra.h"
#include "sim/spectra/volume_loop.h"

namespace octascope::firmware_host {

namespace {

constexpr std::uint64_t phantom_seed = 1;

tl::unexpected<hal::Error> pass_on(const hal::Error& error) {
  return tl::make_unexpected(error);
}

// --calibration comes before the configuration's.
std::optional<std::filesystem::path> calibration_file(const RunOptions& options,
                                                      const Configuration& configuration) {
  return options.calibration ? options.calibration : configuration.calibration;
}

// What the recording says (counts) and what its calibration says (spacings). A recording has no
// fly-back; of a bidirectional scan it has the turn-around lines, and of repeats every sweep.
hal::Result<pipeline::ScanPlan> recorded_plan(const pipeline::SpectraShape& shape,
                                              const pipeline::Calibration& calibration,
                                              const RunOptions& options,
                                              const Configuration& configuration) {
  pipeline::ScanPlan plan = plan_of(options, configuration);
  plan.samples = shape.samples;
  plan.fly_back_lines = 0;
  plan.a_scans = shape.a_scans - (plan.bidirectional ? plan.turn_around_lines : 0);
  plan.b_scans = shape.b_scans / plan.repeats;
  plan.depth_spacing_um = calibration.depth_spacing_um;
  plan.refractive_index = calibration.refractive_index;
  plan.a_spacing_um = calibration.a_spacing_um;
  plan.b_spacing_um = calibration.b_spacing_um;
  plan.assumed_spacings = calibration.assumed_spacings;
  if (configuration.objective)
    configuration.objective->scale(plan);
  if (plan.sweeps() != shape.b_scans)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--shape has {} sweeps, expected a multiple of the {} repeats of each B-scan",
                     shape.b_scans, plan.repeats);
  if (plan.a_scans < 1)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--shape has {} lines a sweep, expected more than the {} turn-around lines of "
                     "a bidirectional scan",
                     shape.a_scans, plan.turn_around_lines);
  return plan.validate().map([&] { return plan; });
}

// Where not every bit counts, other counts are of another type. Read once from the beginning to the
// end, so only then.
hal::Result<> check_counts(const pipeline::SpectraFile& file,
                           const pipeline::SpectrumFormat& format) {
  const pipeline::SpectrumFormat all_bits{format.samples, format.type};
  if (format.significant_bits + format.right_shift == all_bits.significant_bits)
    return {};
  for (int b = 0; b < file.shape().b_scans; ++b)
    if (const auto fault = file.find_above_full_scale(b, format))
      return hal::fail(hal::ErrorCode::bad_data, "{}; another --dtype or --shift", *fault);
  return {};
}

// Beyond that, what is played waits for the disk.
constexpr std::size_t most_played_bytes = std::size_t{1} << 30;

constexpr std::size_t most_mapped_frames = std::size_t{1} << 20; // as one SpectraFile takes

struct FrameRange { // of RawReader::frames()
  std::size_t first = 0;
  std::size_t count = 0;
};

// Of the first whole volumes; those that follow each other are one, as each is a mapping of its own.
std::vector<FrameRange> whole_volumes(const pipeline::RawReader& reader, std::size_t most) {
  std::vector<FrameRange> ranges;
  std::size_t volumes = 0;
  for (const pipeline::RawVolume& volume : reader.volumes()) {
    if (!volume.whole || volumes == most)
      continue;
    ++volumes;
    if (!ranges.empty() && ranges.back().first + ranges.back().count == volume.first &&
        ranges.back().count + volume.count <= most_mapped_frames)
      ranges.back().count += volume.count;
    else
      ranges.push_back({volume.first, volume.count});
  }
  return ranges;
}

// The first whole volumes of a recording, as they were scanned, with its own calibration unless
// another one is given.
hal::Result<> play_raw_recording(const RunOptions& options, const Configuration& configuration,
                                 Twins& twins) {
  const std::filesystem::path& path = options.recording->file;
  if (options.bidirectional || options.repeats)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "{} says how it was scanned, expected neither --bidirectional nor --repeats",
                     path.string());
  HAL_TRY(const auto reader, pipeline::RawReader::open(path));
  const pipeline::RawFacts& facts = reader.facts();
  HAL_TRY(const auto first, reader.first_whole_volume());
  const auto sweeps = static_cast<std::size_t>(facts.plan.sweeps());
  const std::size_t most = most_played_bytes / (facts.format.frame_bytes() * sweeps);
  const auto played = std::make_shared<std::vector<pipeline::SpectraFile>>();
  std::vector<std::span<const std::byte>> frames;
  for (const FrameRange& range : whole_volumes(reader, std::max<std::size_t>(most, 1))) {
    HAL_TRY(auto file, reader.spectra(range.first, range.count, pipeline::RawLines::all));
    for (int sweep = 0; sweep < file.shape().b_scans; ++sweep) {
      if (const auto fault = file.find_fault(sweep))
        return hal::fail(hal::ErrorCode::bad_data, *fault);
      frames.push_back(file.b_scan(sweep));
    }
    played->push_back(std::move(file));
  }
  twins.calibration = facts.calibration;
  if (const auto given = calibration_file(options, configuration)) {
    HAL_TRY(twins.calibration, pipeline::Calibration::load(*given, facts.format.samples_per_line));
  }
  twins.plan = facts.plan;
  twins.plan.scan_lag_a_scans = reader.frames()[first.first].scan_lag_a_scans;
  HAL_TRY(twins.spectra,
          sim::RecordedSpectra::make({.samples = {},
                                      .sweeps = std::move(frames),
                                      .type = facts.format.sample_type,
                                      .b_scans = facts.plan.sweeps(),
                                      .a_scans = facts.format.lines_per_frame,
                                      .samples_per_line = facts.format.samples_per_line,
                                      .significant_bits = facts.format.significant_bits,
                                      .right_shift = facts.format.right_shift,
                                      .name = path.filename().string(),
                                      .keep_alive = played}));
  return {};
}

hal::Result<> play_recording(const RunOptions& options, const Configuration& configuration,
                             Twins& twins) {
  if (pipeline::is_raw_recording(options.recording->file))
    return play_raw_recording(options, configuration, twins);
  const RecordingOptions& recording = *options.recording;
  auto file = pipeline::SpectraFile::open(recording.file, recording.shape, recording.format.type);
  if (!file)
    return pass_on(file.error());
  HAL_CHECK(check_counts(*file, recording.format));
  const auto shared = std::make_shared<pipeline::SpectraFile>(std::move(*file));

  twins.calibration = pipeline::Calibration::identity(recording.shape.samples);
  if (const auto path = calibration_file(options, configuration)) {
    auto loaded = pipeline::Calibration::load(*path, recording.shape.samples);
    if (!loaded)
      return pass_on(loaded.error());
    twins.calibration = std::move(*loaded);
  }
  auto plan = recorded_plan(recording.shape, twins.calibration, options, configuration);
  if (!plan)
    return pass_on(plan.error());
  twins.plan = *plan;

  auto spectra = sim::RecordedSpectra::make(
      {.samples = {shared->b_scan(0).data(),
                   recording.shape.lines() * recording.format.line_bytes()},
       .type = recording.format.type,
       .b_scans = recording.shape.b_scans,
       .a_scans = recording.shape.a_scans,
       .samples_per_line = recording.shape.samples,
       .significant_bits = recording.format.significant_bits,
       .right_shift = recording.format.right_shift,
       .name = recording.file.filename().string(),
       .keep_alive = shared});
  if (!spectra)
    return pass_on(spectra.error());
  twins.spectra = std::move(*spectra);
  return {};
}

hal::Result<> play_phantom(const RunOptions& options, const Configuration& configuration,
                           Twins& twins) {
  auto loop = sim::suggested_loop(options.phantom.value_or(configuration.phantom));
  if (!loop)
    return pass_on(loop.error());
  loop->volumes = configuration.loop_volumes;
  loop->galvo_lag_us = configuration.galvo_lag_us;
  loop->motion = configuration.tissue_motion;
  loop->seed = phantom_seed;
  if (configuration.plan)
    loop->plan = *configuration.plan;
  override_plan(options, configuration, loop->plan);
  const auto calibration = calibration_file(options, configuration);
  if (calibration) { // before the loop, which takes its time
    auto loaded = pipeline::Calibration::load(*calibration, loop->plan.samples);
    if (!loaded)
      return pass_on(loaded.error());
    twins.calibration = std::move(*loaded);
  }
  auto made = sim::VolumeLoop::make(*loop);
  if (!made)
    return pass_on(made.error());

  const sim::Spectrometer& spectrometer = (*made)->spectrometer();
  twins.plan = (*made)->plan();
  twins.plan.assumed_spacings = {}; // the phantom is made for them
  if (calibration)
    twins.plan.refractive_index = medium_of(twins.plan, twins.calibration);
  if (!calibration) { // the one that fits the simulated spectrometer exactly
    twins.calibration = pipeline::Calibration::identity(twins.plan.samples);
    twins.calibration.positions = spectrometer.true_k_positions();
    twins.calibration.dispersion_rad = spectrometer.true_dispersion_rad();
    twins.calibration.camera = sim::simulated_camera;
  }
  twins.spectra = std::move(*made);
  return {};
}

// The corners of the scan within the picture; A-scan 0 of B-scan 0 is at the upper left.
ui::ScanField corners(const sim::PictureRectangle& r) {
  const auto corner = [](double x, double y) {
    return ui::ScanField::Corner{static_cast<float>(x), static_cast<float>(y)};
  };
  return {{corner(r.x, r.y), corner(r.x + r.width, r.y), corner(r.x + r.width, r.y + r.height),
           corner(r.x, r.y + r.height)}};
}

hal::Result<> make_scope_camera(const RunOptions& options, const Configuration& configuration,
                                hal::Clock& clock, Twins& twins) {
  auto made =
      sim::SimScopeCamera::make({.phantom = options.phantom.value_or(configuration.phantom),
                                 .seed = phantom_seed,
                                 .field = twins.plan.geometry(),
                                 .loop = twins.plan.tick_period() * configuration.loop_volumes},
                                clock);
  if (!made)
    return pass_on(made.error());
  twins.scope_camera = std::move(*made);
  twins.scan_field = corners(twins.scope_camera->scan_field());
  return {};
}

hal::Result<> load_faults(const RunOptions& options, const Configuration& configuration,
                          Twins& twins) {
  sim::FaultScript script;
  if (const auto& file = options.faults ? options.faults : configuration.faults) {
    auto loaded = sim::FaultScript::load(*file);
    if (!loaded)
      return pass_on(loaded.error());
    script = std::move(*loaded);
  }
  twins.faults = std::make_unique<sim::FaultSchedule>(std::move(script));
  return {};
}

hal::Result<> make_control_input(const RunOptions& options, const Configuration& configuration,
                                 hal::Clock& clock, Twins& twins) {
  sim::ControlScript script;
  if (const auto& file = options.controls ? options.controls : configuration.controls) {
    auto loaded = sim::ControlScript::load(*file);
    if (!loaded)
      return pass_on(loaded.error());
    script = std::move(*loaded);
  }
  twins.control_input =
      std::make_unique<sim::SimControlInput>(clock, std::move(script), twins.faults.get());
  return {};
}

} // namespace

std::optional<double> medium_of(const pipeline::ScanPlan& plan,
                                const pipeline::Calibration& calibration) {
  // Written with fewer digits it is the same spacing; that of the next likelier medium (1.33 and 1.336)
  // is 0.4 % off.
  constexpr double largest_share = 1e-3;
  const double between = std::abs(plan.depth_spacing_um - calibration.depth_spacing_um);
  return between <= largest_share * calibration.depth_spacing_um ? calibration.refractive_index
                                                                 : std::nullopt;
}

bool Twins::concern_display() const {
  return std::ranges::any_of(faults->faults(), [](const sim::ScriptedFault& fault) {
    return fault.kind == sim::gone(pipeline::Device::display);
  });
}

void Twins::apply_faults(hal::TimePoint now, sim::OffscreenDisplay* display) {
  if (scope_camera && faults->active(sim::gone(pipeline::Device::scope_camera), now))
    scope_camera->unplug();
  else if (scope_camera)
    scope_camera->replug();
  if (display == nullptr)
    return;
  if (faults->active(sim::gone(pipeline::Device::display), now))
    display->lose();
  else
    display->restore();
}

hal::Result<Twins> make_script_twins(const RunOptions& options, const Configuration& configuration,
                                     hal::Clock& clock) {
  Twins twins;
  auto made = load_faults(options, configuration, twins);
  if (made)
    made = make_control_input(options, configuration, clock, twins);
  if (!made)
    return pass_on(made.error());
  return twins;
}

hal::Result<Twins> make_twins(const RunOptions& options, const Configuration& configuration,
                              hal::Clock& clock) {
  auto scripted = make_script_twins(options, configuration, clock);
  if (!scripted)
    return scripted;
  Twins& twins = *scripted;
  auto made = options.recording ? play_recording(options, configuration, twins)
                                : play_phantom(options, configuration, twins);
  twins.plan.zero_padding = twins.calibration.zero_padding;
  if (made && !options.recording)
    made = make_scope_camera(options, configuration, clock, twins);
  if (!made)
    return pass_on(made.error());
  twins.format = twins.spectra->format();
  twins.source = twins.spectra->description();
  twins.link = std::make_unique<sim::GalvoLink>(twins.plan.sweep_duration());
  // Nobody knows which camera a recording's spectra are from.
  twins.line_camera = std::make_unique<sim::SimLineCamera>(
      *twins.spectra, *twins.link, clock, twins.faults.get(), sim::ScanMotion{},
      options.recording ? std::string{} : std::string{sim::simulated_camera});
  twins.galvo_trigger =
      std::make_unique<sim::SimGalvoTrigger>(*twins.link, clock, twins.faults.get());
  return scripted;
}

} // namespace octascope::firmware_host

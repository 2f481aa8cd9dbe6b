#include "firmware-host/run/volume_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/devices/twins.h"
#include "hal/linux/monotonic_clock.h"
#include "pipeline/acquisition/b_scan_builder.h"
#include "pipeline/acquisition/volume_assembler.h"
#include "pipeline/files/input_file.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/recordings/recording_reader.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::firmware_host {

namespace {

enum class VolumeFile : std::uint8_t { nrrd, recording };

// By how it begins, whatever it is called. A file that is not there, or is no file, is told as that,
// before anything else that was asked about it.
hal::Result<VolumeFile> kind_of(const std::filesystem::path& file) {
  constexpr std::string_view expected = "a NRRD volume or a recording (HDF5)";
  constexpr std::string_view recording{"\x89HDF\r\n\x1a\n", 8};
  const auto input = pipeline::InputFile::open(file, expected, UINT64_MAX);
  if (!input && input.error().code == hal::ErrorCode::absent)
    return hal::fail(hal::ErrorCode::absent, "{}: there is no such file, expected {}",
                     file.string(), expected);
  if (!input)
    return tl::make_unexpected(input.error());
  std::array<char, recording.size()> buffer{};
  HAL_TRY(const auto filled, input->read(buffer));
  std::string_view beginning{buffer.data(), filled};
  if (beginning == recording)
    return VolumeFile::recording;
  if (beginning.starts_with("\xEF\xBB\xBF")) // an editor's mark of UTF-8
    beginning.remove_prefix(3);
  if (beginning.starts_with("NRRD"))
    return VolumeFile::nrrd;
  return hal::fail(hal::ErrorCode::bad_data, "{}: begins like neither, expected {}", file.string(),
                   expected);
}

// Not of a NRRD, whose reader says it.
void remark_assumed(const std::filesystem::path& file, LoadedVolume& loaded) {
  if (const pipeline::AssumedSpacings& assumed = loaded.volume.geometry.assumed; assumed.any())
    loaded.remarks.push_back(
        fmt::format("{}: its spacings are assumed, not measured: {}; [depth] of a "
                    "calibration gives them",
                    file.string(), assumed.words()));
}

hal::Result<LoadedVolume> read_recorded(const std::filesystem::path& file, std::size_t at) {
  HAL_TRY(auto reader, pipeline::RecordingReader::open(file));
  if (reader.volumes().empty())
    return hal::fail(hal::ErrorCode::bad_data,
                     "{}: found a recording of no volumes, expected one at least", file.string());
  if (at >= reader.volumes().size())
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--at is {}, expected 0 to {}: {} has {} volumes", at,
                     reader.volumes().size() - 1, file.string(), reader.volumes().size());
  const pipeline::RecordingFacts& facts = reader.facts();
  LoadedVolume loaded{pipeline::Volume{facts.geometry}, {facts.subject, facts.eye}};
  HAL_CHECK(reader.read(at, loaded.volume));
  remark_assumed(file, loaded);
  return loaded;
}

// As the display's counts. What these cannot hold goes to the nearest, and NaN to the lowest; of
// minus infinity, the level of no signal at all, nothing is said.
void quantise(std::span<const float> levels, pipeline::Volume& volume,
              std::vector<std::string>& remarks) {
  std::size_t nans = 0;
  std::size_t outside = 0;
  std::ranges::transform(levels, volume.levels.begin(), [&](float level) -> std::uint8_t {
    if (std::isnan(level)) {
      ++nans;
      return 0;
    }
    const bool beyond = level < pipeline::lowest_level_db || level > pipeline::highest_level_db;
    if (beyond && level != -std::numeric_limits<float>::infinity())
      ++outside;
    return pipeline::quantise_level(level);
  });
  if (nans > 0)
    remarks.push_back(fmt::format("{} of its {} values are NaN, and drawn as the lowest level",
                                  nans, levels.size()));
  if (outside > levels.size() / 2)
    remarks.push_back(fmt::format("{} of its {} values are not within {} to {} dB, beyond which no "
                                  "level is told apart: are they decibels?",
                                  outside, levels.size(), pipeline::lowest_level_db,
                                  pipeline::highest_level_db));
}

hal::Result<LoadedVolume> read_volume(const std::filesystem::path& file) {
  HAL_TRY(auto nrrd, pipeline::read_nrrd(file));
  LoadedVolume loaded{pipeline::Volume{nrrd.geometry}, {}, std::move(nrrd.remarks)};
  if (const auto* counts = std::get_if<std::vector<std::uint8_t>>(&nrrd.levels))
    std::ranges::copy(*counts, loaded.volume.levels.begin());
  else
    quantise(std::get<std::vector<float>>(nrrd.levels), loaded.volume, loaded.remarks);
  for (std::string& remark : loaded.remarks)
    remark.insert(0, file.string() + ": ");
  std::ranges::fill(loaded.volume.b_scan_states, pipeline::BScanState::good);
  return loaded;
}

// The sweeps of one volume, one after the other, the way the workers take them.
pipeline::Volume build_volume(const Twins& twins, const pipeline::Reconstructor& reconstructor,
                              const pipeline::NeighbourAverage& average) {
  const pipeline::ScanPlan& plan = twins.plan;
  pipeline::Volume volume{plan.geometry()};
  volume.occupancy = pipeline::Occupancy{plan.geometry(), pipeline::blank_depth_bins};
  auto workspace = reconstructor.make_workspace();
  // As if the volume had been before: its background is that of the whole volume.
  std::span<const float> background;
  auto running = reconstructor.make_running_background(plan.sweeps());
  for (int sweep = 0; running && sweep < plan.sweeps(); ++sweep)
    background = running->add(twins.spectra->frame(0, sweep));
  pipeline::BScanBuilder builder{
      plan, 1, [&](std::size_t, const hal::LineFrame& frame, std::span<std::uint8_t> levels) {
        return reconstructor.reconstruct_b_scan(workspace, frame.bytes, levels, background)
            .saturated_lines;
      }};
  pipeline::VolumeAssembler assembler{plan.geometry(), average};
  assembler.begin(volume);
  const pipeline::SweepAlignment alignment{plan, plan.scan_lag_a_scans};
  for (int b = 0; b < plan.b_scans; ++b) {
    std::array<hal::LineFrame, pipeline::ScanPlan::most_repeats> frames{};
    for (int repeat = 0; repeat < plan.repeats; ++repeat) {
      hal::LineFrame& frame = frames[static_cast<std::size_t>(repeat)];
      frame.bytes = twins.spectra->frame(0, b * plan.repeats + repeat);
      frame.buffer = repeat;
    }
    const int saturated =
        builder.build(0, b, std::span{frames}.first(static_cast<std::size_t>(plan.repeats)),
                      alignment, nullptr, assembler.own_levels(b));
    volume.b_scan_states[static_cast<std::size_t>(b)] =
        saturated > 0 ? pipeline::BScanState::saturated : pipeline::BScanState::good;
    assembler.built(b);
  }
  assembler.finish();
  return volume;
}

hal::Result<LoadedVolume> reconstruct(const VolumeRequest& request) {
  RunOptions options;
  options.recording = request.recording;
  options.calibration = request.calibration;
  options.phantom = request.phantom;
  Configuration configuration;
  configuration.loop_volumes = 1;
  hal::linux_backend::MonotonicClock clock;
  HAL_TRY(const auto twins, make_twins(options, configuration, clock));
  HAL_TRY(const auto reconstructor,
          pipeline::Reconstructor::create(
              {.calibration = twins.calibration,
               .format = pipeline::SpectrumFormat{twins.format},
               .a_scans = twins.plan.converted_lines(),
               // Not whichever is faster just now: the same levels each time.
               .path = pipeline::ReconstructionPath::fftw,
               .limit_saturated_lines = true}));
  HAL_TRY(const auto average, pipeline::NeighbourAverage::create(configuration.neighbour_weights));
  LoadedVolume loaded{build_volume(twins, reconstructor, average), {}};
  if (request.recording) // a phantom is made for its spacings
    remark_assumed(request.recording->file, loaded);
  if (request.calibration) {
    if (auto doubt = pipeline::doubt_about_k_table(twins.calibration, *request.calibration))
      loaded.remarks.push_back(std::move(*doubt));
  }
  return loaded;
}

} // namespace

hal::Result<LoadedVolume> load_volume(const VolumeRequest& request) {
  const int sources =
      (request.file ? 1 : 0) + (request.recording ? 1 : 0) + (request.phantom ? 1 : 0);
  if (sources != 1)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "found {} volumes to draw, expected one: --volume FILE, --spectra FILE with "
                     "--shape, or --phantom NAME",
                     sources);
  if (!request.file)
    return reconstruct(request);
  HAL_TRY(const auto kind, kind_of(*request.file));
  if (kind == VolumeFile::recording)
    return read_recorded(*request.file, request.at.value_or(0));
  if (request.at)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--at is {}, expected none: {} is no recording but one volume", *request.at,
                     request.file->string());
  return read_volume(*request.file);
}

} // namespace octascope::firmware_host

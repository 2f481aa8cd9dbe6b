#include "firmware-host/run/volume_source.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/devices/twins.h"
#include "hal/linux/monotonic_clock.h"
#include "pipeline/acquisition/b_scan_builder.h"
#include "pipeline/acquisition/volume_assembler.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/recordings/recording_reader.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::firmware_host {

namespace {

// HDF5 begins with these bytes, whatever the file is called.
bool is_recording(const std::filesystem::path& file) {
  constexpr std::string_view signature{"\x89HDF\r\n\x1a\n", 8};
  std::array<char, signature.size()> begin{};
  std::ifstream in{file, std::ios::binary};
  in.read(begin.data(), begin.size());
  return in && std::string_view{begin.data(), begin.size()} == signature;
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
  return loaded;
}

hal::Result<LoadedVolume> read_volume(const std::filesystem::path& file) {
  HAL_TRY(const auto nrrd, pipeline::read_nrrd(file));
  pipeline::Volume volume{nrrd.geometry};
  std::visit(
      [&](const auto& levels) {
        std::ranges::transform(levels, volume.levels.begin(), [](auto level) {
          if constexpr (std::is_same_v<decltype(level), float>)
            return pipeline::quantise_level(level);
          else
            return level;
        });
      },
      nrrd.levels);
  std::ranges::fill(volume.b_scan_states, pipeline::BScanState::good);
  return LoadedVolume{std::move(volume), {}};
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
  return LoadedVolume{build_volume(twins, reconstructor, average), {}};
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
  if (is_recording(*request.file))
    return read_recorded(*request.file, request.at.value_or(0));
  if (request.at)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--at is {}, expected none: {} is no recording but one volume", *request.at,
                     request.file->string());
  return read_volume(*request.file);
}

} // namespace octascope::firmware_host

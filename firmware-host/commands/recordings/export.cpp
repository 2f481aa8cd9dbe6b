#include "firmware-host/commands/recordings/export.h"

#include <algorithm>

#include <fmt/format.h>

#include "firmware-host/commands/recordings/export_place.h"
#include "firmware-host/commands/recordings/volume_exporter.h"
#include "pipeline/files/file_name.h"
#include "pipeline/recordings/recording_reader.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::firmware_host {

namespace {

using hal::ErrorCode;
using pipeline::RecordingReader;

struct Chosen {
  std::size_t first = 0;
  std::size_t count = 0;
};

hal::Result<Chosen> choose_volumes(const ExportOptions& options, std::size_t volumes) {
  if (volumes == 0)
    return hal::fail(ErrorCode::absent, "{}: found no volumes in it, there is nothing to export",
                     options.recording.string());
  const std::size_t last = options.volumes.last.value_or(volumes - 1);
  if (options.volumes.first < volumes && last < volumes)
    return Chosen{options.volumes.first, last - options.volumes.first + 1};
  return hal::fail(ErrorCode::invalid_argument, "--volumes asks for volume {}, {} has 0 to {}",
                   std::max(options.volumes.first, last), options.recording.string(), volumes - 1);
}

hal::Result<> check_b_scan(const ExportOptions& options, int b_scans) {
  if (!options.b_scan || (*options.b_scan >= 0 && *options.b_scan < b_scans))
    return {};
  return hal::fail(ErrorCode::invalid_argument, "--bscan is {}, expected 0 to {}", *options.b_scan,
                   b_scans - 1);
}

hal::Result<ExportPlace> choose_place(const ExportOptions& options, std::size_t volumes) {
  switch (options.format) {
  case ExportFormat::nrrd: return ExportPlace::choose(options.out, ".nrrd", "", volumes);
  case ExportFormat::dicom: return ExportPlace::choose(options.out, ".dcm", "", volumes);
  case ExportFormat::png: break;
  }
  return ExportPlace::choose(options.out, ".png",
                             options.b_scan ? fmt::format("-b-scan-{:04}", *options.b_scan)
                                            : std::string{"-en-face"},
                             volumes);
}

hal::Result<> check_apart(const ExportOptions& options, const ExportPlace& place,
                          const Chosen& chosen) {
  for (std::size_t n = chosen.first; n < chosen.first + chosen.count; ++n) {
    if (pipeline::is_same_file(place.file_of(n), options.recording))
      return hal::fail(ErrorCode::invalid_argument,
                       "{} is the recording itself; expected another --out: nothing was written",
                       place.file_of(n).string());
  }
  return {};
}

// One for all pictures, so that they can be compared.
hal::Result<ui::DisplayWindow> window_for(RecordingReader& reader, std::size_t n,
                                          pipeline::Volume& volume) {
  HAL_CHECK(reader.read(n, volume));
  return ui::suggest_window(volume).value_or(ui::DisplayWindow{
      pipeline::lowest_level_db, pipeline::highest_level_db - pipeline::lowest_level_db});
}

std::string pixels_in_words(const ExportOptions& options, const pipeline::VolumeGeometry& g) {
  if (options.format != ExportFormat::png)
    return {};
  const double down = options.b_scan ? g.depth_spacing_um : g.b_spacing_um;
  if (options.to_scale)
    return fmt::format("to scale: square pixels of {:.4g} µm", std::min(g.a_spacing_um, down));
  return fmt::format("as stored: pixels of {:.4g} µm across and {:.4g} µm down", g.a_spacing_um,
                     down);
}

// All of the chosen volumes, one after the other in the one `volume`.
hal::Result<> write_volumes(RecordingReader& reader, const Chosen& chosen, const ExportPlace& place,
                            VolumeExporter& exporter, pipeline::Volume& volume,
                            const std::function<void(double)>& progress, ExportOutcome& outcome) {
  for (std::size_t i = 0; i < chosen.count; ++i) {
    const std::size_t n = chosen.first + i;
    const auto written = reader.read(n, volume).and_then([&] {
      return exporter.write(place.file_of(n), {volume, reader.volumes()[n], n});
    });
    if (!written)
      return hal::fail(written.error().code,
                       i == 0 ? written.error().message
                              : fmt::format("{}; {} of {} volumes were exported before",
                                            written.error().message, i, chosen.count));
    outcome.missing_b_scans += static_cast<std::size_t>(volume.missing_b_scans());
    progress(static_cast<double>(i + 1) / static_cast<double>(chosen.count));
  }
  return {};
}

} // namespace

hal::Result<ExportOutcome> export_recording(const ExportOptions& asked,
                                            const std::function<void(double)>& progress) {
  ExportOptions options = asked;
  HAL_TRY(auto reader, RecordingReader::open(options.recording));
  const pipeline::RecordingFacts& facts = reader.facts();
  HAL_TRY(const auto chosen, choose_volumes(options, reader.volumes().size()));
  HAL_CHECK(check_b_scan(options, facts.geometry.b_scans));
  HAL_TRY(auto place, choose_place(options, chosen.count));
  HAL_CHECK(check_apart(options, place, chosen));
  pipeline::Volume volume{facts.geometry};
  // Pictures from above have a contrast of their own.
  if (!options.window && (options.format == ExportFormat::dicom || options.b_scan)) {
    HAL_TRY(const auto window, window_for(reader, chosen.first, volume));
    options.window = window;
  }
  HAL_TRY(const auto exporter, make_volume_exporter(options, facts, reader.volumes().front()));

  ExportOutcome outcome{.volumes = chosen.count,
                        .first = place.file_of(chosen.first),
                        .last = place.file_of(chosen.first + chosen.count - 1),
                        .window = options.window,
                        .simulated = facts.simulated,
                        .assumed_spacings = facts.geometry.assumed.words(),
                        .pixels = pixels_in_words(options, facts.geometry)};
  const auto done =
      place.prepare(exporter->file_bytes() * chosen.count, chosen.first).and_then([&] {
        return write_volumes(reader, chosen, place, *exporter, volume, progress, outcome);
      });
  if (!done) {
    place.remove_empty_folder();
    return tl::make_unexpected(done.error());
  }
  return outcome;
}

} // namespace octascope::firmware_host

#include "pipeline/recordings/recording_attributes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>

#include <fmt/format.h>

#include "pipeline/recordings/hdf5/attributes.h"
#include "pipeline/recordings/recording_layout.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::pipeline {

namespace {

hal::Result<> expect(hid_t file, const char* name, double expected) {
  HAL_TRY(const auto value, read_real(file, name));
  if (value != expected)
    return bad_attribute(name, fmt::format("found {}, expected {}", value, expected));
  return {};
}

hal::Result<> check_format(hid_t file) {
  const auto format = read_text(file, "format");
  if (!format)
    return hal::fail(hal::ErrorCode::bad_data, "is no recording of octascope: {}",
                     format.error().message);
  if (*format != recording_layout::format_name)
    return hal::fail(hal::ErrorCode::bad_data,
                     "is no recording of octascope: found the format \"{}\", expected \"{}\"",
                     *format, recording_layout::format_name);
  HAL_TRY(const auto version, read_whole(file, "format_version"));
  if (version != recording_layout::format_version)
    return bad_attribute("format_version", fmt::format("found {}, this program reads {}", version,
                                                       recording_layout::format_version));
  for (const auto& [name, value] :
       {std::pair{"lowest_level_db", lowest_level_db}, std::pair{"level_step_db", level_step_db}})
    HAL_CHECK(expect(file, name, static_cast<double>(value)));
  return {};
}

// In the place of a refractive index.
constexpr double medium_not_said = 0;

// Older recordings do not have it.
hal::Result<std::optional<double>> read_medium(hid_t file) {
  constexpr const char* name = "refractive_index";
  if (H5Aexists(file, name) <= 0)
    return std::nullopt;
  HAL_TRY(const auto said, read_real(file, name));
  if (said == medium_not_said)
    return std::nullopt;
  if (said >= least_refractive_index && said <= most_refractive_index)
    return said;
  return bad_attribute(name,
                       fmt::format("found {}, expected {} to {}, or {}", said,
                                   least_refractive_index, most_refractive_index, medium_not_said));
}

} // namespace

bool write_facts(hid_t file, const RecordingFacts& facts) {
  const VolumeGeometry& g = facts.geometry;
  return write_text(file, "format", recording_layout::format_name) &&
         write_whole(file, "format_version", recording_layout::format_version) &&
         write_real(file, "lowest_level_db", static_cast<double>(lowest_level_db)) &&
         write_real(file, "level_step_db", static_cast<double>(level_step_db)) &&
         write_whole(file, "depths", g.depths) && write_whole(file, "a_scans", g.a_scans) &&
         write_whole(file, "b_scans", g.b_scans) &&
         write_real(file, "depth_spacing_um", g.depth_spacing_um) &&
         write_real(file, "a_spacing_um", g.a_spacing_um) &&
         write_real(file, "b_spacing_um", g.b_spacing_um) &&
         write_text(file, "assumed_spacings", g.assumed.words()) &&
         write_real(file, "refractive_index", g.refractive_index.value_or(medium_not_said)) &&
         write_real(file, "volume_period_s", facts.volume_period_s) &&
         write_text(file, "recorded_by", facts.recorded_by) &&
         write_text(file, "begun", facts.begun) && write_text(file, "source", facts.source) &&
         write_whole(file, "simulated", facts.simulated ? 1 : 0) &&
         write_text(file, "subject", facts.subject) &&
         write_text(file, "eye", std::string{to_string(facts.eye)}) &&
         write_text(file, "configuration", facts.configuration) && write_end(file, {});
}

bool write_end(hid_t file, const RecordingEnd& end) {
  return write_whole(file, "finished", end.finished ? 1 : 0) &&
         write_whole(file, "not_kept", static_cast<std::int64_t>(end.not_kept));
}

hal::Result<RecordingFacts> read_facts(hid_t file) {
  HAL_CHECK(check_format(file));
  RecordingFacts facts;
  AttributeReader reader{file};
  reader.read("depths", facts.geometry.depths);
  reader.read("a_scans", facts.geometry.a_scans);
  reader.read("b_scans", facts.geometry.b_scans);
  reader.read("depth_spacing_um", facts.geometry.depth_spacing_um);
  reader.read("a_spacing_um", facts.geometry.a_spacing_um);
  reader.read("b_spacing_um", facts.geometry.b_spacing_um);
  std::string assumed;
  reader.read_if_there("assumed_spacings", assumed);
  facts.geometry.assumed = AssumedSpacings::parse(assumed);
  reader.read("volume_period_s", facts.volume_period_s);
  reader.read("recorded_by", facts.recorded_by);
  reader.read("begun", facts.begun);
  reader.read("source", facts.source);
  reader.read("simulated", facts.simulated);
  reader.read("subject", facts.subject);
  std::string eye;
  reader.read("eye", eye);
  reader.read("configuration", facts.configuration);
  if (reader.error())
    return tl::make_unexpected(*reader.error());
  HAL_TRY(facts.geometry.refractive_index, read_medium(file));
  facts.eye = eye_named(eye).value_or(Eye::not_said);
  return facts;
}

hal::Result<RecordingEnd> read_end(hid_t file) {
  HAL_TRY(const auto finished, read_whole(file, "finished"));
  HAL_TRY(const auto not_kept, read_whole(file, "not_kept"));
  return RecordingEnd{.finished = finished != 0,
                      .not_kept = static_cast<std::uint64_t>(std::max<std::int64_t>(not_kept, 0))};
}

} // namespace octascope::pipeline

#include "pipeline/recordings/raw/raw_attributes.h"

#include <algorithm>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "pipeline/reconstruction/spectrum_format.h"
#include "pipeline/recordings/hdf5/attributes.h"
#include "pipeline/recordings/raw/raw_calibration.h"
#include "pipeline/recordings/raw/raw_layout.h"

namespace octascope::pipeline {

namespace {

const char* name_of(hal::SampleType type) {
  switch (type) {
  case hal::SampleType::u8: return "u8";
  case hal::SampleType::u16: return "u16";
  case hal::SampleType::f32: break;
  }
  return "f32";
}

hal::Result<hal::SampleType> type_named(const std::string& name) {
  for (const auto type : {hal::SampleType::u8, hal::SampleType::u16, hal::SampleType::f32})
    if (name == name_of(type))
      return type;
  return bad_attribute("sample_type",
                       fmt::format("found \"{}\", expected \"u8\", \"u16\" or \"f32\"", name));
}

hal::Result<> check_format(hid_t file) {
  const auto format = read_text(file, "format");
  const std::string found =
      format ? fmt::format("found the format \"{}\"", *format) : format.error().message;
  if (!format || *format != raw_layout::format_name)
    return hal::fail(hal::ErrorCode::bad_data,
                     "holds no raw spectra of octascope: {}, expected \"{}\"", found,
                     raw_layout::format_name);
  HAL_TRY(const auto version, read_whole(file, "format_version"));
  if (version != raw_layout::format_version)
    return bad_attribute("format_version", fmt::format("found {}, this program reads {}", version,
                                                       raw_layout::format_version));
  return {};
}

bool write_plan(hid_t file, const ScanPlan& plan) {
  return write_whole(file, "a_scans", plan.a_scans) &&
         write_whole(file, "fly_back_lines", plan.fly_back_lines) &&
         write_whole(file, "b_scans", plan.b_scans) && write_whole(file, "repeats", plan.repeats) &&
         write_whole(file, "bidirectional", plan.bidirectional ? 1 : 0) &&
         write_whole(file, "turn_around_lines", plan.turn_around_lines) &&
         write_real(file, "line_rate_hz", plan.line_rate_hz) &&
         write_real(file, "depth_spacing_um", plan.depth_spacing_um) &&
         write_real(file, "a_spacing_um", plan.a_spacing_um) &&
         write_real(file, "b_spacing_um", plan.b_spacing_um) &&
         write_text(file, "assumed_spacings", plan.assumed_spacings.words()) &&
         write_real(file, "refractive_index",
                    plan.refractive_index.value_or(raw_layout::medium_not_said));
}

hal::Result<> read_plan(hid_t file, AttributeReader& reader, ScanPlan& plan) {
  reader.read("a_scans", plan.a_scans);
  reader.read("fly_back_lines", plan.fly_back_lines, 0);
  reader.read("b_scans", plan.b_scans);
  reader.read("repeats", plan.repeats);
  reader.read("bidirectional", plan.bidirectional);
  reader.read("turn_around_lines", plan.turn_around_lines, 0);
  reader.read("line_rate_hz", plan.line_rate_hz);
  reader.read("depth_spacing_um", plan.depth_spacing_um);
  reader.read("a_spacing_um", plan.a_spacing_um);
  reader.read("b_spacing_um", plan.b_spacing_um);
  std::string assumed;
  reader.read("assumed_spacings", assumed);
  if (reader.error())
    return tl::make_unexpected(*reader.error());
  plan.assumed_spacings = AssumedSpacings::parse(assumed);
  HAL_TRY(const auto medium, read_real(file, "refractive_index"));
  if (medium >= least_refractive_index && medium <= most_refractive_index)
    plan.refractive_index = medium;
  return {};
}

// That format, plan and calibration fit together, as whoever reconstructs takes for granted.
hal::Result<> check_facts(const RawFacts& facts) {
  const auto damaged = [](const std::string& what) {
    return hal::fail(hal::ErrorCode::bad_data,
                     "{}: the file is damaged, or another program changed it", what);
  };
  const hal::LineFormat& format = facts.format;
  if (format.sample_type != hal::SampleType::f32)
    if (const auto valid = SpectrumFormat{format}.validate(); !valid)
      return damaged(valid.error().message);
  if ((format.sample_type == hal::SampleType::f32) != (facts.averaged_lines > 0))
    return damaged(fmt::format("found {} averaged lines of {}, expected f32 of these alone",
                               facts.averaged_lines, name_of(format.sample_type)));
  const int expected = facts.averaged_lines > 0 ? 1 : facts.plan.lines_per_frame();
  if (format.lines_per_frame != expected)
    return damaged(fmt::format("found {} lines a frame, expected {} of such a scan",
                               format.lines_per_frame, expected));
  if (const auto valid = facts.plan.validate(); !valid)
    return damaged(valid.error().message);
  return {};
}

} // namespace

bool write_raw_facts(hid_t file, const RawFacts& facts) {
  const hal::LineFormat& f = facts.format;
  return write_text(file, "format", raw_layout::format_name) &&
         write_whole(file, "format_version", raw_layout::format_version) &&
         write_text(file, "sample_type", name_of(f.sample_type)) &&
         write_whole(file, "samples", f.samples_per_line) &&
         write_whole(file, "lines_per_frame", f.lines_per_frame) &&
         write_whole(file, "kept_lines", facts.kept_lines()) &&
         write_whole(file, "significant_bits", f.significant_bits) &&
         write_whole(file, "right_shift", f.right_shift) &&
         write_whole(file, "averaged_lines", facts.averaged_lines) &&
         write_plan(file, facts.plan) && write_text(file, "recorded_by", facts.recorded_by) &&
         write_text(file, "begun", facts.begun) && write_text(file, "source", facts.source) &&
         write_whole(file, "simulated", facts.simulated ? 1 : 0) &&
         write_text(file, "subject", facts.subject) &&
         write_text(file, "eye", std::string{to_string(facts.eye)}) &&
         write_text(file, "configuration", facts.configuration) &&
         write_text(file, "path", facts.path) && write_text(file, "isa", facts.isa) &&
         write_raw_calibration(file, facts.calibration) && write_whole(file, "finished", 0) &&
         write_whole(file, "not_kept", 0);
}

bool write_raw_end(hid_t file, const RawEnd& end) {
  return write_text(file, "camera", end.camera) &&
         write_whole(file, "not_kept", static_cast<std::int64_t>(end.not_kept)) &&
         write_whole(file, "finished", end.finished ? 1 : 0);
}

hal::Result<RawFacts> read_raw_facts(hid_t file) {
  HAL_CHECK(check_format(file));
  RawFacts facts;
  AttributeReader reader{file};
  std::string type;
  std::string eye;
  reader.read("sample_type", type);
  reader.read("samples", facts.format.samples_per_line, fewest_samples, most_samples);
  reader.read("lines_per_frame", facts.format.lines_per_frame);
  reader.read("significant_bits", facts.format.significant_bits, 1, 16);
  reader.read("right_shift", facts.format.right_shift, 0, 15);
  reader.read("averaged_lines", facts.averaged_lines, 0, std::numeric_limits<int>::max());
  reader.read("recorded_by", facts.recorded_by);
  reader.read("begun", facts.begun);
  reader.read("source", facts.source);
  reader.read("simulated", facts.simulated);
  reader.read("subject", facts.subject);
  reader.read("eye", eye);
  reader.read("configuration", facts.configuration);
  reader.read("path", facts.path);
  reader.read("isa", facts.isa);
  HAL_CHECK(read_plan(file, reader, facts.plan));
  HAL_TRY(facts.format.sample_type, type_named(type));
  HAL_TRY(facts.calibration, read_raw_calibration(file, facts.format.samples_per_line));
  facts.eye = eye_named(eye).value_or(Eye::not_said);
  facts.plan.samples = facts.format.samples_per_line;
  facts.plan.zero_padding = facts.calibration.zero_padding;
  HAL_CHECK(check_facts(facts));
  return facts;
}

hal::Result<RawEnd> read_raw_end(hid_t file) {
  HAL_TRY(const auto finished, read_whole(file, "finished"));
  HAL_TRY(const auto not_kept, read_whole(file, "not_kept"));
  RawEnd end{.finished = finished != 0,
             .not_kept = static_cast<std::uint64_t>(std::max<std::int64_t>(not_kept, 0))};
  if (H5Aexists(file, "camera") > 0) {
    HAL_TRY(end.camera, read_text(file, "camera"));
  }
  return end;
}

} // namespace octascope::pipeline

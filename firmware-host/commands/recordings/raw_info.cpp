#include "firmware-host/commands/recordings/raw_info.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/size_text.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/plain_text.h"
#include "pipeline/recordings/raw/raw_reader.h"

namespace octascope::firmware_host {

namespace {

using nlohmann::ordered_json;

struct RawSummary {
  std::size_t whole_volumes = 0;
  double duration_s = 0; // from the first line to the last
};

RawSummary summarise(const pipeline::RawReader& reader) {
  RawSummary summary;
  summary.whole_volumes = static_cast<std::size_t>(
      std::ranges::count_if(reader.volumes(), &pipeline::RawVolume::whole));
  if (!reader.frames().empty())
    summary.duration_s = (static_cast<double>(reader.frames().back().last_line_ns) -
                          static_cast<double>(reader.frames().front().first_line_ns)) *
                         1e-9;
  return summary;
}

std::string type_words(const hal::LineFormat& format) {
  if (format.sample_type == hal::SampleType::f32)
    return "f32";
  return fmt::format("{}, {} bits{}", format.sample_type == hal::SampleType::u8 ? "u8" : "u16",
                     format.significant_bits,
                     format.right_shift > 0
                         ? fmt::format(" behind a shift of {}", format.right_shift)
                         : std::string{});
}

void print_raw_json(const std::string& file, std::uint64_t bytes,
                    const pipeline::RawReader& reader) {
  const pipeline::RawFacts& facts = reader.facts();
  const RawSummary summary = summarise(reader);
  const pipeline::ScanPlan& plan = facts.plan;
  ordered_json json{{"file", file},
                    {"raw_spectra", true},
                    {"bytes", bytes},
                    {"finished", reader.end().finished},
                    {"simulated", facts.simulated},
                    {"frames", reader.frames().size()},
                    {"frames_not_kept", nullptr},
                    {"volumes", reader.volumes().size()},
                    {"whole_volumes", summary.whole_volumes},
                    {"duration_s", summary.duration_s},
                    {"averaged_lines", facts.averaged_lines},
                    {"samples", facts.format.samples_per_line},
                    {"sample_type", type_words(facts.format)},
                    {"lines_per_frame", facts.format.lines_per_frame},
                    {"kept_lines", facts.kept_lines()},
                    {"scan",
                     {{"a_scans", plan.a_scans},
                      {"b_scans", plan.b_scans},
                      {"repeats", plan.repeats},
                      {"bidirectional", plan.bidirectional},
                      {"line_rate_hz", plan.line_rate_hz}}},
                    {"path", facts.path},
                    {"isa", facts.isa},
                    {"camera", reader.end().camera},
                    {"begun", facts.begun},
                    {"recorded_by", facts.recorded_by},
                    {"source", facts.source},
                    {"subject", nullptr},
                    {"eye", nullptr},
                    {"configuration", facts.configuration}};
  if (reader.end().finished)
    json["frames_not_kept"] = reader.end().not_kept;
  if (!facts.subject.empty())
    json["subject"] = facts.subject;
  if (facts.eye != pipeline::Eye::not_said)
    json["eye"] = to_string(facts.eye);
  // Names that people gave may be no UTF-8.
  say("{}\n", json.dump(2, ' ', false, ordered_json::error_handler_t::replace));
}

void print_what_is_there(const pipeline::RawReader& reader) {
  const pipeline::RawFacts& facts = reader.facts();
  const RawSummary summary = summarise(reader);
  const hal::LineFormat& format = facts.format;
  if (facts.averaged_lines > 0) {
    say("  spectra      one line, the mean of {}, of {} samples\n", facts.averaged_lines,
        format.samples_per_line);
    return;
  }
  say("  spectra      {} frames of {} lines, of which {} are kept, of {} samples ({})\n",
      reader.frames().size(), format.lines_per_frame, facts.kept_lines(), format.samples_per_line,
      type_words(format));
  say("  volumes      {}, of which {} are whole, counted from 0; {:.2f} s\n",
      reader.volumes().size(), summary.whole_volumes, summary.duration_s);
  say("  scan         {} B-scans × {} A-scans, {}{}, {:.6g} lines/s\n", facts.plan.b_scans,
      facts.plan.a_scans,
      facts.plan.repeats > 1 ? fmt::format("each {} times, ", facts.plan.repeats) : std::string{},
      facts.plan.bidirectional ? "there and back" : "one direction", facts.plan.line_rate_hz);
  say("  levels       by the path {} ({})\n", hal::printable(facts.path),
      hal::printable(facts.isa));
}

void print_raw_text(const std::string& file, std::uint64_t bytes,
                    const pipeline::RawReader& reader) {
  const pipeline::RawFacts& facts = reader.facts();
  say("{}: {}\n", file,
      facts.simulated ? "raw spectra, SIMULATED, some or all of it is not the patient's"
                      : "raw spectra");
  say("  begun        {}, by {}\n", hal::printable(facts.begun), hal::printable(facts.recorded_by));
  say("  source       {}\n", hal::printable(facts.source));
  say("  camera       {}\n",
      reader.end().camera.empty() ? "not known" : hal::printable(reader.end().camera));
  say("  subject      {}\n", facts.subject.empty() ? "not said" : hal::printable(facts.subject));
  say("  eye          {}\n", to_string(facts.eye));
  print_what_is_there(reader);
  say("  size         {}\n", size_words(bytes));
  say("  finished     {}\n",
      reader.end().finished
          ? "yes"
          : "no: it is being written, or power or program was lost; what is there is whole");
  if (!reader.end().finished)
    say("  lost         how many frames the disk was too slow for is not known: not finished\n");
  else
    say("  lost         frames that the disk was too slow for: {}\n", reader.end().not_kept);
}

} // namespace

int print_raw_info(const InfoCommandLine& line) {
  const auto reader = pipeline::RawReader::open(line.file);
  if (!reader)
    return complain("info", reader.error());
  std::error_code unknown; // a file that was read has a size
  const std::uint64_t bytes = std::filesystem::file_size(line.file, unknown);
  if (line.configuration)
    say("{}", reader->facts().configuration);
  else if (line.json)
    print_raw_json(line.file, bytes, *reader);
  else
    print_raw_text(line.file, bytes, *reader);
  return exit_done;
}

} // namespace octascope::firmware_host

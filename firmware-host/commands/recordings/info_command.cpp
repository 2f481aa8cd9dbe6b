#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/recordings/info.h"
#include "firmware-host/commands/recordings/raw_info.h"
#include "firmware-host/commands/recordings/recording_summary.h"
#include "firmware-host/commands/size_text.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/plain_text.h"
#include "pipeline/recordings/raw/raw_reader.h"
#include "pipeline/recordings/recording_reader.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::firmware_host {

namespace {

using nlohmann::ordered_json;
using pipeline::RecordingFacts;
using pipeline::VolumeGeometry;

struct RecordingReport {
  std::string name;
  std::uint64_t bytes = 0;
  RecordingFacts facts;
  pipeline::RecordingEnd end;
  RecordingSummary summary;
};

hal::Result<RecordingReport> report_on(const std::string& file) {
  HAL_TRY(const auto reader, pipeline::RecordingReader::open(file));
  std::error_code unknown; // a file that was read has a size
  return RecordingReport{file, std::filesystem::file_size(file, unknown), reader.facts(),
                         reader.end(), summarise(reader.volumes(), reader.facts().volume_period_s)};
}

ordered_json geometry_json(const VolumeGeometry& g) {
  return {
      {"depths", g.depths},
      {"a_scans", g.a_scans},
      {"b_scans", g.b_scans},
      {"depth_spacing_um", g.depth_spacing_um},
      {"refractive_index", g.refractive_index ? ordered_json(*g.refractive_index) : ordered_json()},
      {"a_spacing_um", g.a_spacing_um},
      {"b_spacing_um", g.b_spacing_um},
      {"assumed_spacings", g.assumed.words()},
      {"extent_mm", {{"depth", g.depth_mm()}, {"a", g.a_mm()}, {"b", g.b_mm()}}}};
}

ordered_json losses_json(const RecordingReport& report) {
  const RecordingSummary& s = report.summary;
  ordered_json json{{"gaps", s.gaps},
                    {"volumes_in_gaps", s.volumes_in_gaps},
                    {"longest_gap", s.longest_gap},
                    {"pauses", s.pauses},
                    {"paused_s", s.paused_s},
                    {"volumes_not_kept", nullptr},
                    {"b_scans", s.lost_b_scans},
                    {"lines", s.lost_lines},
                    {"saturated_lines", s.saturated_lines}};
  if (report.end.finished)
    json["volumes_not_kept"] = report.end.not_kept;
  return json;
}

void print_json(const RecordingReport& report) {
  const RecordingFacts& facts = report.facts;
  const RecordingSummary& s = report.summary;
  ordered_json json{{"file", report.name},
                    {"bytes", report.bytes},
                    {"finished", report.end.finished},
                    {"simulated", facts.simulated},
                    {"volumes", s.volumes},
                    {"duration_s", s.duration_s},
                    {"rate_hz", nullptr},
                    {"volume_period_s", facts.volume_period_s},
                    {"first_index", s.first_index},
                    {"last_index", s.last_index},
                    {"geometry", geometry_json(facts.geometry)},
                    {"level_scale",
                     {{"lowest_db", pipeline::lowest_level_db},
                      {"step_db", pipeline::level_step_db},
                      {"highest_db", pipeline::highest_level_db}}},
                    {"begun", facts.begun},
                    {"recorded_by", facts.recorded_by},
                    {"source", facts.source},
                    {"subject", nullptr},
                    {"eye", nullptr},
                    {"lost", losses_json(report)},
                    {"configuration", facts.configuration}};
  if (s.rate_hz)
    json["rate_hz"] = *s.rate_hz;
  if (!facts.subject.empty())
    json["subject"] = facts.subject;
  if (facts.eye != pipeline::Eye::not_said)
    json["eye"] = to_string(facts.eye);
  // Names that people gave may be no UTF-8.
  say("{}\n", json.dump(2, ' ', false, ordered_json::error_handler_t::replace));
}

void print_volumes(const RecordingReport& report) {
  const RecordingSummary& s = report.summary;
  if (s.volumes == 0) {
    say("  volumes      none\n");
    return;
  }
  say("  volumes      {}, 0 to {}; the appliance's {} to {}\n", s.volumes, s.volumes - 1,
      s.first_index, s.last_index);
  say("  duration     {:.2f} s", s.duration_s);
  if (s.rate_hz)
    say(", {:.2f} volumes/s", *s.rate_hz);
  say("; planned one in {:.1f} ms\n", 1000 * report.facts.volume_period_s);
}

void print_losses(const RecordingReport& report) {
  const RecordingSummary& s = report.summary;
  if (s.gaps == 0)
    say("  lost         no volume between the first and the last\n");
  else
    say("  lost         volumes: {}, gaps: {}, the longest of {}\n", s.volumes_in_gaps, s.gaps,
        s.longest_gap);
  if (s.pauses > 0)
    say("               pauses: {}, {:.1f} s in all, in which the machine slept or its clock "
        "was set\n",
        s.pauses, s.paused_s);
  if (!report.end.finished)
    say("               how many the disk was too slow for is not known: not finished\n");
  else if (report.end.not_kept > 0)
    say("               not kept because the disk was too slow: {}\n", report.end.not_kept);
  say("               B-scans: {}, lines: {}; saturated lines: {}\n", s.lost_b_scans, s.lost_lines,
      s.saturated_lines);
}

void print_text(const RecordingReport& report) {
  const RecordingFacts& facts = report.facts;
  const VolumeGeometry& g = facts.geometry;
  say("{}: {}\n", report.name,
      facts.simulated ? "SIMULATED, some or all of it is not the patient's" : "a recording");
  say("  begun        {}, by {}\n", hal::printable(facts.begun), hal::printable(facts.recorded_by));
  say("  source       {}\n", hal::printable(facts.source));
  say("  subject      {}\n", facts.subject.empty() ? "not said" : hal::printable(facts.subject));
  say("  eye          {}\n", to_string(facts.eye));
  print_volumes(report);
  say("  geometry     {} depths × {} A-scans × {} B-scans\n", g.depths, g.a_scans, g.b_scans);
  say("               every {:.4g} × {:.4g} × {:.4g} µm: {:.4g} × {:.4g} × {:.4g} mm\n",
      g.depth_spacing_um, g.a_spacing_um, g.b_spacing_um, g.depth_mm(), g.a_mm(), g.b_mm());
  if (g.assumed.any())
    say("               assumed, not measured: the spacings of {}\n", g.assumed.words());
  say("               depths hold {}\n",
      g.refractive_index ? fmt::format("for a refractive index of {}", *g.refractive_index)
                         : "for a medium that nobody said");
  say("  levels       counts 0 to 255, {} dB and {} dB a count, to {} dB\n",
      pipeline::lowest_level_db, pipeline::level_step_db, pipeline::highest_level_db);
  say("  size         {}\n", size_words(report.bytes));
  say("  finished     {}\n",
      report.end.finished
          ? "yes"
          : "no: it is being written, or power or program was lost; what is there is whole");
  print_losses(report);
}

int run(const InfoCommandLine& line) {
  if (pipeline::says_raw_spectra(line.file))
    return print_raw_info(line);
  const auto report = report_on(line.file);
  if (!report)
    return complain("info", report.error());
  if (line.configuration)
    say("{}", report->facts.configuration);
  else if (line.json)
    print_json(*report);
  else
    print_text(*report);
  return exit_done;
}

} // namespace

void add_info_command(CLI::App& program, int& exit_status) {
  auto line = std::make_shared<InfoCommandLine>();
  CLI::App* command = program.add_subcommand("info", "What a recording holds, and what it lacks");
  command
      ->add_option("file", line->file,
                   "Recording of volumes or of raw spectra, also one that is being written")
      ->required()
      ->type_name("FILE.h5");
  CLI::Option* json = command->add_flag("--json", line->json, "One JSON object");
  command
      ->add_flag("--configuration", line->configuration,
                 "Nothing but the configuration that was in use (TOML)")
      ->excludes(json);
  command->footer("Example: octascope info recording.h5 --json");
  command->callback([line, &exit_status] { exit_status = run(*line); });
}

} // namespace octascope::firmware_host

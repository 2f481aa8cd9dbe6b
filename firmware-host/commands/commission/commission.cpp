#include "firmware-host/commands/commission/commission.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "firmware-host/commands/commission/commission_report.h"
#include "firmware-host/commands/commission/steps.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/linux/monotonic_clock.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace {

struct Step {
  std::string_view key;
  std::string_view title;
  std::string_view purpose;
  hal::Result<StepRecord> (*run)(Bench& bench);
};

// Frames come only after a pulse, so the trigger is before the spectrum.
constexpr std::array steps{
    Step{"camera", "Camera", "Finds the line camera and notes how it is scanned.", find_camera},
    Step{"trigger", "Trigger", "Pulses the scanner's trigger and counts the frames that follow.",
         count_trigger},
    Step{"spectrum", "Spectrum", "Shows the spectrum: is there light, too much, a fringe?",
         look_at_spectrum},
    Step{"dark", "Dark", "Captures the light that is no interference.", capture_dark},
    Step{"mirror_near", "Mirror, near", "Captures a mirror at a small depth.", capture_near_mirror},
    Step{"mirror_far", "Mirror, far", "Captures the mirror at a larger depth.", capture_far_mirror},
    Step{"tissue", "Tissue",
         "Captures tissue: it tells on which side of zero delay the mirrors were.", capture_tissue},
    Step{"calibration", "Calibration", "Finds the calibration from the captures, and judges it.",
         calibrate_from_captures},
    Step{"target", "Target", "Checks which way round the picture is, and how large.", check_target},
    Step{"pedal", "Pedal", "Learns what an unknown pedal or knob sends.", learn_pedal},
    Step{"configuration", "Configuration", "Writes the configuration of the appliance.",
         write_configuration}};

hal::Result<> write_report(const Session& session) {
  std::vector<ReportedStep> reported;
  for (const Step& step : steps)
    reported.push_back({step.key, step.title});
  return pipeline::write_atomically(session.folder() / "report.html",
                                    commission_report(session, reported));
}

void tell(const StepRecord& record) {
  for (const auto& [what, value] : record.found)
    say("  {:<22} {}\n", what, value);
  for (const std::string& warning : record.warnings)
    say("  WARNING: {}\n", warning);
}

std::string_view title_of(std::string_view key) {
  return std::ranges::find(steps, key, &Step::key)->title;
}

// Captures block the signals that end them, for good; at a question Ctrl+C ends the program.
hal::Result<StepRecord> run_step(const Step& step, Bench& bench) {
  sigset_t before;
  pthread_sigmask(SIG_BLOCK, nullptr, &before);
  auto record = step.run(bench);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return record;
}

// Before a step that was done in an earlier session.
hal::Result<std::string> ask_to_keep(const Step& step, Bench& bench) {
  say("Done before:\n");
  tell(bench.session.record(step.key));
  const std::string newer = bench.session.outdated_by(step.key);
  if (newer.empty())
    return bench.dialogue.ask_word("Keep it?", {"keep", "repeat"});
  say("  OUTDATED: done before \"{}\" was last done\n", title_of(newer));
  return bench.dialogue.ask_word("Repeat it?", {"repeat", "keep"});
}

// Until it is done and kept, or skipped.
hal::Result<> take_step(const Step& step, Bench& bench) {
  Session& session = bench.session;
  HAL_TRY(auto answer, session.outcome(step.key) == "done"
                           ? ask_to_keep(step, bench)
                           : bench.dialogue.ask_word("Do it?", {"do", "skip"}));
  while (answer == "do" || answer == "repeat") {
    const auto record = run_step(step, bench);
    if (record) {
      tell(*record);
      HAL_CHECK(session.keep(step.key, *record));
      HAL_TRY(answer, bench.dialogue.ask_word("Go on?", {"next", "repeat"}));
      continue;
    }
    if (bench.dialogue.quit() || bench.dialogue.ended()) // no fault of the step
      return tl::make_unexpected(record.error());
    say("  FAILED: {}\n", record.error().message);
    HAL_CHECK(session.fail(step.key, record.error().message));
    // A script that knows no better must come to an end.
    HAL_TRY(answer, bench.dialogue.by_script()
                        ? bench.dialogue.ask_word("Again?", {"quit", "repeat", "skip"})
                        : bench.dialogue.ask_word("Again?", {"repeat", "skip", "quit"}));
  }
  return answer == "skip" ? session.skip(step.key) : hal::Result<>{};
}

hal::Result<> take_steps(Bench& bench) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    say("\n{} of {} · {}\n{}\n", i + 1, steps.size(), steps[i].title, steps[i].purpose);
    const auto taken = take_step(steps[i], bench);
    HAL_CHECK(write_report(bench.session));
    if (bench.dialogue.quit())
      return hal::fail(hal::ErrorCode::disconnected,
                       "ended at step {} of {}, \"{}\"; the same command goes on from there", i + 1,
                       steps.size(), steps[i].title);
    HAL_CHECK(taken);
  }
  return {};
}

// What is still to be done with the same command.
void say_what_is_left(const Session& session) {
  const bool calibrated = session.outcome("calibration") == "done";
  const bool configured = session.outcome("configuration") == "done";
  if (!calibrated || !configured)
    say("Without {}: skipped steps are asked for again by the same command.\n",
        calibrated ? "a configuration" : "a calibration");
  for (const Step& step : steps)
    if (const std::string newer = session.outdated_by(step.key); !newer.empty())
      say("Outdated: \"{}\", done before \"{}\" was last done; the same command offers to repeat "
          "it.\n",
          step.title, title_of(newer));
}

} // namespace

hal::Result<> commission(const CommissionOptions& options, std::istream& answers) {
  hal::linux_backend::MonotonicClock clock;
  HAL_TRY(auto session, Session::open(options.folder, options.simulate));
  Dialogue dialogue{answers, ::isatty(STDIN_FILENO) == 0};
  Bench bench{session, dialogue, clock};
  say("Commissioning into {}{}. An empty line takes what stands in brackets, \"quit\" "
      "ends at any question.\n",
      options.folder.string(), options.simulate ? ", SIMULATED" : "");
  HAL_CHECK(take_steps(bench));
  say("\nReport: {}\n", (options.folder / "report.html").string());
  say_what_is_left(session);
  return {};
}

} // namespace octascope::firmware_host

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "firmware-host/commands/command.h"
#include "firmware-host/commands/commission/steps.h"
#include "firmware-host/commands/devices/devices_learn.h"
#include "firmware-host/configuration/configuration.h"
#include "firmware-host/devices/device_choice.h"
#include "firmware-host/devices/real_devices.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/control_input.h"
#include "ui/controls/control_profile.h"
#include "ui/controls/legend_lines.h"

namespace octascope::firmware_host {

namespace {

using namespace std::chrono_literals;

constexpr hal::Duration first_within = 10s;
constexpr hal::Duration next_within = 3s;

// What somebody did, in the words of the display; empty: let go, or a deflection that a hand does not
// mean.
std::string name_of(const hal::ControlEvent& event, const ui::ControlProfile& profile) {
  constexpr int meant = 200; // of 1000
  switch (event.kind) {
  case hal::ControlKind::pedal_switch:
    return event.value == 0 ? std::string{}
           : event.index < profile.switches.size()
               ? words_for(profile, ui::SwitchSet{1} << event.index)
               : fmt::format("switch {}", event.index + 1);
  case hal::ControlKind::knob:
    return fmt::format("{} {}",
                       event.index < profile.knobs.size() ? profile.knobs[event.index] : "knob",
                       event.value > 0 ? "clockwise" : "counter-clockwise");
  case hal::ControlKind::axis:
    return std::abs(event.value) >= meant
               ? fmt::format("{} {}", profile.stick, ui::axis_name(event.index))
               : std::string{};
  }
  return {};
}

// Says what comes, each once, until nothing has come for a while.
hal::Result<std::vector<std::string>> hear(hal::ControlInput& input,
                                           const ui::ControlProfile& profile, hal::Clock& clock) {
  std::vector<std::string> heard;
  std::array<hal::ControlEvent, 32> events{};
  hal::TimePoint until = clock.now() + first_within;
  while (clock.now() < until) {
    HAL_TRY(const std::size_t count, input.read(events, until - clock.now()));
    for (std::size_t i = 0; i < count; ++i) {
      std::string name = name_of(events[i], profile);
      if (name.empty())
        continue;
      until = clock.now() + next_within;
      if (std::ranges::find(heard, name) != heard.end())
        continue;
      say("  {}\n", name);
      std::fflush(stdout);
      heard.push_back(std::move(name));
    }
  }
  return heard;
}

hal::Result<> try_pedal(Bench& bench, RealDevices& devices, StepRecord& record) {
  HAL_TRY(const auto answer, bench.dialogue.ask_word("Try it now?", {"yes", "no"}));
  if (answer == "no")
    return {};
  const auto input = devices.make_control_input();
  HAL_CHECK(input->open());
  const auto profile = devices.new_control_profile().value_or(ui::ControlProfile{});
  say("  Press each switch and turn each knob, one after the other. It ends when nothing has come "
      "for three seconds.\n");
  std::fflush(stdout); // seen now, through a pipe as well
  HAL_TRY(const auto heard, hear(*input, profile, bench.clock));
  input->close();
  if (heard.empty())
    record.warnings.emplace_back("nothing came of it in 10 s: if something was pressed, repeat the "
                                 "step, and answer \"yes\" to learn it");
  else
    record.found.emplace_back("pressed or turned", fmt::format("{}", fmt::join(heard, ", ")));
  return {};
}

// Of those known, the one that `run` takes, and why.
hal::Result<StepRecord> known_pedal(Bench& bench) {
  HAL_TRY(const auto options, bench.session.run_options("dark"));
  HAL_TRY(const auto configuration, bench.session.configuration());
  RealDevices real{configuration.devices, plan_of(options, configuration), bench.clock};
  const auto choices = choose_devices(real.find_for(options), options, configuration.devices);
  StepRecord record;
  if (choices.control_input.backend == "none") {
    record.found = {{"pedal", "none that is known: " + choices.control_input.reason}};
    return record;
  }
  record.found = {{"pedal", choices.control_input.reason}};
  HAL_CHECK(try_pedal(bench, real, record));
  return record;
}

hal::Result<StepRecord> new_pedal(Bench& bench) {
  const auto device = bench.session.free_file("pedal", ".device.toml");
  const std::string name = device.filename().string();
  const std::string stem = name.substr(0, name.rfind(".device.toml"));
  if (learn_control({.usb = {},
                     .out = bench.session.folder() / stem,
                     .reads_input = ::isatty(STDIN_FILENO) != 0}) != exit_done)
    return hal::fail(hal::ErrorCode::absent, "nothing was learned; repeat the step, or skip it");
  bench.session.set("control_device", stem + ".device.toml");
  bench.session.set("control_profile", stem + ".profile.toml");
  StepRecord record;
  record.found = {{"pedal", fmt::format("learned: {0}.device.toml, {0}.profile.toml", stem)}};
  return record;
}

} // namespace

hal::Result<StepRecord> learn_pedal(Bench& bench) {
  StepRecord record;
  if (bench.session.simulated()) {
    record.found = {{"pedal", "simulated: it follows a script, there is nothing to learn"}};
    return record;
  }
  HAL_TRY(const auto answer,
          bench.dialogue.ask_word("Learn a pedal or knob that `octascope devices` does not know?",
                                  {"no", "yes"}));
  return answer == "no" ? known_pedal(bench) : new_pedal(bench);
}

} // namespace octascope::firmware_host

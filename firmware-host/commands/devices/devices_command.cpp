// octascope devices: what hardware is there, which backend or twin would be used, and why.
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/command.h"
#include "firmware-host/commands/devices/devices_learn.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/devices/device_choice.h"
#include "firmware-host/devices/hardware_survey.h"
#include "firmware-host/devices/real_devices.h"
#include "firmware-host/diagnosis/device_text.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/linux/monotonic_clock.h"

namespace octascope::firmware_host {

void add_devices_command(CLI::App& program, int& exit_status) {
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = program.add_subcommand(
      "devices", "What hardware is there, which backend or twin would be used, and why");
  command->footer("Example: octascope devices --json");
  command->add_flag("--json", *as_json, "One JSON object");
  auto configuration = std::make_shared<std::string>();
  command
      ->add_option("--config", *configuration,
                   "What a run with this configuration would use; else the machine's own, "
                   "/etc/octascope/octascope.toml")
      ->type_name("FILE.toml");
  auto learn = std::make_shared<LearnOptions>();
  auto learns = std::make_shared<bool>(false);
  CLI::Option* const learning = command->add_flag(
      "--learn", *learns, "Show what a new pedal sends and write a profile for it");
  command->add_option("--device", learn->usb, "With --learn: vendor:product of one plugged in")
      ->needs(learning);
  command->add_option("--out", learn->out, "With --learn: name of the two files to write")
      ->needs(learning);
  command->add_option("--quiet", learn->quiet_s, "With --learn: seconds of quiet that end it")
      ->check(within(0.1, 3600.0))
      ->needs(learning);
  command->callback([as_json, configuration, learn, learns, &exit_status] {
    if (*learns) {
      exit_status = learn_control(*learn);
      return;
    }
    const HardwareSurvey survey = survey_hardware();
    hal::linux_backend::MonotonicClock clock;
    RunOptions options;
    if (!configuration->empty())
      options.configuration = *configuration;
    const auto choices = choices_of_run(options, clock);
    if (!choices) {
      warn("octascope devices: {}\n", choices.error().message);
      exit_status = exit_failed;
      return;
    }
    say("{}", *as_json ? devices_json(survey, *choices) : devices_text(survey, *choices));
    exit_status = exit_done;
  });
}

} // namespace octascope::firmware_host

#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/commission/commission.h"

namespace octascope::firmware_host {

void add_commission_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    std::string folder;
    bool simulate = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("commission", "From a box of parts to a calibrated picture, step by step");
  command
      ->add_option("--out", arguments->folder,
                   "Folder of what is found; the same one goes on where it was left")
      ->required()
      ->type_name("FOLDER");
  command->add_flag("--sim", arguments->simulate,
                    "Use the simulated devices, whatever is plugged in");
  command->footer(
      "Each question is answered by a line; an empty one takes what stands in brackets. Each step\n"
      "can be done, repeated, skipped or left for later, and no file is overwritten. The folder\n"
      "then holds octascope.toml, calibration.toml and report.html. docs/COMMISSIONING.md is the\n"
      "guide.\n"
      "Examples:\n"
      "  octascope commission --out microscope-1\n"
      "  octascope commission --sim --out try-it\n"
      "  yes '' | octascope commission --sim --out try-it");
  command->callback([arguments, &exit_status] {
    const auto done = commission({arguments->folder, arguments->simulate}, std::cin);
    std::fflush(stdout); // what was asked, before why it ended
    exit_status = done ? exit_done : complain("commission", done.error());
  });
}

} // namespace octascope::firmware_host

#include <CLI/CLI.hpp>

#include "firmware-host/commands/reconstruct.h"
#include "firmware-host/version.h"

int main(int argc, char** argv) {
  using namespace octascope::firmware_host;
  int exit_status = 0;
  CLI::App app{"octascope: OCT through the surgical microscope", "octascope"};
  app.set_version_flag("--version", std::string{version()});
  app.require_subcommand(1);
  add_reconstruct_command(app, exit_status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    constexpr int wrong_use = 2;
    return app.exit(error) == 0 ? 0 : wrong_use;
  }
  return exit_status;
}

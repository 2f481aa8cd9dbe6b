#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/command.h"
#include "firmware-host/commands/devices/status.h"
#include "firmware-host/commands/devices/status_text.h"
#include "firmware-host/supervision/service_manager.h"
#include "firmware-host/supervision/status_server.h"
#include "firmware-host/terminal/terminal.h"

namespace octascope::firmware_host {

namespace {

struct StatusArguments {
  std::string socket;
  bool as_json = false;
};

std::filesystem::path socket_of(const StatusArguments& arguments) {
  if (!arguments.socket.empty())
    return arguments.socket;
  return service_folders().runtime.value_or("/run/octascope") / status_socket_name;
}

int show_status(const StatusArguments& arguments) {
  const auto answer = ask_status(socket_of(arguments));
  const auto shown = arguments.as_json ? answer : answer.and_then(status_words);
  if (!shown) {
    warn("octascope status: {}\n", shown.error().message);
    return exit_failed;
  }
  say("{}", *shown);
  return exit_done;
}

} // namespace

void add_status_command(CLI::App& program, int& exit_status) {
  auto arguments = std::make_shared<StatusArguments>();
  CLI::App* command = program.add_subcommand("status", "What the running appliance says of itself");
  command->footer(
      "Example: octascope status --json\n"
      "The answer comes from the appliance on this machine, over a local socket that its "
      "group may use; nothing listens on a network.");
  command
      ->add_option("--socket", arguments->socket,
                   "The appliance's socket; else status.sock in $RUNTIME_DIRECTORY, else in "
                   "/run/octascope")
      ->type_name("SOCKET");
  command->add_flag("--json", arguments->as_json, "One JSON object");
  command->callback([arguments, &exit_status] { exit_status = show_status(*arguments); });
}

} // namespace octascope::firmware_host

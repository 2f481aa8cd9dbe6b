// octascope doctor: what would fail on this machine, and the remedy.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pwd.h>
#include <unistd.h>

#include "firmware-host/commands/command.h"
#include "firmware-host/diagnosis/health_check.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/linux/monotonic_clock.h"

namespace octascope::firmware_host {

namespace {

constexpr const char* appliance_user = "octascope"; // the package's

const char* word(Verdict verdict) {
  switch (verdict) {
  case Verdict::good: return "good";
  case Verdict::limited: return "limited";
  case Verdict::fails: return "fails";
  }
  return "unknown";
}

// Root may open everything; the appliance's own user may not.
void say_who_was_asked() {
  if (::geteuid() == 0 && ::getpwnam(appliance_user) != nullptr)
    say("\nAsked as root, who may open everything. For what the appliance may: "
        "sudo -u {} octascope doctor\n",
        appliance_user);
}

void print_text(const std::vector<HealthCheck>& checks) {
  for (const HealthCheck& check : checks) {
    say("{:<8} {:<19} {}\n", word(check.verdict), check.subject, check.found);
    if (!check.remedy.empty())
      say("{:<28} → {}\n", "", check.remedy);
  }
  say_who_was_asked();
}

void print_json(const std::vector<HealthCheck>& checks) {
  auto json = nlohmann::ordered_json::array();
  for (const HealthCheck& check : checks)
    json.push_back({{"subject", check.subject},
                    {"verdict", word(check.verdict)},
                    {"found", check.found},
                    {"remedy", check.remedy},
                    {"mend", check.remedy}}); // its old name
  say("{}\n", nlohmann::ordered_json{{"checks", json}}.dump(2));
}

} // namespace

void add_doctor_command(CLI::App& program, int& exit_status) {
  auto as_json = std::make_shared<bool>(false);
  auto file = std::make_shared<std::string>();
  CLI::App* command =
      program.add_subcommand("doctor", "What would fail on this machine, and the remedy");
  command->footer("Exit status 1 when the appliance would not run at all.\n"
                  "Examples:\n"
                  "  octascope doctor\n"
                  "  octascope doctor --config octascope.toml");
  command->add_option("--config", *file, "Check this configuration and nothing else")
      ->type_name("FILE.toml");
  command->add_flag("--json", *as_json, "One JSON object");
  command->callback([as_json, file, &exit_status] {
    hal::linux_backend::MonotonicClock clock;
    auto checks = file->empty() ? check_health(clock) : std::vector<HealthCheck>{};
    for (HealthCheck& check :
         check_configuration(file->empty() ? std::optional<std::filesystem::path>{} : *file))
      checks.push_back(std::move(check));
    if (*as_json)
      print_json(checks);
    else
      print_text(checks);
    const bool fails = std::ranges::any_of(
        checks, [](const HealthCheck& check) { return check.verdict == Verdict::fails; });
    exit_status = fails ? exit_failed : exit_done;
  });
}

} // namespace octascope::firmware_host

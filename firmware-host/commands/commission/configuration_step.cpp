#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/commands/commission/steps.h"
#include "firmware-host/configuration/configuration.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/calibration/calibration_writer.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace {

// octascope.toml if it is not there or still as it was written here; else a new name.
std::filesystem::path place_of_configuration(const Session& session) {
  const auto file = session.folder() / "octascope.toml";
  const std::string there = configuration_text(file);
  return there == session.text("configuration_text") ? file
                                                     : session.free_file("octascope", ".toml");
}

// What a run would say of it: read under another name, so that it takes no good one's place.
hal::Result<Configuration> check(const Session& session, const std::string& text) {
  const auto candidate = session.free_file("unchecked", ".toml");
  HAL_CHECK(pipeline::write_atomically(candidate, text));
  auto read = load_configuration(candidate);
  std::error_code ignored;
  std::filesystem::remove(candidate, ignored);
  if (read)
    return read;
  std::string reason = read.error().message;
  const std::string name = candidate.string();
  if (const auto at = reason.find(name); at != std::string::npos)
    reason.replace(at, name.size(), "octascope.toml"); // the other is gone
  return hal::fail(read.error().code,
                   "a run would refuse the configuration, so it is not written: {}", reason);
}

// As a shell takes it for one word.
std::string shell_word(const std::string& text) {
  constexpr std::string_view safe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                    "_-./+,:@%";
  if (!text.empty() && text.find_first_not_of(safe) == text.npos)
    return text;
  std::string word = "'";
  for (const char letter : text)
    word += letter == '\'' ? "'\\''" : std::string(1, letter);
  return word + "'";
}

// The configuration, and all that it names.
std::vector<std::filesystem::path> files_of_appliance(const Session& session) {
  std::vector<std::filesystem::path> files{session.folder() / "octascope.toml"};
  if (const auto calibration = session.file("calibration")) {
    files.push_back(*calibration);
    std::ranges::copy(pipeline::curves_beside(*calibration), std::back_inserter(files));
  }
  for (const char* const key : {"control_device", "control_profile"})
    if (const auto file = session.file(key))
      files.push_back(*file);
  std::erase_if(files, [](const std::filesystem::path& file) {
    std::error_code ignored;
    return !std::filesystem::exists(file, ignored);
  });
  return files;
}

std::string copy_command(const Session& session) {
  std::string command = "sudo cp";
  for (const auto& file : files_of_appliance(session))
    command += " " + shell_word(file.string());
  return command + " /etc/octascope/";
}

} // namespace

hal::Result<StepRecord> write_configuration(Bench& bench) {
  Session& session = bench.session;
  const std::string text = session.configuration_toml();
  HAL_TRY(const auto configuration, check(session, text));
  const auto file = place_of_configuration(session);
  HAL_CHECK(pipeline::write_atomically(file, text));
  StepRecord record;
  if (!configuration.calibration)
    record.warnings.emplace_back("there is no calibration: the picture will be blurred");
  if (file.filename() == "octascope.toml")
    session.set("configuration_text", text);
  else
    record.warnings.push_back(
        fmt::format("octascope.toml was changed by hand and is left as it is: "
                    "compare it with {}",
                    file.filename().string()));
  record.found = {{"file", file.filename().string()},
                  {"to see the picture", "octascope run --config " + shell_word(file.string())}};
  if (!session.simulated()) {
    record.found.emplace_back("for the appliance", copy_command(session));
    record.found.emplace_back("and then", "sudo systemctl restart octascope");
  }
  return record;
}

} // namespace octascope::firmware_host

#include <fmt/format.h>

#include "firmware-host/commands/commission/steps.h"
#include "firmware-host/configuration/configuration.h"
#include "firmware-host/terminal/terminal.h"
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
  const std::string run = fmt::format("octascope run --config {}", file.string());
  record.found = {{"file", file.filename().string()}, {"to see the picture", run}};
  return record;
}

} // namespace octascope::firmware_host

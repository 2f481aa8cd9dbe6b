#include "firmware-host/commands/bench/self_run.h"

#include <cstdlib>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace octascope::firmware_host {

namespace {

hal::Result<> run_self(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "octascope");
  std::vector<char*> words;
  for (std::string& argument : arguments)
    words.push_back(argument.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  const int spawned =
      ::posix_spawn(&child, "/proc/self/exe", &actions, nullptr, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (spawned != 0 || ::waitpid(child, &status, 0) != child || status != 0)
    return hal::fail(
        hal::ErrorCode::system, "the benchmark could not run `{}`: {}", fmt::join(arguments, " "),
        spawned != 0 ? std::system_category().message(spawned) : fmt::format("status {}", status));
  return {};
}

} // namespace

hal::Result<BenchFolder> BenchFolder::make() {
  std::string name = (std::filesystem::temp_directory_path() / "octascope-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    return hal::fail(hal::ErrorCode::system, "the benchmark found no place for its files: is the "
                                             "temporary folder writable?");
  return BenchFolder{name};
}

BenchFolder::~BenchFolder() {
  std::error_code ignored;
  if (!folder_.empty())
    std::filesystem::remove_all(folder_, ignored);
}

hal::Result<nlohmann::json> report_of(std::vector<std::string> arguments,
                                      const std::filesystem::path& report) {
  arguments.insert(arguments.end(), {"--report", report.string()});
  HAL_CHECK(run_self(std::move(arguments)));
  auto read = nlohmann::json::parse(std::ifstream{report}, nullptr, false);
  if (read.is_discarded())
    return hal::fail(hal::ErrorCode::bad_data, "the benchmark's run left no readable report");
  return read;
}

double number_in(const nlohmann::json& report, const char* pointer) {
  const auto& value = report.at(nlohmann::json::json_pointer{pointer});
  return value.is_number() ? value.get<double>() : 0;
}

QualitySummary quality_in(const nlohmann::json& report) {
  const auto& quality = report.at("quality");
  const auto range = [&](const char* key) -> std::optional<QualityRange> {
    const auto& values = quality.at(key);
    if (values.is_null())
      return std::nullopt;
    return QualityRange{.median = values.at("median"), .worst = values.at("worst")};
  };
  return {
      .frames = quality.at("frames"), .resolution = range("resolution"), .steps = range("steps")};
}

} // namespace octascope::firmware_host

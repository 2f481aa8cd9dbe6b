#include "firmware-host/commands/bench/live_probe.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace octascope::firmware_host {

namespace {

// Gone with all that is in it when the probe is over.
class ProbeFolder {
public:
  ProbeFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "octascope-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr)
      folder_ = name;
  }
  ProbeFolder(const ProbeFolder&) = delete;
  ProbeFolder& operator=(const ProbeFolder&) = delete;
  ~ProbeFolder() {
    std::error_code ignored;
    if (!folder_.empty())
      std::filesystem::remove_all(folder_, ignored);
  }
  bool made() const { return !folder_.empty(); }
  std::filesystem::path file(const char* name) const { return folder_ / name; }

private:
  std::filesystem::path folder_;
};

// The right switch twice: from the window's offset to the rotation. Then a detent each 50 ms.
void write_turning_knob(const std::filesystem::path& file, double seconds) {
  std::ofstream script{file};
  const auto event = [&](double time_s, const char* control, int value) {
    script << fmt::format("[[event]]\ntime_s = {:.3f}\n{}\nvalue = {}\n", time_s, control, value);
  };
  for (const double press_s : {0.2, 0.5}) {
    event(press_s, "switch = 2", 1);
    event(press_s + 0.1, "switch = 2", 0);
  }
  for (double time_s = 1; time_s < seconds; time_s += 0.05)
    event(time_s, "knob = 0", 1);
}

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
        hal::ErrorCode::system, "the live probe could not run `{}`: {}", fmt::join(arguments, " "),
        spawned != 0 ? std::system_category().message(spawned) : fmt::format("status {}", status));
  return {};
}

hal::Result<nlohmann::json> read_report(const std::filesystem::path& file) {
  auto report = nlohmann::json::parse(std::ifstream{file}, nullptr, false);
  if (report.is_discarded())
    return hal::fail(hal::ErrorCode::bad_data, "the live probe left no readable report");
  return report;
}

} // namespace

hal::Result<LiveFigures> probe_live(int width, int height, double seconds) {
  const ProbeFolder folder;
  if (!folder.made())
    return hal::fail(hal::ErrorCode::system, "the live probe found no place for its files: is the "
                                             "temporary folder writable?");
  write_turning_knob(folder.file("knob.toml"), seconds);
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"run",        "--sim",
                                       "--display",  "offscreen",
                                       "--size",     fmt::format("{}x{}", width, height),
                                       "--duration", fmt::format("{}", seconds),
                                       "--report",   folder.file("report.json").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_self(std::move(arguments)).and_then([&] {
      return read_report(folder.file("report.json"));
    });
  };
  HAL_TRY(const auto turning, run({"--controls", folder.file("knob.toml").string()}));
  HAL_TRY(const auto resting, run({}));
  const auto number = [](const nlohmann::json& report, const char* pointer) {
    const auto& value = report.at(nlohmann::json::json_pointer{pointer});
    return value.is_number() ? value.get<double>() : 0;
  };
  return LiveFigures{1000 * number(turning, "/first_picture_s"),
                     number(turning, "/rates/frames_per_s"),
                     number(turning, "/control_ms/p50"),
                     number(turning, "/control_ms/p95"),
                     number(turning, "/latency_ms/p50"),
                     number(turning, "/latency_ms/p95"),
                     number(resting, "/latency_ms/p50"),
                     number(resting, "/latency_ms/p95"),
                     number(turning, "/lost/volumes") + number(resting, "/lost/volumes")};
}

} // namespace octascope::firmware_host

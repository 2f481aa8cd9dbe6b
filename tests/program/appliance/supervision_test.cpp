// The program as a service: what it tells systemd, what it answers, what a crash leaves, and how
// soon it ends. Threads are brought to a standstill as a hanging driver would: stopped in place,
// one by one, by ptrace(2).
#include <array>
#include <csignal>
#include <cstring>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hal/linux/system/file_descriptor.h"
#include "tests/program/program_support.h"
#include "tests/support/files/mutation.h"
#include "tests/support/program/built_places.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using hal::linux_backend::FileDescriptor;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

// What systemd is to a service: folders, and somebody who listens.
class Service {
public:
  Service() {
    std::filesystem::create_directory(state());
    std::filesystem::create_directory(runtime());
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, notify().c_str(), sizeof address.sun_path - 1);
    if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      ADD_FAILURE() << std::strerror(errno);
  }

  std::filesystem::path state() const { return folder_ / "state"; }
  std::filesystem::path runtime() const { return folder_ / "runtime"; }
  const ScratchFolder& folder() const { return folder_; }

  // A small run in the unit's environment.
  std::vector<std::string> command(std::vector<std::string> more = {}) const {
    std::vector<std::string> words{"env", "STATE_DIRECTORY=" + state().string() + ":/nowhere",
                                   "RUNTIME_DIRECTORY=" + runtime().string(),
                                   "NOTIFY_SOCKET=" + notify().string(), "WATCHDOG_USEC=800000"};
    for (std::string& word : octascope_command(small_run(folder_, std::move(more))))
      words.push_back(std::move(word));
    return words;
  }

  // Everything that is told within that time, or until this is.
  std::string listen(WallClock::duration most, const std::string& until = "\n\n") {
    std::string told;
    for (const auto end = WallClock::now() + most; told.find(until) == std::string::npos;) {
      pollfd waited{socket_.get(), POLLIN, 0};
      if (::poll(&waited, 1, most > 0s ? 20 : 0) != 1) {
        if (WallClock::now() >= end)
          break;
        continue;
      }
      std::array<char, 4096> piece{};
      const ssize_t n = ::recv(socket_.get(), piece.data(), piece.size(), 0);
      if (n > 0)
        told.append(piece.data(), static_cast<std::size_t>(n)).append("\n");
    }
    return told;
  }

  // Null where nobody answers (yet).
  json status() const {
    const ProgramResult result =
        run_octascope({"status", "--json", "--socket", (runtime() / "status.sock").string()});
    return result.exit_status == 0 ? json::parse(result.out, nullptr, false) : json{};
  }

  // The status once it is as wanted; a failed test where that never happens. What is notified
  // meanwhile is read away, as systemd would: the kernel keeps ten messages, and then waits.
  template <class Wanted> json await_status(Wanted wanted) {
    json last;
    for (const auto end = WallClock::now() + 60s; WallClock::now() < end;) {
      listen(0s);
      last = status();
      if (last.is_object() && last.contains("picture") && wanted(last))
        return last;
      std::this_thread::sleep_for(100ms);
    }
    ADD_FAILURE() << "never as wanted: " << last;
    return last;
  }

  std::vector<std::filesystem::path> crash_reports() const {
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator{state() / "crash", error})
      found.push_back(entry.path());
    return found;
  }

private:
  std::filesystem::path notify() const { return folder_ / "notify"; }

  ScratchFolder folder_;
  FileDescriptor socket_{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
};

// One thread of a child stands still while the object lives. Of several of one name, which threads
// pass on to those that they start, the first.
class Standstill {
public:
  Standstill(pid_t process, const std::string& thread) {
    for (const auto& task :
         std::filesystem::directory_iterator{"/proc/" + std::to_string(process) + "/task"}) {
      std::string name = whole_file(task.path() / "comm");
      if (name == thread + "\n" && thread_ == 0)
        thread_ = std::stoi(task.path().filename().string());
    }
    if (thread_ == 0 || ::ptrace(PTRACE_SEIZE, thread_, nullptr, nullptr) != 0 ||
        ::ptrace(PTRACE_INTERRUPT, thread_, nullptr, nullptr) != 0)
      thread_ = 0;
    else
      ::waitpid(thread_, nullptr, __WALL);
  }
  ~Standstill() {
    if (thread_ != 0)
      ::ptrace(PTRACE_DETACH, thread_, nullptr, nullptr);
  }
  Standstill(const Standstill&) = delete;
  Standstill& operator=(const Standstill&) = delete;

  bool stands() const { return thread_ != 0; }

private:
  pid_t thread_ = 0;
};

TEST(Supervision, says_ready_with_the_first_picture_and_kicks_with_those_that_follow) {
  Service service;
  ProgramRun run{service.command()};
  EXPECT_THAT(service.listen(60s, "READY=1"), HasSubstr("READY=1"));
  EXPECT_THAT(service.listen(60s, "WATCHDOG=1"), HasSubstr("WATCHDOG=1"));
  EXPECT_THAT(service.listen(60s, "STATUS=live"), HasSubstr("STATUS=live, simulated"));
  run.send_signal(SIGTERM);
  EXPECT_THAT(service.listen(60s, "STOPPING=1"), HasSubstr("STOPPING=1"));
  EXPECT_EQ(run.wait().exit_status, 0);
}

TEST(Supervision, tells_each_step_of_the_start_and_asks_for_patience_until_volumes_come_steadily) {
  Service service;
  ProgramRun run{service.command()};
  const std::string told = service.listen(60s, "READY=1");
  for (const char* step : {"opening the display", "preparing the devices",
                           "measuring the reconstruction", "drawing the first picture"})
    EXPECT_THAT(told,
                HasSubstr(std::string{"EXTEND_TIMEOUT_USEC=120000000\nSTATUS=Starting: "} + step));
  EXPECT_THAT(told, HasSubstr("WATCHDOG_USEC=60000000"));
  EXPECT_THAT(service.listen(60s, "WATCHDOG_USEC="), HasSubstr("WATCHDOG_USEC=800000"))
      << "as the unit says";
  EXPECT_THAT(service.listen(60s, "WATCHDOG=1"), HasSubstr("WATCHDOG=1"));
}

TEST(Supervision, kicks_on_while_the_picture_says_truthfully_that_nothing_comes) {
  Service service;
  const auto script = service.folder().write(
      "faults.toml", "[[fault]]\ndevice = \"line_camera\"\nkind = \"unplug\"\nat_s = 0.0\n"
                     "duration_s = 100.0\n");
  ProgramRun run{service.command({"--faults", script})};
  EXPECT_THAT(service.listen(60s, "READY=1"), HasSubstr("READY=1"));
  for (int i = 0; i < 8; ++i) // more than two seconds
    EXPECT_THAT(service.listen(60s, "WATCHDOG=1"), HasSubstr("WATCHDOG=1")) << i;
}

TEST(Supervision, kicks_no_more_when_the_render_thread_hangs) {
  Service service;
  ProgramRun run{service.command()};
  ASSERT_THAT(service.listen(60s, "WATCHDOG=1"), HasSubstr("WATCHDOG=1"));
  {
    const Standstill main{run.process(), "octascope"};
    if (!main.stands())
      GTEST_SKIP() << "no thread can be stopped here: " << std::strerror(errno);
    service.listen(1s); // what was on its way
    EXPECT_THAT(service.listen(2s), testing::Not(HasSubstr("WATCHDOG=1")));
    EXPECT_GT(service.status().value("told_s_ago", 0.0), 1.5)
        << "and the status says how old it is";
  }
  EXPECT_THAT(service.listen(60s, "WATCHDOG=1"), HasSubstr("WATCHDOG=1"));
}

TEST(Supervision, names_a_thread_that_hangs_and_forgives_it) {
  Service service;
  ProgramRun run{service.command()};
  ASSERT_THAT(service.listen(60s, "READY=1"), HasSubstr("READY=1"));
  const auto hangs = [](const json& status) {
    return std::ranges::any_of(status.at("threads"), [](const json& thread) {
      return thread.at("name") == "camera" && thread.at("stuck") == true;
    });
  };
  {
    const Standstill camera{run.process(), "octa-camera"};
    if (!camera.stands())
      GTEST_SKIP() << "no thread can be stopped here: " << std::strerror(errno);
    const json status = service.await_status([&](const json& told) {
      return hangs(told) &&
             told.at("picture").at("notice") == "Line camera does not answer: its driver hangs";
    });
    EXPECT_FALSE(find_fault(status, "line_camera", "stuck_thread").is_null());
    EXPECT_THAT(service.listen(60s, "WATCHDOG=1"), HasSubstr("WATCHDOG=1"))
        << "no reason to restart";
  }
  const json status = service.await_status(
      [&](const json& s) { return !hangs(s) && s.at("picture").at("liveness") == "live"; });
  EXPECT_EQ(status.at("picture").at("liveness"), "live") << status;
}

TEST(Supervision, answers_with_all_that_is_known) {
  Service service;
  ProgramRun run{service.command()};
  const json status =
      service.await_status([](const json& s) { return s.at("picture").at("liveness") == "live"; });
  EXPECT_EQ(status.at("simulated"), true);
  EXPECT_THAT(status.at("configuration").get<std::string>(), HasSubstr("small.toml"));
  EXPECT_EQ(status.at("configuration_state"), "own");
  for (const char* device : {"camera", "trigger", "pedal", "display", "scope"})
    EXPECT_TRUE(status.at("devices").contains(device)) << device;
  EXPECT_EQ(status.at("calibration").at("verdict"), "same") << "the twin's own";
  EXPECT_GT(status.at("volumes").at("displayed"), 0);
  EXPECT_GT(status.at("resident_bytes"), 1 << 20);
  std::set<std::string> threads;
  for (const json& thread : status.at("threads"))
    threads.insert(thread.at("name"));
  EXPECT_THAT(threads, testing::IsSupersetOf({"camera", "volumes", "controls", "worker 0"}));

  const ProgramResult words = run_program(
      {"env", "RUNTIME_DIRECTORY=" + service.runtime().string(), built_program(), "status"});
  EXPECT_EQ(words.exit_status, 0) << words.describe();
  EXPECT_THAT(words.out,
              AllOf(HasSubstr("SIMULATED"), HasSubstr("of this camera"), HasSubstr("volumes/s")));
  EXPECT_THAT(whole_file(service.runtime() / "metrics.prom"),
              HasSubstr("octascope_uptime_seconds "));
}

TEST(Supervision, is_missed_with_words_that_help) {
  const ScratchFolder folder;
  const ProgramResult result = run_program(
      {"env", "RUNTIME_DIRECTORY=" + folder.path().string(), built_program(), "status"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, AllOf(HasSubstr("octascope status: "), HasSubstr("status.sock"),
                                HasSubstr("no appliance answers there")));
}

TEST(Supervision, writes_nothing_unasked) {
  const ScratchFolder folder;
  const bool runs = std::filesystem::exists("/run/octascope/status.sock"); // another one
  run_well(small_run(folder, {"--volumes", "2"}));
  EXPECT_EQ(folder.count(), 1) << "the configuration";
  EXPECT_EQ(std::filesystem::exists("/run/octascope/status.sock"), runs);
}

class Crash : public testing::TestWithParam<int> {};

TEST_P(Crash, leaves_a_report_and_the_next_run_tells_of_it) {
  Service service;
  {
    ProgramRun run{service.command()};
    service.await_status([](const json& s) { return s.at("picture").at("liveness") == "live"; });
    run.send_signal(GetParam());
    const ProgramResult result = run.wait();
    if (sanitized) // some signals the sanitizer ends by itself
      EXPECT_NE(result.exit_status, 0) << result.describe();
    else
      EXPECT_EQ(result.signal, GetParam()) << result.describe();
  }
  const auto reports = service.crash_reports();
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_THAT(reports[0].filename().string(),
              testing::MatchesRegex("crash-[0-9]{8}-[0-9]{6}\\.txt"));
  const std::string report = whole_file(reports[0]);
  EXPECT_THAT(report, HasSubstr("octascope "));
  EXPECT_THAT(report, HasSubstr("signal: " + std::to_string(GetParam())));
  EXPECT_THAT(report, HasSubstr("thread: oct")) << "whichever got the signal";
  EXPECT_THAT(report, HasSubstr("last status: live, simulated"));
  EXPECT_THAT(report, testing::ContainsRegex("0x[0-9a-f]+  [^ ]*/octascope\\+0x[0-9a-f]+"));
  EXPECT_THAT(report, HasSubstr("loop_volumes = 1")) << "the configuration's text";
  EXPECT_EQ(std::filesystem::status(reports[0]).permissions() &
                (std::filesystem::perms::group_all | std::filesystem::perms::others_all),
            std::filesystem::perms::none);

  ProgramRun next{service.command()};
  const json status =
      service.await_status([](const json& s) { return s.at("picture").at("notice") != ""; });
  EXPECT_THAT(status.at("picture").at("notice").get<std::string>(), HasSubstr("crashed"));
  const json fault = find_fault(status, "host", "restarted_after_crash");
  ASSERT_FALSE(fault.is_null());
  EXPECT_THAT(fault.at("message").get<std::string>(), HasSubstr(reports[0].string()));
  next.send_signal(SIGTERM);
  const ProgramResult ended = next.wait();
  EXPECT_EQ(ended.exit_status, 0) << ended.describe();
  EXPECT_THAT(ended.err, HasSubstr("restarted after a crash"));
}

INSTANTIATE_TEST_SUITE_P(Signals, Crash, testing::Values(SIGSEGV, SIGABRT, SIGFPE),
                         [](const auto& test) {
                           return test.param == SIGSEGV   ? "sigsegv"
                                  : test.param == SIGABRT ? "sigabrt"
                                                          : "sigfpe";
                         });

TEST(Crashes, leave_ten_reports_at_most) {
  Service service;
  std::filesystem::create_directory(service.state() / "crash");
  for (int i = 10; i < 30; ++i)
    std::ofstream{service.state() / "crash" / ("crash-202601" + std::to_string(i) + "-000000.txt")};
  std::ofstream{service.state() / "crash" / "notes.txt"};
  {
    ProgramRun run{service.command()};
    ASSERT_THAT(service.listen(60s, "READY=1"), HasSubstr("READY=1"));
    run.send_signal(SIGSEGV);
    run.wait();
  }
  EXPECT_EQ(service.crash_reports().size(), 11U) << "and what is not ours";
  EXPECT_FALSE(std::filesystem::exists(service.state() / "crash/crash-20260120-000000.txt"));
  EXPECT_TRUE(std::filesystem::exists(service.state() / "crash/crash-20260121-000000.txt"));
}

TEST(Crashes, are_told_of_when_the_program_was_killed) {
  Service service;
  {
    ProgramRun run{service.command()};
    ASSERT_THAT(service.listen(60s, "READY=1"), HasSubstr("READY=1"));
    run.send_signal(SIGKILL);
    run.wait();
  }
  ProgramRun next{service.command()};
  const json status =
      service.await_status([](const json& s) { return s.at("picture").at("notice") != ""; });
  EXPECT_THAT(find_fault(status, "host", "restarted_after_crash").at("message").get<std::string>(),
              HasSubstr("killed"));
}

} // namespace
} // namespace octascope::tests

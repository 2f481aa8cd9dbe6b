// The program as a user runs it: a child process with its words, its exit status and its time.
#pragma once

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <sys/types.h>

namespace octascope::tests {

using WallClock = std::chrono::steady_clock;

struct ProgramResult {
  int exit_status = -1;   // of a program that ended by itself
  int signal = 0;         // that ended it, 0 if none did
  bool timed_out = false; // it was killed after the time it had
  std::string out;        // stdout
  std::string err;        // stderr
  WallClock::duration took{};

  // For messages of failed tests.
  std::string describe() const;
};

// One run. The destructor kills what still runs.
class ProgramRun {
public:
  // `words` are the command line, the program first (looked up in PATH without a slash).
  explicit ProgramRun(std::vector<std::string> words);
  ~ProgramRun();
  ProgramRun(const ProgramRun&) = delete;
  ProgramRun& operator=(const ProgramRun&) = delete;

  void send_signal(int number) const;

  pid_t process() const { return child_; }

  bool running() const;

  // Waits until it has a thread of this name; false when it ends, and after `most`.
  bool wait_for_thread(const std::string& name, WallClock::duration most) const;

  // Waits for its end; kills it when that takes longer than `most` from now. Once.
  ProgramResult wait(WallClock::duration most = std::chrono::seconds{120});

private:
  pid_t child_ = -1;
  WallClock::time_point started_;
  std::string out_, err_;
  std::jthread read_out_, read_err_; // last: they fill the texts
};

// Runs to the end.
ProgramResult run_program(std::vector<std::string> words,
                          WallClock::duration most = std::chrono::seconds{120});

// octascope as it was built, with these arguments.
std::vector<std::string> octascope_command(std::vector<std::string> arguments);
ProgramResult run_octascope(std::vector<std::string> arguments,
                            WallClock::duration most = std::chrono::seconds{120});

// Can a program of this name be run here?
bool program_exists(const std::string& name);

#ifdef OCTASCOPE_SANITIZED
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

} // namespace octascope::tests

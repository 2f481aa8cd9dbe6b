// What a crash leaves: a report for whoever fixes it, and the trigger line at its safe level.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "hal/result.h"

namespace octascope::firmware_host {

inline std::filesystem::path crash_folder(const std::filesystem::path& state) {
  return state / "crash";
}

// crash-20261121-231500.txt in the folder, by UTC; at most this many are kept.
inline constexpr std::size_t most_crash_reports = 10;
std::vector<std::filesystem::path>
crash_reports(const std::filesystem::path& folder); // oldest first

// While it lives, SIGSEGV, SIGABRT (also the watchdog's), SIGBUS, SIGFPE and SIGILL write a report
// and then end the program as usual. Everything is prepared beforehand: the handler neither
// allocates nor locks. Signal handlers belong to the process, so make only one at a time.
//
// The report: version, time, signal, thread, where it was (module+offset, for addr2line -e), the
// last status, the configuration's file and text.
class CrashReport {
public:
  // The report goes to stderr, without the configuration.
  CrashReport();
  ~CrashReport();
  CrashReport(const CrashReport&) = delete;
  CrashReport& operator=(const CrashReport&) = delete;

  // From now on reports go into the folder, which is made if missing; the oldest surplus reports
  // are deleted. ErrorCode::denied: it cannot be made or written.
  hal::Result<> keep_in(const std::filesystem::path& folder);

  // Sets the configuration in use, with its text; an overlong one is cut.
  void set_configuration(std::string_view file, std::string_view text);

  // Sets the last status in the report, cut at 2000 bytes. One thread, as often as it likes.
  void set_status(std::string_view status);

  // Called last, with `context`; async-signal-safe. Null: nothing. Reset it before what it uses is
  // destroyed.
  using LastAct = void (*)(void* context);
  void set_last_act(LastAct act, void* context);

  // Gives the calling thread its own handler stack for its lifetime, so that a stack overflow is
  // reported, too.
  static void prepare_this_thread();
};

} // namespace octascope::firmware_host

// What a crash leaves behind: a report for whoever fixes it, and the trigger line at its safe
// level.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "hal/result.h"

namespace octascope::firmware_host {

inline std::filesystem::path crash_folder(const std::filesystem::path& state) {
  return state / "crash";
}

// crash-20261121-231500.txt in the folder, by UTC; so many are kept.
inline constexpr std::size_t most_crash_reports = 10;
std::vector<std::filesystem::path>
crash_reports(const std::filesystem::path& folder); // oldest first

// While it lives, SIGSEGV, SIGABRT (also the watchdog's), SIGBUS, SIGFPE and SIGILL write a report
// and then end the program as they would have without it. Everything is prepared beforehand: the
// handler allocates nothing and takes no lock. Signals are the process's: there is one at a time.
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

  // From now on it goes into the folder, which is made where it is missing; reports that are more
  // than are kept are deleted. ErrorCode::denied: it cannot be made or written.
  hal::Result<> keep_in(const std::filesystem::path& folder);

  // Which configuration is in use, with its text; what is too long is cut.
  void set_configuration(std::string_view file, std::string_view text);

  // What a report tells as the last status; one thread, as often as it likes; cut at 2000 bytes.
  void set_status(std::string_view status);

  // Called last, `context` with it; async-signal-safe. Null: nothing. The caller takes it back
  // before what it acts on goes.
  using LastAct = void (*)(void* context);
  void set_last_act(LastAct act, void* context);

  // Gives the calling thread a stack of its own for the handler, so that an overflow of its usual
  // one is reported, too; for as long as the thread lives.
  static void prepare_this_thread();
};

} // namespace octascope::firmware_host

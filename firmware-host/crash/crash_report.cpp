#include "firmware-host/crash/crash_report.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

#include <execinfo.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include "firmware-host/crash/module_map.h"
#include "firmware-host/crash/signal_text.h"
#include "firmware-host/version/version.h"

namespace octascope::firmware_host {

namespace fs = std::filesystem;

namespace {

constexpr std::array fatal_signals{SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL};
constexpr std::size_t alternate_stack_bytes = 64UL * 1024;
constexpr unsigned longest_report_s = 3; // a handler that hangs is ended by the alarm

template <std::size_t Bytes> struct Text {
  std::array<char, Bytes> bytes{};
  std::size_t size = 0;

  void set(std::string_view text) {
    size = std::min(text.size(), bytes.size());
    std::memcpy(bytes.data(), text.data(), size);
  }
  std::string_view view() const { return {bytes.data(), size}; }
};

// A handler has no argument but the signal: what it needs is the process's.
struct Prepared {
  std::atomic<bool> reporting{false};
  int folder = -1;
  std::array<struct sigaction, fatal_signals.size()> before{};
  Text<1024> configuration_file;
  Text<64UL * 1024> configuration;
  // The newest is complete; the other is being written. A crash in the very moment of the exchange
  // of two statuses a second apart would find a mixture, which does no harm.
  std::array<Text<2000>, 2> status;
  std::atomic<unsigned> newest_status{0};
  std::atomic<CrashReport::LastAct> last_act{nullptr};
  std::atomic<void*> last_act_context{nullptr};
  ModuleMap modules;
  std::array<void*, 64> frames{};
};

Prepared& prepared() {
  static constinit Prepared value;
  return value;
}

std::string_view name_of(int signal) {
  switch (signal) {
  case SIGSEGV: return "SIGSEGV, a forbidden memory access";
  case SIGABRT: return "SIGABRT: the program gave up, or its watchdog did";
  case SIGBUS: return "SIGBUS, memory that is gone";
  case SIGFPE: return "SIGFPE, an impossible calculation";
  case SIGILL: return "SIGILL, an unknown instruction";
  default: return "unknown";
  }
}

std::uint64_t place_of(const void* context) {
#if defined(__x86_64__)
  const auto* const machine = static_cast<const ucontext_t*>(context);
  return static_cast<std::uint64_t>(machine->uc_mcontext.gregs[REG_RIP]);
#elif defined(__aarch64__)
  return static_cast<const ucontext_t*>(context)->uc_mcontext.pc;
#else
  static_cast<void>(context);
  return 0;
#endif
}

void write_place(SignalText& out, std::uint64_t address) {
  const ModuleMap::Place place = prepared().modules.find(address);
  out.text("  ").hex(address).text("  ");
  if (place.module.empty())
    out.text("?");
  else
    out.text(place.module).text("+").hex(place.offset);
  out.text("\n");
}

void write_report(int descriptor, int signal, const siginfo_t* info, const void* context,
                  std::time_t now) {
  Prepared& p = prepared();
  std::array<char, 16> thread{};
  ::prctl(PR_GET_NAME, thread.data());
  SignalText out{descriptor};
  out.text("octascope ").text(version()).text(" crashed\ntime: ").time(now).text(" UTC\nsignal: ");
  out.number(static_cast<std::uint64_t>(signal)).text(" (").text(name_of(signal)).text(")");
  if (info->si_code <= 0) // by kill(2) and the like
    out.text(", sent by process ").number(static_cast<std::uint64_t>(info->si_pid));
  else if (signal == SIGSEGV || signal == SIGBUS)
    out.text(" at address ").hex(reinterpret_cast<std::uint64_t>(info->si_addr));
  out.text("\nthread: ").text({thread.data(), ::strnlen(thread.data(), thread.size())});
  out.text("\nlast status: ").text(p.status[p.newest_status.load()].view());
  out.text("\nstack (addr2line -Cfie MODULE OFFSET names a place):\n");
  out.flush(); // whatever happens from here on
  p.modules.read();
  write_place(out, place_of(context));
  const int frames = ::backtrace(p.frames.data(), static_cast<int>(p.frames.size()));
  for (int i = 0; i < frames; ++i)
    write_place(out, reinterpret_cast<std::uint64_t>(p.frames[static_cast<std::size_t>(i)]));
  if (p.folder < 0)
    return;
  out.text("configuration: ")
      .text(p.configuration_file.size > 0 ? p.configuration_file.view() : "none, the defaults")
      .text("\n");
  out.text(p.configuration.view());
}

int open_report(std::time_t now) {
  SignalText name;
  name.text("crash-").time(now).text(".txt").text({"", 1}); // with the end that C wants
  if (prepared().folder < 0)
    return -1;
  return ::openat(prepared().folder, name.gathered().data(),
                  O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
}

void end_as_before(int signal) {
  const auto* const known = std::ranges::find(fatal_signals, signal);
  const auto index = static_cast<std::size_t>(known - fatal_signals.begin());
  ::sigaction(signal, &prepared().before[index], nullptr);
  // It is blocked in here and comes when this returns.
  ::syscall(SYS_tgkill, ::getpid(), ::syscall(SYS_gettid), signal);
}

void on_fatal_signal(int signal, siginfo_t* info, void* context) {
  Prepared& p = prepared();
  if (p.reporting.exchange(true)) { // another thread's crash is being written: it ends us
    while (true)
      ::pause();
  }
  ::alarm(longest_report_s);
  // First of all: whatever else fails.
  if (const auto act = p.last_act.load())
    act(p.last_act_context.load());
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  if (const int file = open_report(now.tv_sec); file >= 0) {
    write_report(file, signal, info, context, now.tv_sec);
    ::fsync(file);
    ::close(file);
  } else {
    write_report(STDERR_FILENO, signal, info, context, now.tv_sec);
  }
  end_as_before(signal);
}

// Owns a thread's stack for signals.
class AlternateStack {
public:
  AlternateStack() {
    stack_t there{};
    if (::sigaltstack(nullptr, &there) != 0 || (there.ss_flags & SS_DISABLE) == 0)
      return; // somebody else's, as in a sanitized build
    memory_ = ::mmap(nullptr, alternate_stack_bytes, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory_ == MAP_FAILED)
      return;
    stack_t stack{};
    stack.ss_sp = memory_;
    stack.ss_size = alternate_stack_bytes;
    ::sigaltstack(&stack, nullptr);
  }
  ~AlternateStack() {
    if (memory_ == MAP_FAILED)
      return;
    stack_t none{};
    none.ss_flags = SS_DISABLE;
    ::sigaltstack(&none, nullptr);
    ::munmap(memory_, alternate_stack_bytes);
  }
  AlternateStack(const AlternateStack&) = delete;
  AlternateStack& operator=(const AlternateStack&) = delete;

private:
  void* memory_ = MAP_FAILED;
};

} // namespace

std::vector<fs::path> crash_reports(const fs::path& folder) {
  std::vector<fs::path> reports;
  std::error_code error;
  for (fs::directory_iterator it{folder, error}, end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with("crash-") && name.ends_with(".txt"))
      reports.push_back(it->path());
  }
  std::ranges::sort(reports); // their names are their times
  return reports;
}

CrashReport::CrashReport() {
  Prepared& p = prepared();
  // The first backtrace loads a library, which must not be done in a handler.
  ::backtrace(p.frames.data(), 1);
  prepare_this_thread();
  struct sigaction action {};
  action.sa_sigaction = on_fatal_signal;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  for (const int signal : fatal_signals)
    sigaddset(&action.sa_mask, signal);
  for (std::size_t i = 0; i < fatal_signals.size(); ++i)
    ::sigaction(fatal_signals[i], &action, &p.before[i]);
}

hal::Result<> CrashReport::keep_in(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 || ::access(folder.c_str(), W_OK) != 0) {
    const int number = errno;
    if (descriptor >= 0)
      ::close(descriptor);
    return hal::fail(
        hal::ErrorCode::denied,
        "{}: reports of crashes cannot be written ({}); expected a folder that this user may write",
        folder.string(), std::generic_category().message(number));
  }
  prepared().folder = descriptor;
  const std::vector<fs::path> reports = crash_reports(folder);
  for (std::size_t i = 0; i + most_crash_reports < reports.size() + 1; ++i) // room for one more
    fs::remove(reports[i], error);
  return {};
}

CrashReport::~CrashReport() {
  Prepared& p = prepared();
  for (std::size_t i = 0; i < fatal_signals.size(); ++i)
    ::sigaction(fatal_signals[i], &p.before[i], nullptr);
  p.last_act.store(nullptr);
  if (p.folder >= 0)
    ::close(std::exchange(p.folder, -1));
  p.configuration_file.set("");
  p.configuration.set("");
  p.status = {};
}

void CrashReport::set_configuration(std::string_view file, std::string_view text) {
  prepared().configuration_file.set(file);
  prepared().configuration.set(text);
}

void CrashReport::set_status(std::string_view status) {
  Prepared& p = prepared();
  const unsigned other = 1 - p.newest_status.load();
  p.status[other].set(status);
  p.newest_status.store(other);
}

void CrashReport::set_last_act(LastAct act, void* context) {
  prepared().last_act.store(nullptr);
  prepared().last_act_context.store(context);
  prepared().last_act.store(act);
}

void CrashReport::prepare_this_thread() {
  thread_local const AlternateStack stack;
  static_cast<void>(stack);
}

} // namespace octascope::firmware_host

#include "tests/virtual_hardware/support/syscall_faults.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/virtual_hardware/support/call_site.h"

namespace octascope::tests {

namespace {

// The C library's functions have no place for a context: this is the process's, as they are.
std::atomic<unsigned> armed_kinds{0};
std::atomic<unsigned> counted{0};
std::atomic<unsigned> counted_at_site{0};
std::atomic<bool> hit{false};
std::atomic<bool> notes_sites{false};
std::atomic<unsigned long> spared_request{0};
std::optional<SyscallFault> fault_now; // changes only while none is alive

std::mutex noted_guard;
std::vector<SeenSite> noted;

// A call as it comes in.
struct Call {
  CallKind kind;
  const void* caller; // the address that it returns to
  unsigned long request = 0;
};

// Not inlined: its address is where the stack of a site ends.
[[gnu::noinline]] std::optional<std::string>
run_scenario(const std::function<std::optional<std::string>()>& scenario) {
  auto wrong = scenario();
  asm volatile(""); // no tail call, which would take this function off the stack
  return wrong;
}

std::string_view name_of(CallKind kind) {
  switch (kind) {
  case CallKind::open: return "open";
  case CallKind::close: return "close";
  case CallKind::control: return "ioctl";
  case CallKind::poll: return "poll";
  case CallKind::read: return "read";
  case CallKind::write: return "write";
  case CallKind::map: return "mmap";
  case CallKind::receive: return "recv";
  }
  return "";
}

void note(const CallSite& site, const CallStack& stack) {
  constexpr std::size_t told_callers = 12;
  const std::lock_guard lock{noted_guard};
  const auto known = std::ranges::find(noted, site, &SeenSite::site);
  if (known != noted.end()) {
    ++known->calls;
    return;
  }
  const std::string request = site.request != 0 ? fmt::format(" {:x}", site.request) : "";
  noted.push_back(
      {site, fmt::format("{}{}: {}", name_of(site.kind), request, stack.names(told_callers)), 1});
}

// Whether it is the fault's; notes it where sites are noted.
bool is_at_site(const Call& call) {
  const bool may_be = fault_now && fault_now->site && fault_now->site->kind == call.kind &&
                      fault_now->site->request == call.request;
  if (!may_be && !notes_sites.load(std::memory_order_relaxed))
    return false; // the stack need not be looked at
  const CallStack stack =
      CallStack::from(call.caller, reinterpret_cast<const void*>(&run_scenario));
  const CallSite site{call.kind, call.request, stack.hash()};
  if (notes_sites.load(std::memory_order_relaxed))
    note(site, stack);
  return may_be && fault_now->site == site;
}

// True when this very call is the one; `error` is then what it is to fail with.
bool is_hit(const Call& call, int& error) {
  if ((armed_kinds.load(std::memory_order_acquire) & static_cast<unsigned>(call.kind)) == 0)
    return false;
  if (call.kind == CallKind::control && call.request == spared_request.load())
    return false;
  unsigned number = counted.fetch_add(1, std::memory_order_relaxed);
  const bool by_site = fault_now && fault_now->site;
  if (by_site || notes_sites.load(std::memory_order_relaxed)) {
    const int errno_before = errno;
    const bool at_site = !hit.load(std::memory_order_relaxed) && is_at_site(call);
    errno = errno_before;
    if (by_site && !at_site)
      return false;
    if (by_site)
      number = counted_at_site.fetch_add(1, std::memory_order_relaxed);
  }
  if (!fault_now || number != fault_now->call)
    return false;
  error = fault_now->error;
  hit.store(true, std::memory_order_relaxed);
  return true;
}

bool fails(const Call& call) {
  int error = 0;
  if (!is_hit(call, error) || error == 0)
    return false;
  errno = error;
  return true;
}

// How much of `count` bytes a read or write may do; −1: it fails.
ssize_t allowed(const Call& call, int descriptor, std::size_t count) {
  int error = 0;
  if (descriptor <= STDERR_FILENO || !is_hit(call, error))
    return static_cast<ssize_t>(count);
  if (error == 0)
    return static_cast<ssize_t>((count + 1) / 2);
  errno = error;
  return -1;
}

template <class Function> Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

} // namespace

SyscallFaultInjector::SyscallFaultInjector(unsigned kinds, std::optional<SyscallFault> fault,
                                           Notes notes) {
  counted = 0;
  counted_at_site = 0;
  hit = false;
  fault_now = fault;
  notes_sites = notes == Notes::sites;
  noted.clear();
  armed_kinds.store(kinds, std::memory_order_release);
}

SyscallFaultInjector::~SyscallFaultInjector() {
  armed_kinds = 0;
}

unsigned SyscallFaultInjector::calls() const {
  return counted;
}

bool SyscallFaultInjector::has_hit() const {
  return hit;
}

std::vector<SeenSite> SyscallFaultInjector::sites() const {
  const std::lock_guard lock{noted_guard};
  return noted;
}

std::optional<std::string>
SyscallFaultInjector::run(const std::function<std::optional<std::string>()>& scenario) const {
  return run_scenario(scenario);
}

Holdings Holdings::now() {
  Holdings holdings;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator{"/proc/self/fd"})
    ++holdings.descriptors;
  std::ifstream maps{"/proc/self/maps"};
  for (std::string line; std::getline(maps, line);) {
    // Libraries that are loaded late stay; the heap and the stacks come and go.
    const std::size_t path = line.find('/');
    if (path != std::string::npos && line.find(".so", path) == std::string::npos)
      ++holdings.mappings;
  }
  return holdings;
}

SyscallFaultReport inject_faults(unsigned kinds, std::span<const int> errors,
                                 const std::function<std::optional<std::string>()>& scenario,
                                 bool check_recovery, unsigned long spared) {
  SyscallFaultReport report;
  spared_request = spared;
  const auto run = [&](std::optional<SyscallFault> fault) {
    const Holdings before = Holdings::now();
    std::optional<std::string> wrong;
    {
      const SyscallFaultInjector injector{kinds, fault};
      wrong = scenario();
      if (!fault)
        report.calls = std::max(report.calls, injector.calls());
    }
    ++report.runs;
    const Holdings after = Holdings::now();
    if (!wrong && !(after == before))
      wrong = fmt::format("{} descriptors and {} mappings before, {} and {} after",
                          before.descriptors, before.mappings, after.descriptors, after.mappings);
    if (wrong)
      report.complaints.push_back(
          fault
              ? fmt::format("call {} with {}: {}", fault->call,
                            fault->error != 0 ? std::strerror(fault->error) : "half of it", *wrong)
              : fmt::format("unharmed: {}", *wrong));
  };
  run({}); // what is made once in a process, is made now
  report.complaints.clear();
  run({});
  unsigned faults = 0;
  for (unsigned call = 0; call < report.calls; ++call)
    for (const int error : errors) {
      if (!is_injected(faults++))
        continue;
      run(SyscallFault{call, error});
      if (check_recovery)
        run({});
    }
  spared_request = 0;
  return report;
}

void expect_good(const SyscallFaultReport& report, unsigned least_calls) {
  std::printf("  %u calls, %u runs\n", report.calls, report.runs);
  EXPECT_GE(report.calls, least_calls);
  for (const std::string& complaint : report.complaints)
    ADD_FAILURE() << complaint;
}

bool is_injected(unsigned fault) {
  const auto wanted = [](const char* name, unsigned otherwise) {
    const char* const text = std::getenv(name);
    return text == nullptr ? otherwise : static_cast<unsigned>(std::atoi(text));
  };
  const unsigned every = std::max(1U, wanted("OCTASCOPE_FAULT_EVERY", 1));
  return fault % every == wanted("OCTASCOPE_FAULT_FIRST", 0) % every;
}

std::span<const int> usual_errors() {
  static constexpr int errors[]{EINTR, EAGAIN, EBUSY, EIO, ENODEV, ENOMEM, 0};
  return errors;
}

} // namespace octascope::tests

// ---- what stands before the C library ----

using octascope::tests::allowed;
using octascope::tests::Call;
using octascope::tests::CallKind;
using octascope::tests::fails;
using octascope::tests::next;

namespace {

using OpenFunction = int(const char*, int, ...);
using OpenAtFunction = int(int, const char*, int, ...);
using MapFunction = void*(void*, std::size_t, int, int, int, off_t);

mode_t mode_of(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : mode_t{0};
}

} // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return fails({CallKind::open, __builtin_return_address(0)})
             ? -1
             : next<OpenFunction>("open")(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return fails({CallKind::open, __builtin_return_address(0)})
             ? -1
             : next<OpenAtFunction>("openat")(folder, path, flags, mode);
}

int close(int descriptor) {
  const bool hit =
      descriptor > STDERR_FILENO && fails({CallKind::close, __builtin_return_address(0)});
  const int error = errno;
  const int result = next<int(int)>("close")(descriptor);
  if (!hit)
    return result;
  errno = error;
  return -1;
}

int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (fails({CallKind::control, __builtin_return_address(0), request}))
    return -1;
  return next<int(int, unsigned long, ...)>("ioctl")(descriptor, request, argument);
}

int poll(pollfd* files, nfds_t count, int timeout) {
  return fails({CallKind::poll, __builtin_return_address(0)})
             ? -1
             : next<int(pollfd*, nfds_t, int)>("poll")(files, count, timeout);
}

int ppoll(pollfd* files, nfds_t count, const timespec* timeout, const sigset_t* mask) {
  return fails({CallKind::poll, __builtin_return_address(0)})
             ? -1
             : next<int(pollfd*, nfds_t, const timespec*, const sigset_t*)>("ppoll")(files, count,
                                                                                     timeout, mask);
}

ssize_t read(int descriptor, void* bytes, std::size_t count) {
  const ssize_t most = allowed({CallKind::read, __builtin_return_address(0)}, descriptor, count);
  return most < 0 ? -1
                  : next<ssize_t(int, void*, std::size_t)>("read")(descriptor, bytes,
                                                                   static_cast<std::size_t>(most));
}

ssize_t write(int descriptor, const void* bytes, std::size_t count) {
  const ssize_t most = allowed({CallKind::write, __builtin_return_address(0)}, descriptor, count);
  return most < 0 ? -1
                  : next<ssize_t(int, const void*, std::size_t)>("write")(
                        descriptor, bytes, static_cast<std::size_t>(most));
}

ssize_t recv(int socket, void* bytes, std::size_t count, int flags) {
  return fails({CallKind::receive, __builtin_return_address(0)})
             ? -1
             : next<ssize_t(int, void*, std::size_t, int)>("recv")(socket, bytes, count, flags);
}

ssize_t recvmsg(int socket, msghdr* message, int flags) {
  return fails({CallKind::receive, __builtin_return_address(0)})
             ? -1
             : next<ssize_t(int, msghdr*, int)>("recvmsg")(socket, message, flags);
}

void* mmap(void* address, std::size_t length, int protection, int flags, int descriptor,
           off_t offset) noexcept {
  if (descriptor >= 0 && fails({CallKind::map, __builtin_return_address(0)}))
    return MAP_FAILED;
  return next<MapFunction>("mmap")(address, length, protection, flags, descriptor, offset);
}

// Where offsets have 64 bits anyway, both names are one function.
int open64(const char* path, int flags, ...) __attribute__((alias("open")));
int openat64(int folder, const char* path, int flags, ...) __attribute__((alias("openat")));
void* mmap64(void* address, std::size_t length, int protection, int flags, int descriptor,
             off_t offset) noexcept __attribute__((alias("mmap")));

} // extern "C"

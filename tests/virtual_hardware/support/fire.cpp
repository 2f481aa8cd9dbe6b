#include "tests/virtual_hardware/support/fire.h"

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace octascope::tests {

namespace {

// The C library's functions have no place for a context: this is the process's, as they are.
std::atomic<unsigned> armed_kinds{0};
std::atomic<unsigned> counted{0};
std::atomic<bool> has_shot{false};
std::atomic<unsigned> shot_call{0};
std::atomic<int> shot_error{0};

// True when this very call is the one; `error` is then what it is to fail with.
bool is_hit(CallKind kind, int& error) {
  if ((armed_kinds.load(std::memory_order_relaxed) & static_cast<unsigned>(kind)) == 0)
    return false;
  const unsigned number = counted.fetch_add(1, std::memory_order_relaxed);
  if (!has_shot.load(std::memory_order_relaxed) || number != shot_call.load())
    return false;
  error = shot_error.load();
  return true;
}

bool fails(CallKind kind) {
  int error = 0;
  if (!is_hit(kind, error) || error == 0)
    return false;
  errno = error;
  return true;
}

// How much of `count` bytes a read or write may do; −1: it fails.
ssize_t allowed(CallKind kind, int descriptor, std::size_t count) {
  int error = 0;
  if (descriptor <= STDERR_FILENO || !is_hit(kind, error))
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

Firing::Firing(unsigned kinds, std::optional<Shot> shot) {
  counted = 0;
  has_shot = shot.has_value();
  shot_call = shot ? shot->call : 0;
  shot_error = shot ? shot->error : 0;
  armed_kinds = kinds;
}

Firing::~Firing() {
  armed_kinds = 0;
}

unsigned Firing::calls() const {
  return counted;
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

FireReport under_fire(unsigned kinds, std::span<const int> errors,
                      const std::function<std::optional<std::string>()>& scenario,
                      bool check_recovery) {
  FireReport report;
  const auto run = [&](std::optional<Shot> shot) {
    const Holdings before = Holdings::now();
    std::optional<std::string> wrong;
    {
      const Firing firing{kinds, shot};
      wrong = scenario();
      if (!shot)
        report.calls = std::max(report.calls, firing.calls());
    }
    ++report.runs;
    const Holdings after = Holdings::now();
    if (!wrong && !(after == before))
      wrong = fmt::format("{} descriptors and {} mappings before, {} and {} after",
                          before.descriptors, before.mappings, after.descriptors, after.mappings);
    if (wrong)
      report.complaints.push_back(
          shot ? fmt::format("call {} with {}: {}", shot->call,
                             shot->error != 0 ? std::strerror(shot->error) : "half of it", *wrong)
               : fmt::format("unharmed: {}", *wrong));
  };
  run({}); // what is made once in a process, is made now
  report.complaints.clear();
  run({});
  for (unsigned call = 0; call < report.calls; ++call)
    for (const int error : errors) {
      run(Shot{call, error});
      if (check_recovery)
        run({});
    }
  return report;
}

std::span<const int> usual_errors() {
  static constexpr int errors[]{EINTR, EAGAIN, EBUSY, EIO, ENODEV, ENOMEM, 0};
  return errors;
}

} // namespace octascope::tests

// ---- what stands before the C library ----

using octascope::tests::allowed;
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

void* map_unless_hit(const char* name, void* address, std::size_t length, int protection, int flags,
                     int descriptor, off_t offset) {
  if (descriptor >= 0 && fails(CallKind::map))
    return MAP_FAILED;
  return next<MapFunction>(name)(address, length, protection, flags, descriptor, offset);
}

} // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return fails(CallKind::open) ? -1 : next<OpenFunction>("open")(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return fails(CallKind::open) ? -1 : next<OpenFunction>("open64")(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return fails(CallKind::open) ? -1 : next<OpenAtFunction>("openat")(folder, path, flags, mode);
}

int close(int descriptor) {
  const bool hit = descriptor > STDERR_FILENO && fails(CallKind::close);
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
  if (fails(CallKind::control))
    return -1;
  return next<int(int, unsigned long, ...)>("ioctl")(descriptor, request, argument);
}

int poll(pollfd* files, nfds_t count, int timeout) {
  return fails(CallKind::poll) ? -1
                               : next<int(pollfd*, nfds_t, int)>("poll")(files, count, timeout);
}

int ppoll(pollfd* files, nfds_t count, const timespec* timeout, const sigset_t* mask) {
  return fails(CallKind::poll) ? -1
                               : next<int(pollfd*, nfds_t, const timespec*, const sigset_t*)>(
                                     "ppoll")(files, count, timeout, mask);
}

ssize_t read(int descriptor, void* bytes, std::size_t count) {
  const ssize_t most = allowed(CallKind::read, descriptor, count);
  return most < 0 ? -1
                  : next<ssize_t(int, void*, std::size_t)>("read")(descriptor, bytes,
                                                                   static_cast<std::size_t>(most));
}

ssize_t write(int descriptor, const void* bytes, std::size_t count) {
  const ssize_t most = allowed(CallKind::write, descriptor, count);
  return most < 0 ? -1
                  : next<ssize_t(int, const void*, std::size_t)>("write")(
                        descriptor, bytes, static_cast<std::size_t>(most));
}

void* mmap(void* address, std::size_t length, int protection, int flags, int descriptor,
           off_t offset) noexcept {
  return map_unless_hit("mmap", address, length, protection, flags, descriptor, offset);
}

void* mmap64(void* address, std::size_t length, int protection, int flags, int descriptor,
             off_t offset) noexcept {
  return map_unless_hit("mmap64", address, length, protection, flags, descriptor, offset);
}

} // extern "C"

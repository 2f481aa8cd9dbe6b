// System calls that are made to fail: the calls of the program and of its libraries, counted, and
// one of them made to fail.
//
// Linked into a program, syscall_faults.cpp stands before the C library's open, close, ioctl, poll,
// read, write, mmap and recv: whoever calls them, our backends or libdrm, libgpiod, libudev and
// libcamera below them, comes through it. Nothing is changed unless a SyscallFaultInjector is
// alive.
//
// Where a scenario has so many calls that hitting each takes too long, each *site* is hit
// (site_sweep.h): calls that the same functions make, one within the other from the scenario down,
// are one site, as those of a loop.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octascope::tests {

enum class CallKind : unsigned {
  open = 1, // open, openat
  close = 2,
  control = 4, // ioctl
  poll = 8,    // poll, ppoll
  read = 16,
  write = 32,
  map = 64,      // mmap of a file; memory of no file is left alone
  receive = 128, // recv, recvmsg: udev's events
};

inline constexpr unsigned every_kind = 255;

struct CallSite {
  CallKind kind = CallKind::open;
  unsigned long request = 0; // ioctl's
  std::uint64_t callers = 0; // CallStack::hash()
  auto operator<=>(const CallSite&) const = default;
};

struct SyscallFault {
  unsigned call = 0; // which of the counted calls, from 0
  int error = 0;     // errno it fails with; 0: read() and write() do half, all else is let through
  std::optional<CallSite> site = {}; // then `call` counts its calls alone
};

// A site that was seen, by the names of its callers.
struct SeenSite {
  CallSite site;
  std::string name; // "ioctl c0406469: libdrm.so.2 drmIoctl < …"
  unsigned calls = 0;
};

// One at a time in a process, for as long as it lives; calls of every thread count. close() that is
// hit closes all the same, as Linux does.
class SyscallFaultInjector {
public:
  enum class Notes { none, sites };
  explicit SyscallFaultInjector(unsigned kinds, std::optional<SyscallFault> fault = {},
                                Notes notes = Notes::none);
  SyscallFaultInjector(const SyscallFaultInjector&) = delete;
  SyscallFaultInjector& operator=(const SyscallFaultInjector&) = delete;
  ~SyscallFaultInjector();

  unsigned calls() const; // counted so far
  bool has_hit() const;
  std::vector<SeenSite> sites() const; // with Notes::sites; as they were first seen

  // Runs it so that a site is the same whoever runs the scenario.
  std::optional<std::string> run(const std::function<std::optional<std::string>()>& scenario) const;
};

// What a process holds of the system.
struct Holdings {
  int descriptors = 0;
  int mappings = 0; // of files and devices
  static Holdings now();
  bool operator==(const Holdings&) const = default;
};

struct SyscallFaultReport {
  unsigned calls = 0; // of one run that nothing hit
  unsigned runs = 0;
  std::vector<std::string> complaints; // call, error, and what is wrong
};

// Runs `scenario` unharmed, then once for each of its calls and each of `errors`. The scenario
// says what is wrong with how it ended (nothing: success or a clean Error), and must give back all
// that it took; after each hit it is run unharmed once more when `check_recovery`. An ioctl with
// the request `spared` is neither counted nor hit: a library is known to die where it fails.
SyscallFaultReport inject_faults(unsigned kinds, std::span<const int> errors,
                                 const std::function<std::optional<std::string>()>& scenario,
                                 bool check_recovery = true, unsigned long spared = 0);

// Prints it; a failed test for each complaint, and where there were fewer calls.
void expect_good(const SyscallFaultReport& report, unsigned least_calls);

// Is the fault of this number, from 0, injected? All are, unless OCTASCOPE_FAULT_EVERY is more than 1:
// then every so many-th, from number OCTASCOPE_FAULT_FIRST on.
bool is_injected(unsigned fault);

// EINTR, EAGAIN, EBUSY, EIO, ENODEV, ENOMEM, and half reads and writes.
std::span<const int> usual_errors();

} // namespace octascope::tests

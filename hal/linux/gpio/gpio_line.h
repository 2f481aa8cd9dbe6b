// One GPIO line, held exclusively under the consumer name "octascope", and the description of a
// GPIO chip. Wraps the two incompatible APIs of libgpiod: gpio_line_v1.cpp (1.4 … 1.6) and
// gpio_line_v2.cpp (2.x). CMake chooses the matching one; the virtual bench tests both.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

inline constexpr const char* gpio_consumer = "octascope";

struct GpioLineInfo {
  unsigned offset = 0;
  std::string name;     // given by device tree, firmware or driver; often empty
  std::string consumer; // the holder, if it is used
  bool used = false;    // by the kernel or by another program
};

struct GpioChipInfo {
  std::string node; // "/dev/gpiochip0"
  std::string label;
  std::vector<GpioLineInfo> lines;
};

// ErrorCode::denied, absent …: why the chip cannot be queried.
Result<GpioChipInfo> describe_gpio_chip(const std::string& node);

// Threads: set() from one thread at a time and from a signal handler; everything else from one
// thread.
class GpioLine {
public:
  // Acquires an output at low level. `node` is the chip's, such as "/dev/gpiochip0".
  static Result<GpioLine> output(const std::string& node, unsigned offset);
  // Acquires an input that detects rising edges.
  static Result<GpioLine> rising_edges(const std::string& node, unsigned offset);

  GpioLine(GpioLine&&) noexcept;
  GpioLine& operator=(GpioLine&&) noexcept;
  ~GpioLine(); // releases the line; its level then depends on the chip's driver

  // Returns 0 or errno. One system call, no allocation, no lock: async-signal-safe.
  int set(bool high) noexcept;

  // Reads at most edges.size() pending rising edges, oldest first, without waiting. Returns their
  // number, or −errno. The times are of CLOCK_MONOTONIC. Does not allocate.
  int read_edges(std::span<TimePoint> edges) noexcept;

  // The number of unread edges that the kernel keeps. On overflow, libgpiod 1.x loses the newest,
  // 2.x the oldest.
  static constexpr std::size_t kernel_buffer = 16;

private:
  struct Handle;
  explicit GpioLine(std::unique_ptr<Handle> handle);
  std::unique_ptr<Handle> handle_;
};

} // namespace octascope::hal::linux_backend

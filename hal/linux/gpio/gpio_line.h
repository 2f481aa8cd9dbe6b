// One GPIO line, held exclusively under the consumer name "octascope", and what chips and lines
// there are. The narrow part of libgpiod that octascope needs, in front of its two incompatible
// APIs: gpio_line_v1.cpp (1.4 … 1.6) and gpio_line_v2.cpp (2.x); CMake takes the one that fits, the
// bench of virtual hardware runs both.
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
  std::string consumer; // who holds it, where it is used
  bool used = false;    // by the kernel or by another program
};

struct GpioChipInfo {
  std::string node; // "/dev/gpiochip0"
  std::string label;
  std::vector<GpioLineInfo> lines;
};

// ErrorCode::denied, absent …: why the chip cannot be asked.
Result<GpioChipInfo> describe_gpio_chip(const std::string& node);

// Threads: set() from one thread at a time, and from a signal handler; the rest from one thread.
class GpioLine {
public:
  // As an output at low level. `node` is the chip's, as "/dev/gpiochip0".
  static Result<GpioLine> output(const std::string& node, unsigned offset);
  // As an input whose rising edges are told.
  static Result<GpioLine> rising_edges(const std::string& node, unsigned offset);

  GpioLine(GpioLine&&) noexcept;
  GpioLine& operator=(GpioLine&&) noexcept;
  ~GpioLine(); // releases the line; its level is then up to the chip's driver

  // 0, or errno. One system call, no allocation, no lock: async-signal-safe.
  int set(bool high) noexcept;

  // The rising edges that have not been read yet, oldest first, at most edges.size() of them; does
  // not wait. Their number, or −errno. No allocation. The times are of CLOCK_MONOTONIC.
  int read_edges(std::span<TimePoint> edges) noexcept;

  // The kernel keeps so many edges. What is lost of more until they are read: the newest with
  // libgpiod 1.x, the oldest with 2.x.
  static constexpr std::size_t kernel_buffer = 16;

private:
  struct Handle;
  explicit GpioLine(std::unique_ptr<Handle> handle);
  std::unique_ptr<Handle> handle_;
};

} // namespace octascope::hal::linux_backend

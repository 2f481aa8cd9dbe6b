// The galvo trigger on a GPIO line, using libgpiod.
//
// Safe level. The line is driven low when it is acquired and before it is released. The level of a
// released line depends on the chip's driver: most leave it as it is or make it an input, so the
// wiring needs a pull-down resistor at the scanner. The same holds if the process ends during a
// pulse: call make_safe() from the handlers of fatal signals. After SIGKILL nothing can be done;
// the line goes low when the program next acquires it.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/galvo_trigger.h"
#include "hal/linux/gpio/gpio_line.h"
#include "hal/linux/gpio/pulse_timer.h"
#include "hal/linux/gpio/sync_ledger.h"

namespace octascope::hal::linux_backend {

inline constexpr const char* default_trigger_line = "octascope-trigger";

struct GpioTriggerSettings {
  std::string line = default_trigger_line; // a line's name, or "gpiochip0:17"
  std::string sync_line = {};              // the scanner's answer; empty: not connected
  int sync_edges_per_pulse = 1;            // 1 to 16, the kernel's buffer
};

struct GpioTriggerCounters {
  std::uint64_t pulses = 0; // all counts are since construction
  std::uint64_t sync_edges = 0;
  std::uint64_t missed_edges = 0;     // expected but not seen; updated at the next pulse
  std::uint64_t unexpected_edges = 0; // noise on the sync line, or a second source
  bool sync_works = false;            // a sync line is configured and can be read
  Duration sync_delay{};              // from the last answered pulse to its first edge; 0: none
  TimePoint last_sync_edge{};         // comparable with the camera's times; 0: none
};

// Threads: as hal::GalvoTrigger; counters() and make_safe() from any thread. While the device is
// open with pulses longer than `longest_wait`, a thread of this class ends them.
class GpioGalvoTrigger final : public GalvoTrigger {
public:
  // pulse() waits for the end of pulses up to this width; longer ones end after it has returned.
  static constexpr Duration longest_wait = std::chrono::microseconds{200};

  // `clock` is borrowed, must outlive the trigger and must run on CLOCK_MONOTONIC.
  explicit GpioGalvoTrigger(Clock& clock, GpioTriggerSettings settings = {});
  ~GpioGalvoTrigger() override;

  GpioTriggerCounters counters() const;

  // Drives the line low in any state; pulse() still works afterwards. Async-signal-safe.
  void make_safe() noexcept;

private:
  // The first thread to change `high` to `falling` drives the line low and then stores `low`.
  enum class Level : std::uint8_t { low, high, falling };

  std::string_view do_backend() const override { return "gpio"; }
  bool do_simulated() const override { return false; }
  Result<> do_open(const GalvoTriggerConfig& config) override;
  Result<TimePoint> do_pulse() override;
  void do_close() override;

  Result<> take_lines();
  void await_low();
  int end_pulse() noexcept;
  void read_sync_edges();
  tl::unexpected<Error> lost(int error_number);

  Clock& clock_;
  const GpioTriggerSettings settings_;
  GalvoTriggerConfig config_;
  std::optional<GpioLine> line_, sync_;
  std::atomic<GpioLine*> held_{nullptr}; // &*line_, for make_safe()
  std::atomic<Level> level_{Level::low};
  TimePoint pulse_end_{};
  PulseTimer timer_;
  SyncMonitor ledger_;
  std::array<TimePoint, GpioLine::kernel_buffer> edges_{};

  std::atomic<std::uint64_t> pulses_{0}, sync_edges_{0}, missed_{0}, unexpected_{0};
  std::atomic<bool> sync_works_{false};
  std::atomic<std::int64_t> sync_delay_ns_{0}, last_sync_ns_{0};
};

} // namespace octascope::hal::linux_backend

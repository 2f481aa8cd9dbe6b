// Small things that several tests of the twins need.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "hal/linux/monotonic_clock.h"
#include "sim/clock/virtual_clock.h"
#include "sim/faults/fault_schedule.h"
#include "sim/spectra/recorded_spectra.h"

namespace octascope::sim {

// A recording in which every sample says its B-scan, line and place.
inline std::unique_ptr<RecordedSpectra> numbered_spectra(int b_scans, int lines, int samples) {
  auto counts = std::make_shared<std::vector<std::uint16_t>>();
  for (int b = 0; b < b_scans; ++b)
    for (int line = 0; line < lines; ++line)
      for (int n = 0; n < samples; ++n)
        counts->push_back(static_cast<std::uint16_t>(b * 512 + line * 16 + n % 16));
  auto spectra = RecordedSpectra::make({.samples = std::as_bytes(std::span{*counts}),
                                        .b_scans = b_scans,
                                        .a_scans = lines,
                                        .samples_per_line = samples,
                                        .significant_bits = 12,
                                        .name = "numbered",
                                        .keep_alive = counts});
  EXPECT_TRUE(spectra);
  return std::move(*spectra);
}

inline FaultScript script_of(std::string_view text) {
  auto script = FaultScript::parse(text, "test.toml");
  EXPECT_TRUE(script) << (script ? "" : script.error().message);
  return script.value_or(FaultScript{});
}

// A schedule with an unplugging of `device` for 1000 s from its start, and one of `later` (a kind
// with no parameters of its own) from 2000 s to 3000 s. Benches move its zero to choose what runs.
class SwitchableFaults {
public:
  explicit SwitchableFaults(const std::string& device, const std::string& later = "unplug")
      : schedule_(script_of("[[fault]]\ndevice = \"" + device +
                            "\"\nkind = \"unplug\"\nat_s = 0\nduration_s = 1000\n"
                            "[[fault]]\ndevice = \"" +
                            device + "\"\nkind = \"" + later +
                            "\"\nat_s = 2000\nduration_s = 1000\n")) {}

  void unplug(hal::TimePoint now) { schedule_.start(now); }
  void replug(hal::TimePoint now) { schedule_.start(now - std::chrono::seconds{1500}); }
  void begin_later_fault(hal::TimePoint now) { schedule_.start(now - std::chrono::seconds{2000}); }
  const FaultSchedule& schedule() const { return schedule_; }

private:
  FaultSchedule schedule_;
};

inline constexpr bool is_virtual(const VirtualClock*) {
  return true;
}
inline constexpr bool is_virtual(const hal::linux_backend::MonotonicClock*) {
  return false;
}

} // namespace octascope::sim

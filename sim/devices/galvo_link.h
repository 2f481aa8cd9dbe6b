// The scanner between the trigger's twin and the camera's twin: pulses in, sweeps out.
//
// One pulse starts the sweeps of one volume. A pulse during another volume's sweeps is latched, one
// deep, and starts right after them; a further one is lost and counted (hal/galvo_trigger.h).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::sim {

enum class PulseFate : std::uint8_t { started, latched, lost };

// Lock-free. One thread sends pulses; any thread reads.
class GalvoLink {
public:
  // Number of sweeps that are remembered.
  static constexpr std::uint64_t memory = 64;

  // Duration of all B-scans of a volume together (ScanPlan::sweep_duration), > 0.
  explicit GalvoLink(hal::Duration sweep_duration) : sweep_duration_(sweep_duration) {}

  // Called by the trigger's thread, with times that do not decrease.
  PulseFate pulse(hal::TimePoint rising_edge);

  // Number of volumes swept so far, including the running one and the latched one.
  std::uint64_t sweeps() const { return sweeps_.load(std::memory_order_acquire); }

  // When volume sweep number `index` (from 0) started or will start. Empty if there is no such
  // sweep, or it is no longer remembered.
  std::optional<hal::TimePoint> start_of(std::uint64_t index) const;

  hal::Duration sweep_duration() const { return sweep_duration_; }
  std::uint64_t lost_pulses() const { return lost_pulses_.load(std::memory_order_relaxed); }

private:
  const hal::Duration sweep_duration_;
  hal::TimePoint newest_start_{}; // used by the pulsing thread only
  std::array<std::atomic<std::int64_t>, memory> starts_ns_{};
  std::atomic<std::uint64_t> sweeps_{0};
  std::atomic<std::uint64_t> lost_pulses_{0};
};

} // namespace octascope::sim

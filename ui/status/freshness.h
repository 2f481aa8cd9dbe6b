// How live the picture is: the rule that nothing old ever looks live.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::ui {

enum class Liveness : std::uint8_t {
  waiting, // no volume has arrived yet
  live,
  stale,    // no fresh volume for more than one and a half volume periods
  veiled,   // none for longer than the limit: the picture is covered
  frozen,   // by the surgeon
  replayed, // the volume was recorded: never live, never stale
};

// The volume on the screen, as times.
struct ShownVolume {
  hal::TimePoint last_line; // camera timestamp of the volume's last line: its age counts from here
  hal::TimePoint arrived;   // when it could first be shown: its successor is due one period later
  bool replayed = false;    // from a recording
  bool operator==(const ShownVolume&) const = default;
};

struct FreshnessLimits {
  hal::Duration volume_period = std::chrono::milliseconds{141};
  hal::Duration veil_after = std::chrono::seconds{5};
  bool operator==(const FreshnessLimits&) const = default;
};

struct Freshness {
  Liveness liveness = Liveness::waiting;
  hal::Duration age{};        // of the shown volume
  hal::Duration frozen_for{}; // 0 unless frozen
  bool operator==(const Freshness&) const = default;
};

// Pure. `frozen_since` is empty unless the surgeon has frozen the picture; freezing takes
// precedence over staleness, since a frozen picture is marked by its own badge.
Freshness judge_freshness(const std::optional<ShownVolume>& shown, hal::TimePoint now,
                          const FreshnessLimits& limits,
                          const std::optional<hal::TimePoint>& frozen_since);

} // namespace octascope::ui

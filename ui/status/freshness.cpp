#include "ui/status/freshness.h"

#include <algorithm>

namespace octascope::ui {

Freshness judge_freshness(const std::optional<ShownVolume>& shown, hal::TimePoint now,
                          const FreshnessLimits& limits,
                          const std::optional<hal::TimePoint>& frozen_since) {
  if (!shown)
    return {};
  constexpr hal::Duration none{};
  Freshness result;
  result.age = std::max(none, now - shown->last_line);
  const hal::Duration waited = now - shown->arrived;
  if (frozen_since) {
    result.liveness = Liveness::frozen;
    result.frozen_for = std::max(none, now - *frozen_since);
  } else if (shown->replayed) {
    result.liveness = Liveness::replayed;
  } else if (waited * 2 <= limits.volume_period * 3) {
    result.liveness = Liveness::live;
  } else {
    result.liveness = waited > limits.veil_after ? Liveness::veiled : Liveness::stale;
  }
  return result;
}

} // namespace octascope::ui

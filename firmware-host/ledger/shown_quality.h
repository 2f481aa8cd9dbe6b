// At which quality the volume was drawn in the frames that were shown.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "ui/view/draw_quality.h"
#include "ui/view/technique.h"

namespace octascope::firmware_host {

struct QualityRange {
  double median = 0; // of an even count, the lower one of the two in the middle
  double worst = 0;
  bool operator==(const QualityRange&) const = default;
};

struct QualitySummary {
  std::uint64_t frames = 0;               // in which the volume was drawn anew
  std::optional<QualityRange> resolution; // of its picture, 0 to 1 (ui::DrawQuality)
  std::optional<QualityRange> steps;      // along the longest edge of its box
};

// Bound to one thread. Adding is two increments.
class ShownQuality {
public:
  // Of a frame that was shown and in which the volume was drawn anew. A surface has no steps.
  void add(ui::Technique technique, const ui::DrawQuality& quality);
  QualitySummary summary() const;

private:
  std::array<std::uint64_t, 101> resolutions_{};                  // by percent
  std::array<std::uint64_t, ui::full_quality.steps + 1> steps_{}; // by number
};

} // namespace octascope::firmware_host

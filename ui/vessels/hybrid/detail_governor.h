// Chooses how many vessels are merged so that the frame rate holds. Pure: costs are arguments.
//
// The radius in pixels below which segments are merged (merged_order.h) is a number without steps,
// so nothing pops. The number of segments drawn, and so the cost, falls at most as that radius
// grows. That is why it never swings: raised by no more than the cost exceeds the budget, it does
// not bring the cost below the budget; lowered, while the cost is well below, by no more than is to
// spare, it does not bring it above. That the first vessels to be merged cost more than they spare
// changes nothing about it: as long as the cost is too much the radius goes on rising, and on its
// way back it stays where the cost comes near the budget.
#pragma once

#include <array>
#include <cstddef>

#include "hal/clock.h"

namespace octascope::ui {

// Threads: one at a time. Allocates nothing.
class DetailGovernor {
public:
  explicit DetailGovernor(hal::Duration budget) : budget_ms_{hal::to_ms(budget)} {}

  void set_budget(hal::Duration budget) { budget_ms_ = hal::to_ms(budget); }

  // For the frame that begins now; 0: every segment is drawn. At rest, with nothing new to show, a
  // frame may take its time and is drawn in full.
  float detail_px(bool at_rest) const { return at_rest ? 0 : detail_px_; }

  // What a frame with that detail cost. Frames at rest are not to be told.
  void note(hal::Duration cost);

private:
  static constexpr std::size_t judged = 5; // frames: two that were interrupted change nothing

  double budget_ms_;
  float detail_px_ = 0;
  std::array<double, judged> costs_ms_{};
  std::size_t count_ = 0;
};

} // namespace octascope::ui

// Chooses how many vessels are merged so that the frame rate holds. Pure: costs are arguments.
//
// The radius in pixels below which segments are merged (merged_order.h) is continuous, so nothing
// pops. The number of drawn segments, and so the cost, falls at most as fast as that radius grows.
// So the control cannot oscillate: raising the radius by no more than the excess of the cost does
// not bring it below the budget; lowering it, while the cost is well below, by no more than the
// spare does not bring it above. That the first merged vessels cost more than they save does not
// matter: the radius rises as long as the cost is too high, and stops on its way back where the
// cost nears the budget.
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

  // The cost of a frame with that detail. Do not report frames at rest.
  void note(hal::Duration cost);

private:
  static constexpr std::size_t judged = 5; // frames: two interrupted ones change nothing

  double budget_ms_;
  float detail_px_ = 0;
  std::array<double, judged> costs_ms_{};
  std::size_t count_ = 0;
};

} // namespace octascope::ui

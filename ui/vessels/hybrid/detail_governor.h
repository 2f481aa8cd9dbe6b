// Chooses how many vessels are merged, and whether they shade each other, so that the frame rate
// holds. Pure: costs are arguments.
//
// The shading goes first. It comes back when nothing is merged and there is room for what it cost
// when it went, and half as much again.
//
// The radius in pixels below which segments are merged (merged_order.h) is continuous, so nothing
// pops. As it grows, the number of segments drawn, and so the cost, falls at most in proportion.
// That is why the control never oscillates: raising the radius by no more than the factor by which
// the cost exceeds the budget does not bring the cost below the budget; lowering it, while the cost
// is well below, by no more than what is spare does not bring it above. It does not matter that the
// first merged vessels cost more than they save: while the cost is too high the radius keeps
// rising, and on its way back it stays where the cost comes near the budget.
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

  // For the frame that begins now; 0: every segment is drawn. At rest, with nothing new to show,
  // the frame may take longer and is drawn in full.
  float detail_px(bool at_rest) const { return at_rest ? 0 : detail_px_; }

  // Whether what lies close behind others is shaded; see VesselLook.
  bool occluded(bool at_rest) const { return at_rest || occluded_; }

  // Reports the cost of a frame with that detail. Not to be called for frames at rest.
  void note(hal::Duration cost);

private:
  static constexpr std::size_t judged = 5; // frames; two interrupted ones change nothing

  void drop_or_merge(double cost_ms);
  void refine(double cost_ms);

  double budget_ms_;
  bool occluded_ = true;
  double occluded_ms_ = 0;  // the cost of the last frames that were
  double occlusion_ms_ = 0; // what was saved by dropping it
  bool just_dropped_ = false;
  float detail_px_ = 0;
  std::array<double, judged> costs_ms_{};
  std::size_t count_ = 0;
};

} // namespace octascope::ui

#include "ui/vessels/hybrid/detail_governor.h"

#include <algorithm>

namespace octascope::ui {

namespace {

constexpr float least_detail_px = 0.02F; // thinner than any vessel that is worth drawing
constexpr float most_detail_px = 1;
constexpr double spare_share = 0.8;  // of the budget: finer below
constexpr double target_share = 0.9; // and to no more than this
constexpr double fastest_rise = 1.5; // in one step
constexpr double fastest_fall = 0.9;
constexpr double room_for_occlusion = 1.5;

} // namespace

void DetailGovernor::note(hal::Duration cost) {
  costs_ms_[count_++] = hal::to_ms(cost);
  if (count_ < judged)
    return;
  count_ = 0;
  std::ranges::sort(costs_ms_);
  const double cost_ms = costs_ms_[judged / 2];
  if (just_dropped_)
    occlusion_ms_ = std::max(occluded_ms_ - cost_ms, 0.0);
  just_dropped_ = false;
  if (cost_ms > budget_ms_)
    drop_or_merge(cost_ms);
  else if (cost_ms < spare_share * budget_ms_)
    refine(cost_ms);
}

void DetailGovernor::drop_or_merge(double cost_ms) {
  if (occluded_) {
    occluded_ = false;
    just_dropped_ = true;
    occluded_ms_ = cost_ms;
    return;
  }
  const double rise = std::min(cost_ms / budget_ms_, fastest_rise);
  detail_px_ =
      std::min(std::max(detail_px_, least_detail_px) * static_cast<float>(rise), most_detail_px);
}

void DetailGovernor::refine(double cost_ms) {
  if (detail_px_ <= 0) {
    occluded_ =
        occluded_ || cost_ms + room_for_occlusion * occlusion_ms_ < spare_share * budget_ms_;
    return;
  }
  const double fall = std::max(cost_ms / (target_share * budget_ms_), fastest_fall);
  detail_px_ *= static_cast<float>(fall);
  if (detail_px_ < least_detail_px)
    detail_px_ = 0;
}

} // namespace octascope::ui

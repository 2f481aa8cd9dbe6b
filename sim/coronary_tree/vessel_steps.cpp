#include "sim/coronary_tree/vessel_steps.h"

#include "sim/coronary_tree/trunk_plan.h"

namespace octascope::sim {
namespace {

constexpr double sqrt_3 = 1.7320508075688772;

} // namespace

Calibre::Calibre(const BranchMorphometry& branch, std::size_t order, std::size_t segments,
                 double mother_um, double end_um, HashRandom& draws) {
  const OrderMorphometry& facts = branch.orders[order];
  const DiameterRange range = diameter_range(branch, order);
  most_um_ = std::min(range.most_um * 0.9999, mother_um);
  least_um_ = std::min(range.least_um * 1.0001, most_um_);
  const double all = facts.diameter_um.deviation;
  // Small vessels keep their calibre. In large ones what segments vary beyond elements is taper.
  const bool tapers = order >= lowest_trunk_order && segments > 1;
  const double between = tapers ? facts.element_diameter_deviation_um : all;
  mean_um_ = facts.diameter_um.mean + between * draws.normal();
  first_um_ = 0;
  step_um_ = 0;
  if (!tapers)
    return;
  const double steps = static_cast<double>(segments - 1);
  const double widest = sqrt_3 * std::sqrt(std::max(0.0, all * all - between * between));
  const double steepest = (1 - large_daughter_ratio(order)) * steps / 2 * mean_um_;
  const double to_end = std::min({mean_um_ - end_um, most_um_ - mean_um_, mean_um_ - least_um_});
  first_um_ = std::max({0.0, std::min(widest, steepest), to_end});
  step_um_ = 2 * first_um_ / steps;
}

double Calibre::diameter_um(std::size_t segment) const {
  return std::clamp(mean_um_ + first_um_ - step_um_ * static_cast<double>(segment), least_um_,
                    most_um_);
}

double segment_length_mm(const OrderMorphometry& order, double needed_mm, HashRandom& draws) {
  constexpr int more = 3;
  double best = draws.positive(order.length_mm);
  for (int i = 0; i < more; ++i) {
    const double other = draws.positive(order.length_mm);
    if (std::abs(other - needed_mm) < std::abs(best - needed_mm))
      best = other;
  }
  // Not a mere point, which would have no direction.
  return std::max(best, 0.1 * order.length_mm.mean);
}

Vector3 daughter_direction(Vector3 mother, Vector3 target, double mother_um, double daughter_um,
                           double sister_um) {
  const double d0 = mother_um * mother_um;
  const double d1 = daughter_um * daughter_um;
  const double d2 = sister_um * sister_um;
  const double cosine = std::clamp((d0 * d0 + d1 * d1 - d2 * d2) / (2 * d0 * d1), -0.1, 0.98);
  const double sine = std::sqrt(1 - cosine * cosine);
  // Give and take 30 degrees.
  constexpr double cos_30 = 0.8660254037844386;
  constexpr double sin_30 = 0.5;
  const double wider = cosine * cos_30 - sine * sin_30;
  const double narrower = cosine > cos_30 ? 1 : cosine * cos_30 + sine * sin_30;
  return turned(mother, target, wider, narrower);
}

Vector3 onward_direction(Vector3 direction, Vector3 target, double least_cosine, double winding,
                         HashRandom& draws) {
  const Vector3 to = turned(direction, target, least_cosine, 1);
  const Vector3 lot{draws.normal(), draws.normal(), draws.normal()};
  return unit(to + winding * across(lot, to), to);
}

} // namespace octascope::sim

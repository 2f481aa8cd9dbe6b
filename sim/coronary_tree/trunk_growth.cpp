#include "sim/coronary_tree/trunk_growth.h"

#include <algorithm>
#include <limits>

#include "sim/coronary_tree/heart/course_regions.h"
#include "sim/coronary_tree/heart/heart_wall.h"
#include "sim/coronary_tree/vessel_steps.h"

namespace octascope::sim {
namespace {

constexpr double septum_mm = 8.5; // deeper than any outer wall's middle

// How an order moves.
struct Manner {
  double sharpest_turn; // cosine
  double winding;
};

Manner manner_of(std::size_t order) {
  if (order >= lowest_outer_order)
    return {0.92, 0.09};
  return order >= 7 ? Manner{0.82, 0.10} : Manner{0.7, 0.12};
}

class Grower {
public:
  Grower(const BranchMorphometry& branch, TrunkPlan& plan, const Course& course, Region cells,
         std::uint64_t key)
      : branch_{branch}, plan_{plan}, course_{course}, cells_{cells}, draws_{key} {}

  GrownTrunk grow();

private:
  struct Way {
    Vector3 place;
    Vector3 direction;
    std::size_t first_cell;
    std::size_t cells;
    double weight; // of what is still to spring off
  };

  void grow_element(std::uint32_t index);
  void step_freely(const PlannedElement& element, std::uint32_t segment, Way& way);
  Vector3 held(std::size_t order, double diameter_um, Vector3 place, bool in_septum) const;

  void grow_on_course(std::uint32_t index);
  std::vector<double> joints_on_course(const PlannedElement& element);
  void place_joints(PlannedElement& mother, std::span<const double> joints,
                    const CourseRegions& regions);

  std::vector<std::uint32_t> daughters_at(const PlannedElement& mother, std::uint32_t joint) const;
  double end_um(const PlannedElement& element) const;
  std::size_t share(const Way& way, double weight) const;
  void begin(std::uint32_t daughter, const Way& way, std::size_t cells, double mother_um,
             double sister_um);

  Region region(std::size_t first, std::size_t count) const { return cells_.subspan(first, count); }

  const BranchMorphometry& branch_;
  TrunkPlan& plan_;
  const Course& course_;
  Region cells_;
  HashRandom draws_;
  GrownTrunk grown_;
  double along_mm_ = 0; // how far the artery has come on its course
};

std::vector<std::uint32_t> Grower::daughters_at(const PlannedElement& mother,
                                                std::uint32_t joint) const {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < mother.daughters; ++i)
    if (plan_.elements[mother.first_daughter + i].joint == joint)
      found.push_back(mother.first_daughter + i);
  // The first one is what the element goes on with where it ends: it takes what is left.
  std::ranges::reverse(found);
  return found;
}

// As wide as the widest that springs from its end can begin.
double Grower::end_um(const PlannedElement& element) const {
  double widest = 0;
  for (const std::uint32_t daughter : daughters_at(element, element.segments - 1))
    widest = std::max(widest, branch_.orders[plan_.elements[daughter].order].diameter_um.mean);
  return widest > 0 ? static_cast<double>(pipeline::widest_start) * widest
                    : std::numeric_limits<double>::infinity();
}

// Cells for a daughter of that weight: at least one.
std::size_t Grower::share(const Way& way, double weight) const {
  const double part = way.weight > 0 ? std::min(1.0, weight / way.weight) : 1;
  const auto count = static_cast<std::size_t>(part * static_cast<double>(way.cells) + 0.5);
  return std::min(std::max<std::size_t>(count, 1), way.cells);
}

void Grower::begin(std::uint32_t daughter, const Way& way, std::size_t cells, double mother_um,
                   double sister_um) {
  const double daughter_um =
      std::min(mother_um, branch_.orders[plan_.elements[daughter].order].diameter_um.mean);
  const Vector3 target = unit(centre_of(region(way.first_cell, cells)) - way.place, way.direction);
  GrownElement& element = grown_.elements[daughter];
  element.first_cell = way.first_cell;
  element.cells = cells;
  element.start = way.place;
  element.direction = daughter_direction(way.direction, target, mother_um, daughter_um,
                                         std::min(sister_um, mother_um));
  element.mother_um = mother_um;
}

Vector3 Grower::held(std::size_t order, double diameter_um, Vector3 place, bool in_septum) const {
  if (order < lowest_outer_order || in_septum)
    return held_in_muscle(place);
  place.y = std::min(place.y, base_mm);
  return held_at_depth(place, -0.4 * diameter_um / 1000);
}

void Grower::step_freely(const PlannedElement& element, std::uint32_t segment, Way& way) {
  const Vector3 centre = centre_of(region(way.first_cell, way.cells));
  const bool in_septum = depth_mm(centre) > septum_mm;
  const Vector3 away = centre - way.place;
  Vector3 target = unit(away, way.direction);
  if (element.order >= lowest_outer_order && !in_septum)
    target = unit(across(target, epicardium_outward(way.place)), way.direction);
  const Manner manner = manner_of(element.order);
  if (segment > 0)
    way.direction =
        onward_direction(way.direction, target, manner.sharpest_turn, manner.winding, draws_);
  const auto to_go = static_cast<double>(element.segments - segment);
  const double needed = length(away) * (0.6 + 0.2 * to_go) / to_go;
  const double size = segment_length_mm(branch_.orders[element.order], needed, draws_);
  const Vector3 end = held(element.order, branch_.orders[element.order].diameter_um.mean,
                           way.place + size * way.direction, in_septum);
  way.direction = unit(end - way.place, way.direction);
  way.place = end;
}

void Grower::grow_element(std::uint32_t index) {
  const PlannedElement& element = plan_.elements[index];
  GrownElement& grown = grown_.elements[index];
  grown.first_node = grown_.nodes.size();
  const Calibre calibre{branch_,         element.order,   element.segments,
                        grown.mother_um, end_um(element), draws_};
  Way way{grown.start, grown.direction, grown.first_cell, grown.cells, element.weight};
  for (std::uint32_t k = 0; k < element.segments; ++k) {
    step_freely(element, k, way);
    grown_.nodes.push_back({way.place, calibre.diameter_um(k)});
    for (const std::uint32_t daughter : daughters_at(element, k)) {
      const double weight = plan_.elements[daughter].weight;
      const std::size_t count = share(way, weight);
      const bool outer = element.order >= lowest_outer_order;
      divide(region(way.first_cell, way.cells), count, way.direction,
             outer ? epicardium_outward(way.place) : Vector3{});
      const double sister =
          k + 1 < element.segments ? calibre.diameter_um(k + 1) : calibre.diameter_um(k) * 0.8;
      begin(daughter, way, count, calibre.diameter_um(k), sister);
      way.weight -= weight;
      if (count < way.cells) {
        way.first_cell += count;
        way.cells -= count;
      }
    }
  }
}

// Where along the course its segments end: of the published mean length together.
std::vector<double> Grower::joints_on_course(const PlannedElement& element) {
  const MeanAndDeviation published = branch_.orders[element.order].length_mm;
  std::vector<double> joints(element.segments);
  double sum = 0;
  for (double& joint : joints)
    joint = sum += std::max(0.25 * published.mean, draws_.positive(published));
  const double wanted = std::min(published.mean * static_cast<double>(joints.size()),
                                 course_.length_mm() - along_mm_);
  for (double& joint : joints)
    joint = along_mm_ + joint * wanted / sum;
  return joints;
}

// Lets each daughter spring off where about as much muscle as it feeds is still without a vessel.
void Grower::place_joints(PlannedElement& mother, std::span<const double> joints,
                          const CourseRegions& regions) {
  std::vector<std::uint32_t> places; // of those before the end
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t i = mother.first_daughter; i < mother.first_daughter + mother.daughters; ++i)
    if (plan_.elements[i].joint + 1 < mother.segments) {
      places.push_back(plan_.elements[i].joint);
      waiting.push_back(i);
    }
  std::ranges::sort(places);
  const auto all = static_cast<double>(regions.before(2 * course_.length_mm()));
  double fed = 0;
  for (const std::uint32_t place : places) {
    const double here = (joints[place] + joints[place + 1]) / 2;
    const double lacking = static_cast<double>(regions.before(here)) / all * mother.weight - fed;
    const auto best = std::ranges::min_element(waiting, [&](std::uint32_t a, std::uint32_t b) {
      return std::abs(plan_.elements[a].weight - lacking) <
             std::abs(plan_.elements[b].weight - lacking);
    });
    plan_.elements[*best].joint = place;
    fed += plan_.elements[*best].weight;
    waiting.erase(best);
  }
}

void Grower::grow_on_course(std::uint32_t index) {
  PlannedElement& element = plan_.elements[index];
  GrownElement& grown = grown_.elements[index];
  grown.first_node = grown_.nodes.size();
  CourseRegions regions{region(grown.first_cell, grown.cells), course_};
  const std::vector<double> joints = joints_on_course(element);
  place_joints(element, joints, regions);
  const Calibre calibre{branch_,         element.order,   element.segments,
                        grown.mother_um, end_um(element), draws_};
  Way way{grown.start, grown.direction, grown.first_cell, grown.cells, element.weight};
  for (std::uint32_t k = 0; k < element.segments; ++k) {
    way.place = course_.at(joints[k]);
    way.direction = course_.direction(joints[k]);
    grown_.nodes.push_back({way.place, calibre.diameter_um(k)});
    for (const std::uint32_t daughter : daughters_at(element, k)) {
      const double weight = plan_.elements[daughter].weight;
      const std::size_t count = share(way, weight);
      regions.hand_out(count);
      const double sister = calibre.diameter_um(std::min(k + 1, element.segments - 1));
      begin(daughter, way, count, calibre.diameter_um(k), sister);
      way.weight -= weight;
      if (count < way.cells) {
        way.first_cell += count;
        way.cells -= count;
      }
    }
  }
  along_mm_ = joints.back();
}

GrownTrunk Grower::grow() {
  grown_.elements.resize(plan_.elements.size());
  grown_.root = course_.at(0);
  const OrderMorphometry& root = branch_.orders[branch_.highest_order];
  grown_.root_um = root.diameter_um.mean + root.diameter_um.deviation * 2;
  grown_.elements[0] = {0, 0, cells_.size(), grown_.root, course_.direction(0), grown_.root_um};
  for (std::uint32_t i = 0; i < plan_.elements.size(); ++i) {
    if (!plan_.elements[i].is_trunk())
      continue;
    if (plan_.elements[i].on_course && along_mm_ + 8 < course_.length_mm())
      grow_on_course(i);
    else
      grow_element(i);
  }
  return std::move(grown_);
}

} // namespace

GrownTrunk grow_trunk(const BranchMorphometry& branch, TrunkPlan& plan, const Course& course,
                      Region cells, std::uint64_t key) {
  return Grower{branch, plan, course, cells, key}.grow();
}

} // namespace octascope::sim

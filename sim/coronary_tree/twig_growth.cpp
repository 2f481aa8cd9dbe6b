#include "sim/coronary_tree/twig_growth.h"

#include <algorithm>

#include "sim/coronary_tree/heart/heart_wall.h"
#include "sim/coronary_tree/vessel_steps.h"

namespace octascope::sim {
namespace {

constexpr std::size_t most_daughters = 48;

struct Daughter {
  std::size_t order;
  std::uint32_t segments;
};

// An element's own segments and what springs from it.
struct Family {
  std::uint32_t own = 0;
  std::size_t count = 0;
  std::size_t own_kind = 0; // daughters of the element's own order: the first ones
  double size = 0;          // of all daughters, as expected
  std::array<Daughter, most_daughters> daughters;
};

class Grower {
public:
  Grower(const TwigRules& rules, std::uint64_t key, pipeline::VesselTree& tree)
      : rules_{rules}, tree_{tree}, draws_{key} {}

  // Calls itself for each daughter: as deep as orders go, not as the tree.
  void grow(const Twig& twig);

private:
  Family family_of(const Twig& twig);
  Family draw_family(std::size_t order, std::uint32_t segments);
  Family smallest_family(std::uint32_t segments);
  std::size_t draw_order(std::size_t mother);
  void share_out(Family& family, std::uint32_t segments);
  void write(std::uint32_t node, std::uint32_t parent, Vector3 place, double diameter_um,
             std::size_t order);

  const TwigRules& rules_;
  pipeline::VesselTree& tree_;
  HashRandom draws_;
};

std::size_t Grower::draw_order(std::size_t mother) {
  double left = draws_.unit() * rules_.facts->daughters_of(mother);
  for (std::size_t order = 0; order < mother; ++order) {
    left -= rules_.facts->daughters[order][mother];
    if (left < 0)
      return order;
  }
  return mother;
}

Family Grower::draw_family(std::size_t order, std::uint32_t segments) {
  const BranchMorphometry& facts = *rules_.facts;
  const double relative = std::clamp(static_cast<double>(segments) / rules_.sizes[order], 0.4, 2.5);
  const MeanAndDeviation published = facts.orders[order].segments_per_element;
  const double mean = segments_per_element(facts, rules_.low, order) * relative;
  const double own = draws_.positive({mean, 0.5 * std::min(published.deviation, mean)});
  const double per_fork = facts.daughters_of(order) / (published.mean + 1);
  Family family;
  family.own = static_cast<std::uint32_t>(std::max<std::size_t>(1, draws_.rounded(own)));
  const std::size_t wanted =
      std::min(most_daughters, draws_.rounded(per_fork * (static_cast<double>(family.own) + 1)));
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t daughter = draw_order(order);
    const bool there = daughter > rules_.low.lowest_order ||
                       (daughter == rules_.low.lowest_order && draws_.unit() < rules_.low.kept);
    if (!there)
      continue;
    family.daughters[family.count++] = {daughter, 0};
    family.size += rules_.sizes[daughter];
  }
  // The element ends where the largest goes on. One of its own order springs from its side: at its
  // end it would be the element itself.
  const auto begin = family.daughters.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(family.count);
  const auto size_below = [order](const Daughter& d) { return d.order == order ? 0 : d.order + 1; };
  const auto largest = std::max_element(begin, end, [&](const Daughter& a, const Daughter& b) {
    return size_below(a) < size_below(b);
  });
  if (largest != end)
    std::iter_swap(largest, end - 1);
  const auto others =
      std::stable_partition(begin, end, [&](const Daughter& d) { return d.order == order; });
  family.own_kind = static_cast<std::size_t>(others - begin);
  if (family.own_kind > 0)
    family.own = std::max(family.own, 2U);
  return family;
}

// Capillaries on a short vessel, now and then with another one like it: as many as make up the
// number.
Family Grower::smallest_family(std::uint32_t segments) {
  constexpr std::uint32_t smallest_with_own_kind = 5;
  constexpr double such_families = 2.5; // those large enough are fewer than all
  Family family;
  std::uint32_t left = segments;
  if (segments >= smallest_with_own_kind &&
      draws_.unit() < such_families * rules_.facts->daughters[1][1]) {
    const std::uint32_t for_own_kind = segments / 2 - 1;
    family.daughters[family.count++] = {1, for_own_kind};
    family.own_kind = 1;
    left -= for_own_kind;
  }
  const double half = static_cast<double>(left - 1 + family.own_kind) / 2;
  family.own =
      static_cast<std::uint32_t>(std::max<std::size_t>(1 + family.own_kind, draws_.rounded(half)));
  const std::size_t capillaries =
      std::min<std::size_t>(left - std::min(left, family.own), most_daughters - 1);
  family.own = left - static_cast<std::uint32_t>(capillaries);
  for (std::size_t i = 0; i < capillaries; ++i)
    family.daughters[family.count++] = {0, 1};
  return family;
}

// So that with its own segments the element has exactly its number.
void Grower::share_out(Family& family, std::uint32_t segments) {
  family.own = std::min(family.own, segments);
  if (family.size <= 0)
    family.own = segments;
  const double scale =
      family.size > 0 ? static_cast<double>(segments - family.own) / family.size : 0;
  const double offset = draws_.unit();
  double running = 0;
  std::uint32_t given = 0;
  for (std::size_t i = 0; i < family.count; ++i) {
    running += rules_.sizes[family.daughters[i].order] * scale;
    const auto up_to =
        i + 1 == family.count
            ? segments - family.own
            : std::min(static_cast<std::uint32_t>(running + offset), segments - family.own);
    family.daughters[i].segments = up_to - given;
    given = up_to;
  }
}

// Of three families drawn the one that comes nearest to the number.
Family Grower::family_of(const Twig& twig) {
  if (twig.order == 0 || twig.segments == 1) {
    Family alone;
    alone.own = twig.segments;
    return alone;
  }
  const bool capillaries = rules_.low.lowest_order == 0 && rules_.low.kept == 1;
  if (twig.order == 1 && capillaries && twig.segments < 1.5 * rules_.sizes[1])
    return smallest_family(twig.segments);
  Family best = draw_family(twig.order, twig.segments);
  const auto miss = [&](const Family& f) {
    return std::abs(f.size + f.own - static_cast<double>(twig.segments));
  };
  for (int i = 0; i < 2; ++i) {
    const Family other = draw_family(twig.order, twig.segments);
    if (miss(other) < miss(best))
      best = other;
  }
  share_out(best, twig.segments);
  return best;
}

void Grower::write(std::uint32_t node, std::uint32_t parent, Vector3 place, double diameter_um,
                   std::size_t order) {
  tree_.positions_mm[node] = {static_cast<float>(place.x), static_cast<float>(place.y),
                              static_cast<float>(place.z)};
  tree_.radii_mm[node] = static_cast<float>(diameter_um / 2000);
  tree_.parents[node] = parent;
  tree_.orders[node] = static_cast<std::uint8_t>(order);
  tree_.branches[node] = rules_.branch;
}

void Grower::grow(const Twig& twig) {
  constexpr double sharpest_turn = 0.5; // 60 degrees
  constexpr double winding = 0.12;
  const Family family = family_of(twig);
  const OrderMorphometry& facts = rules_.facts->orders[twig.order];
  const Calibre calibre{*rules_.facts,  twig.order,     family.own,
                        twig.mother_um, twig.mother_um, draws_};
  Region region = twig.region;
  Vector3 place = twig.start;
  Vector3 direction = twig.direction;
  std::uint32_t node = twig.node;
  std::uint32_t parent = twig.parent;
  std::uint32_t left = twig.segments;
  std::size_t next_daughter = 0;
  for (std::uint32_t k = 0; k < family.own; ++k) {
    const Vector3 away = centre_of(region) - place;
    const Vector3 target = unit(away, direction);
    if (k > 0)
      direction = onward_direction(direction, target, sharpest_turn, winding, draws_);
    const auto to_go = static_cast<double>(family.own - k);
    const double needed = length(away) * (0.6 + 0.2 * to_go) / to_go;
    const Vector3 end =
        held_in_muscle(place + segment_length_mm(facts, needed, draws_) * direction);
    direction = unit(end - place, direction);
    place = end;
    write(node, parent, place, calibre.diameter_um(k), twig.order);
    parent = node++;
    --left;
    // Daughters are spread over the forks; at the last one all that are left.
    const std::size_t up_to =
        k + 1 == family.own ? family.count
                            : std::max(family.own_kind, (k + 1) * family.count / (family.own + 1));
    for (; next_daughter < up_to; ++next_daughter) {
      const Daughter& daughter = family.daughters[next_daughter];
      if (daughter.segments == 0)
        continue;
      const auto all = static_cast<double>(region.size());
      const std::size_t share = std::clamp<std::size_t>(
          static_cast<std::size_t>(all * daughter.segments / std::max(1U, left) + 0.5), 1,
          region.size());
      divide(region, share, direction, {});
      const Region part = region.first(share);
      const double mother_um = calibre.diameter_um(k);
      const double daughter_um =
          std::min(mother_um, rules_.facts->orders[daughter.order].diameter_um.mean);
      const double sister_um = k + 1 < family.own ? calibre.diameter_um(k + 1) : daughter_um;
      const Vector3 to = unit(centre_of(part) - place, direction);
      grow({daughter.order, daughter.segments, node, parent, place,
            daughter_direction(direction, to, mother_um, daughter_um, sister_um), mother_um, part});
      node += daughter.segments;
      left -= daughter.segments;
      if (share < region.size())
        region = region.subspan(share);
    }
  }
}

} // namespace

void grow_twig(const TwigRules& rules, const Twig& twig, std::uint64_t key,
               pipeline::VesselTree& tree) {
  Grower{rules, key, tree}.grow(twig);
}

} // namespace octascope::sim

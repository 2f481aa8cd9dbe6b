#include "ui/pacing/governor.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

constexpr std::array ladder{
    full_quality,
    DrawQuality{1, 384},
    DrawQuality{1, 256},
    DrawQuality{0.85F, 256},
    DrawQuality{0.7F, 256},
    DrawQuality{0.6F, 224},
    DrawQuality{0.5F, 192},
    DrawQuality{0.42F, 160},
    DrawQuality{0.35F, 128},
    DrawQuality{0.3F, 96},
    DrawQuality{0.25F, 80},
};

// A ray costs something before its first sample: as much as so many of them, measured with the
// processor's ray caster (docs/DISPLAY.md). What this errs by is learnt as the correction.
constexpr double steps_of_a_ray = 180;

// Finer only with so much of the budget to spare; coarser when it is exceeded.
constexpr double finer_share = 0.8;
// No step of the ladder costs more than 1.6 times the next coarser one: from here it still fits.
constexpr double idle_share = 0.55;

constexpr std::size_t coarsest_rung_at_rest = 6;
static_assert(ladder[coarsest_rung_at_rest] == Governor::coarsest_at_rest);

std::size_t index_of(Technique technique) {
  return static_cast<std::size_t>(technique);
}

} // namespace

std::span<const DrawQuality> quality_ladder() {
  return ladder;
}

double sample_share(const DrawQuality& quality) {
  const double resolution = static_cast<double>(quality.resolution);
  return resolution * resolution * (quality.steps + steps_of_a_ray) /
         (full_quality.steps + steps_of_a_ray);
}

std::optional<float> visible_reduction(const DrawQuality& quality) {
  // Half of the steps differ by less than 1 % of the picture (docs/DISPLAY.md).
  const bool seen = quality.resolution < 1 || quality.steps < full_quality.steps / 2;
  return seen ? std::optional{static_cast<float>(sample_share(quality))} : std::nullopt;
}

FrameBudget frame_budget(hal::Duration refresh, const DrawnHow& how) {
  if (!how.software)
    return {refresh * 8 / 10, refresh * (how.rolling ? 8 : 18) / 10};
  // A frame that takes more than two refreshes of an output that waits for them takes three.
  const hal::Duration moving_cast = refresh * (how.waits_for_refresh ? 18 : 20) / 10;
  const hal::Duration moving = how.waits_for_refresh ? moving_cast : refresh * 9 / 10;
  if (how.in_parts)
    return {moving, refresh * 7 / 10, moving_cast};
  return {moving, refresh * (how.rolling ? 18 : 15) / 10, moving_cast};
}

double Governor::Recent::median() const {
  const std::size_t count = std::min(count_, kept);
  std::array<double, kept> sorted = values_;
  const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(count);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(sorted.begin(), middle, end);
  return *middle;
}

double Governor::Recent::longest() const {
  return *std::max_element(values_.begin(),
                           values_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kept)));
}

hal::Duration Governor::longest_fixed_cost() const {
  return fixed_ms_.empty() ? hal::Duration{} : hal::from_seconds(fixed_ms_.longest() * 1e-3);
}

double Governor::predict_ms(const Knowledge& knowledge, std::size_t rung) const {
  const double fixed = fixed_ms_.empty() ? 0 : fixed_ms_.median();
  return fixed +
         knowledge.full_ms.median() * sample_share(ladder[rung]) * knowledge.correction[rung];
}

double Governor::budget_ms() const {
  return hal::to_ms(moving_ ? budget_.moving : budget_.resting);
}

// Not what was tried already, unless costs are quite different by now.
bool Governor::worth_trying(const Knowledge& knowledge, std::size_t rung) {
  constexpr double quite = 0.3;
  const double then = knowledge.learnt_at_ms[rung];
  return std::abs(knowledge.full_ms.median() - then) > quite * then || then == 0;
}

void Governor::enter(Place& place, std::size_t rung) {
  place = Place{};
  place.rung = rung;
}

// To the finest quality that fits. One that was just entered is given a few frames first, so that
// its own cost is known before it is judged.
void Governor::settle(Place& place, Knowledge& knowledge, double budget_ms,
                      std::size_t coarsest) const {
  if (knowledge.full_ms.empty() || (place.frames > 0 && place.frames < kept))
    return;
  std::size_t rung = place.rung;
  while (rung < coarsest && predict_ms(knowledge, rung) > budget_ms)
    ++rung;
  if (rung == place.rung)
    while (rung > 0 && predict_ms(knowledge, rung - 1) <= finer_share * budget_ms)
      --rung;
  const bool half_idle = place.frames >= kept && place.frame_ms.median() <= idle_share * budget_ms;
  if (rung == place.rung && rung > 0 && half_idle && worth_trying(knowledge, rung - 1))
    --rung;
  if (rung == place.rung)
    return;
  enter(place, rung);
  knowledge.compared = true;
}

// What a picture costs beside its samples is taken for their cost while all that was drawn is coarse, so that a
// finer one seems to take several times what it does: so it is tried, and what it took is remembered. Where it
// had to be coarser, no finer before there is time to spare, so that it does not change its mind.
bool Governor::can_move_as_it_rests() const {
  const Knowledge& knowledge = knowledge_[technique_];
  const Place& place = places_[technique_][1];
  if (knowledge.full_ms.empty())
    return false;
  const bool was_coarser = place.rung > coarsest_rung_at_rest;
  const double most_ms = hal::to_ms(budget_.moving_cast) * (was_coarser ? finer_share : 1);
  if (predict_ms(knowledge, coarsest_rung_at_rest) <= most_ms)
    return true;
  return was_coarser && place.frames >= kept && place.frame_ms.median() <= most_ms &&
         worth_trying(knowledge, coarsest_rung_at_rest);
}

std::size_t Governor::coarsest_rung(bool cast) const {
  return cast && (!moving_ || can_move_as_it_rests()) ? coarsest_rung_at_rest : ladder.size() - 1;
}

DrawQuality Governor::choose(const Situation& situation) {
  technique_ = index_of(situation.technique);
  if (situation.moved)
    still_since_ = situation.now;
  moving_ = situation.now - still_since_ < rest_after;
  still_ = !moving_ && !situation.live;
  if (still_)
    return full_quality;
  Place& place = places_[technique_][moving_ ? 1 : 0];
  const std::size_t coarsest = coarsest_rung(situation.cast);
  if (place.rung > coarsest)
    enter(place, coarsest);
  settle(place, knowledge_[technique_], budget_ms(), coarsest);
  return ladder[place.rung];
}

// The frames of the first quality say what full quality would cost. Later, the first few frames of
// a quality say how its cost differs from what was expected, and from then on its frames say how
// the technique's cost changes with what is drawn.
void Governor::learn(Place& place, Knowledge& knowledge, double sampling_ms,
                     double budget_ms) const {
  const double share = sample_share(ladder[place.rung]);
  double& correction = knowledge.correction[place.rung];
  place.sampling_ms.add(sampling_ms);
  ++place.frames;
  if (!knowledge.compared || place.frames > kept) {
    knowledge.full_ms.add(sampling_ms / (share * correction));
    return;
  }
  const double measured = place.sampling_ms.median();
  const bool far_over = place.frames > 1 && measured > 1.3 * budget_ms;
  if (place.frames == kept || far_over) {
    constexpr double most = 8;
    correction = std::clamp(measured / (knowledge.full_ms.median() * share), 1 / most, most);
    knowledge.learnt_at_ms[place.rung] = knowledge.full_ms.median();
    place.frames = kept;
  }
}

// A whole frame that takes clearly less than its fixed part alone is said to: that was measured where something
// else took the time, as the first frame of all does, whose shaders are made. While the view moves no frame without
// the volume is drawn that would show it, and all else was learnt beside it.
void Governor::forget_what_cannot_be(double frame_ms) {
  constexpr double clearly = 0.8;
  if (fixed_ms_.empty() || frame_ms > clearly * fixed_ms_.median())
    return;
  fixed_ms_.clear();
  knowledge_ = {};
}

void Governor::note(hal::Duration cost, bool volume_drawn) {
  const double ms = hal::to_ms(cost);
  if (!volume_drawn) {
    fixed_ms_.add(ms);
    return;
  }
  if (still_)
    return;
  forget_what_cannot_be(ms);
  constexpr double least_ms = 0.01;
  const double fixed = fixed_ms_.empty() ? 0 : fixed_ms_.median();
  Place& place = places_[technique_][moving_ ? 1 : 0];
  place.frame_ms.add(ms);
  learn(place, knowledge_[technique_], std::max(ms - fixed, least_ms), budget_ms());
}

} // namespace octascope::ui

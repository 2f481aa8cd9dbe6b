#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/files/fresh_seed.h"
#include "ui/pacing/governor.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using ui::Governor;
using ui::Technique;

constexpr ui::FrameBudget budget{30ms, 45ms};

// What drawing costs on a made-up machine: not the governor's own model.
struct Machine {
  double fixed_ms = 4;
  double volume_ms = 0; // for a picture of the volume, of any quality
  double full_ms = 60;
  double exponent = 1; // of the share of samples: 1 is the governor's model
  double noise = 0;    // standard deviation of the logarithm
  double spikes = 0;   // share of frames that are interrupted, for ten times as long

  double true_ms(const ui::DrawQuality& quality) const {
    return fixed_ms + volume_ms + full_ms * std::pow(ui::sample_share(quality), exponent);
  }
  template <class Generator>
  double frame_ms(const ui::DrawQuality& quality, Generator& generator) const {
    double ms = true_ms(quality);
    if (noise > 0)
      ms *= std::lognormal_distribution{0.0, noise}(generator);
    if (std::uniform_real_distribution{}(generator) < spikes)
      ms *= 10;
    return ms;
  }
};

class GovernorTest : public testing::Test {
protected:
  // Draws for `seconds`; returns the quality of every frame.
  std::vector<ui::DrawQuality> draw(const Machine& machine, double seconds, bool moving,
                                    bool live = true, bool cast = false) {
    std::vector<ui::DrawQuality> drawn;
    const hal::TimePoint end = now_ + hal::from_seconds(seconds);
    while (now_ < end) {
      const auto quality = governor_.choose({now_, Technique::rays, moving, live, cast});
      const hal::Duration cost = hal::from_seconds(machine.frame_ms(quality, generator_) * 1e-3);
      governor_.note(cost, true);
      governor_.note(hal::from_seconds(machine.fixed_ms * 1e-3), false);
      now_ += std::max<hal::Duration>(cost, moving ? 16ms : 141ms);
      drawn.push_back(quality);
    }
    return drawn;
  }

  Governor governor_{budget};
  std::mt19937_64 generator_{fresh_seed()};
  hal::TimePoint now_{1h};
};

int changes(const std::vector<ui::DrawQuality>& drawn) {
  int count = 0;
  for (std::size_t i = 1; i < drawn.size(); ++i)
    count += drawn[i] == drawn[i - 1] ? 0 : 1;
  return count;
}

TEST(QualityLadder, goes_down_in_steps_that_are_neither_steep_nor_useless) {
  const auto ladder = ui::quality_ladder();
  EXPECT_EQ(ladder.front(), ui::full_quality);
  EXPECT_DOUBLE_EQ(ui::sample_share(ui::full_quality), 1);
  for (std::size_t i = 1; i < ladder.size(); ++i) {
    const double step = ui::sample_share(ladder[i]) / ui::sample_share(ladder[i - 1]);
    EXPECT_LT(step, 0.9) << i;
    EXPECT_GT(step, 0.6) << i;
  }
}

TEST(FrameBudget, is_what_the_output_leaves_of_one_refresh_or_of_two) {
  const auto budget_of = [](const ui::DrawnHow& how) { return ui::frame_budget(10ms, how); };
  EXPECT_EQ(budget_of({}).moving, 8ms);
  EXPECT_EQ(budget_of({}).resting, 18ms);
  EXPECT_EQ(budget_of({.rolling = true}).resting, 8ms);
  EXPECT_EQ(budget_of({.software = true}).moving, 9ms);
  EXPECT_EQ(budget_of({.software = true, .waits_for_refresh = true}).moving, 18ms);
  EXPECT_EQ(budget_of({.software = true}).moving_cast, 20ms);
  EXPECT_EQ(budget_of({.software = true, .waits_for_refresh = true}).moving_cast, 18ms);
  EXPECT_EQ(budget_of({.software = true}).resting, 15ms);
  EXPECT_EQ(budget_of({.software = true, .rolling = true}).resting, 18ms);
  EXPECT_EQ(budget_of({.software = true, .rolling = true, .in_parts = true}).resting, 7ms);
}

TEST_F(GovernorTest, a_machine_that_can_draws_everything_in_full) {
  const Machine gpu{.fixed_ms = 0.5, .full_ms = 4};
  draw(gpu, 1, true);
  EXPECT_EQ(draw(gpu, 1, true).back(), ui::full_quality);
  EXPECT_EQ(changes(draw(gpu, 10, true)), 0);
}

TEST_F(GovernorTest, holds_the_budget_on_machines_of_any_speed_and_wastes_little) {
  std::uniform_real_distribution<double> full{20, 300};
  std::uniform_real_distribution<double> exponent{0.75, 1.25};
  for (int machine_index = 0; machine_index < 200; ++machine_index) {
    governor_ = Governor{budget};
    const Machine machine{.fixed_ms = 4,
                          .full_ms = full(generator_),
                          .exponent = exponent(generator_),
                          .noise = 0.08};
    SCOPED_TRACE(testing::Message() << machine.full_ms << " ms, exponent " << machine.exponent);
    draw(machine, 5, true);
    const auto drawn = draw(machine, 20, true);
    const double ms = machine.true_ms(drawn.back());
    EXPECT_LT(ms, 30 * 1.12);
    if (drawn.back() != ui::full_quality) {
      EXPECT_GT(ms, 30 * 0.45);
    }
    EXPECT_LE(changes(drawn), 4) << "it swings";
  }
}

// What does not grow with the samples makes coarse qualities look dear: from there the governor
// must not believe that finer ones are dearer by as much.
TEST_F(GovernorTest, comes_back_from_the_coarsest_quality) {
  Machine machine{.volume_ms = 6, .full_ms = 400, .noise = 0.05};
  draw(machine, 4, true);
  machine.full_ms = 40;
  draw(machine, 4, true);
  EXPECT_GT(machine.true_ms(draw(machine, 0.5, true).back()), 15);
  EXPECT_LE(changes(draw(machine, 10, true)), 3);
}

TEST_F(GovernorTest, a_view_at_rest_is_not_blurred_for_a_fixed_part_that_nothing_makes_less) {
  const Machine machine{.fixed_ms = 100, .full_ms = 5};
  EXPECT_LT(ui::sample_share(draw(machine, 4, true).back()), 0.1);
  now_ += Governor::rest_after;
  for (int i = 0; i < 200; ++i) {
    const auto quality = governor_.choose({now_, Technique::rays, false, true, true});
    EXPECT_GE(quality.resolution, Governor::coarsest_at_rest.resolution);
    EXPECT_GE(quality.steps, Governor::coarsest_at_rest.steps);
    governor_.note(hal::from_seconds(machine.true_ms(quality) * 1e-3), true);
    now_ += 16ms;
  }
}

TEST_F(GovernorTest, moving_rays_are_not_blurred_for_a_fixed_part_while_frames_come_often_enough) {
  const Machine machine{.fixed_ms = 28, .full_ms = 80, .noise = 0.05};
  EXPECT_LT(ui::sample_share(draw(machine, 4, true).back()), 0.05);
  governor_ = Governor{{30ms, 45ms, 45ms}};
  draw(machine, 2, true, true, true);
  const auto drawn = draw(machine, 10, true, true, true);
  EXPECT_EQ(drawn.back(), Governor::coarsest_at_rest);
  EXPECT_EQ(changes(drawn), 0);

  const Machine slower{.fixed_ms = 42, .full_ms = 80, .noise = 0.05};
  draw(slower, 2, true, true, true);
  EXPECT_LT(ui::sample_share(draw(slower, 1, true, true, true).back()), 0.05);
  EXPECT_LE(changes(draw(slower, 10, true, true, true)), 3);
  draw(machine, 2, true, true, true);
  EXPECT_EQ(draw(machine, 1, true, true, true).back(), Governor::coarsest_at_rest) << "and back";
}

// As above, but of what is no frame's without the volume, so that it seems to be the samples' cost.
TEST_F(GovernorTest,
       moving_rays_become_as_fine_as_at_rest_whatever_a_picture_costs_beside_its_samples) {
  governor_ = Governor{{30ms, 45ms, 45ms}};
  Machine machine{.volume_ms = 20, .full_ms = 800, .noise = 0.05};
  EXPECT_LT(ui::sample_share(draw(machine, 4, true, true, true).back()), 0.05);
  machine.full_ms = 70;
  draw(machine, 2, true, true, true);
  auto drawn = draw(machine, 10, true, true, true);
  EXPECT_EQ(drawn.back(), Governor::coarsest_at_rest);
  EXPECT_EQ(changes(drawn), 0);

  machine.full_ms = 200; // 67 ms as at rest, 31 ms as coarse as it gets
  draw(machine, 2, true, true, true);
  drawn = draw(machine, 20, true, true, true);
  EXPECT_LT(ui::sample_share(drawn.back()), 0.05);
  EXPECT_LE(changes(drawn), 4) << "it is not tried again and again";
}

// As where shaders are made in the only frame that is drawn before volumes come and the view moves.
TEST_F(GovernorTest, a_first_frame_that_took_long_does_not_make_all_that_follow_coarse) {
  const Machine machine{.full_ms = 60, .noise = 0.05};
  for (const bool cast : {false, true}) {
    governor_ = Governor{budget};
    governor_.choose({now_, Technique::rays, true, true, cast});
    governor_.note(62ms, false);
    for (int i = 0; i < 100; ++i) {
      const auto quality = governor_.choose({now_, Technique::rays, true, true, cast});
      governor_.note(hal::from_seconds(machine.frame_ms(quality, generator_) * 1e-3), true);
      now_ += 16ms;
    }
    const auto quality = governor_.choose({now_, Technique::rays, true, true, cast});
    EXPECT_GT(machine.true_ms(quality), 30 * 0.45);
    EXPECT_LT(machine.true_ms(quality), 30 * 1.12);
  }
}

TEST_F(GovernorTest, interrupted_frames_change_nothing) {
  const Machine machine{.full_ms = 70, .noise = 0.05, .spikes = 0.02};
  draw(machine, 5, true);
  EXPECT_LE(changes(draw(machine, 60, true)), 4);
}

TEST_F(GovernorTest, follows_a_scene_that_becomes_more_costly_within_half_a_second) {
  Machine machine{.full_ms = 30};
  draw(machine, 3, true);
  machine.full_ms = 120;
  draw(machine, 0.5, true);
  EXPECT_LT(machine.true_ms(draw(machine, 0.1, true).back()), 33);
  machine.full_ms = 30;
  draw(machine, 0.5, true);
  EXPECT_GT(machine.true_ms(draw(machine, 0.1, true).back()), 15) << "and back";
}

TEST_F(GovernorTest, a_picture_that_stands_still_is_drawn_in_full_whatever_it_costs) {
  const Machine slow{.full_ms = 400};
  draw(slow, 3, true);
  EXPECT_LT(governor_.choose({now_, Technique::rays, true, false}).resolution, 1);
  now_ += Governor::rest_after;
  EXPECT_EQ(governor_.choose({now_, Technique::rays, false, false}), ui::full_quality);
  governor_.note(400ms, true);
  now_ += 400ms;
  EXPECT_LT(governor_.choose({now_, Technique::rays, true, false}).resolution, 1)
      << "and at once coarse again when the view moves";
}

TEST_F(GovernorTest, live_volumes_of_a_still_view_get_the_larger_budget) {
  const Machine machine{.full_ms = 60};
  draw(machine, 3, true);
  const auto moving = draw(machine, 0.2, true).back();
  draw(machine, 3, false);
  const auto resting = draw(machine, 1, false).back();
  EXPECT_GT(ui::sample_share(resting), ui::sample_share(moving));
  EXPECT_LT(machine.true_ms(resting), 45);
  EXPECT_EQ(draw(machine, 0.1, true).front(), moving) << "remembered";
}

} // namespace
} // namespace octascope::tests

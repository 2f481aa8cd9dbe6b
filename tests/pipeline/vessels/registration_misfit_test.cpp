#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/registration_misfit.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;

class RegistrationMisfit : public testing::Test {
protected:
  double number(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  }

  // Pairs spread over some 6 × 6 × 3 mm, marked with that error on each axis; `spoil` changes the
  // tree's points before. Turned at random, or not at all.
  std::vector<PointPair> pairs(std::size_t count, double noise_mm,
                               const std::function<void(Point&)>& spoil, bool turned = true) {
    std::normal_distribution<double> normal;
    RigidTransform turn;
    const double angle = turned ? number(-3, 3) : 0;
    turn.rotation = {{{std::cos(angle), -std::sin(angle), 0},
                      {0, 0, -1},
                      {std::sin(angle), std::cos(angle), 0}}};
    if (!turned)
      turn = {};
    turn.shift_mm = {number(-9, 9), number(-9, 9), number(-9, 9)};
    std::vector<PointPair> made;
    for (std::size_t i = 0; i < count; ++i) {
      Point tree{number(-3, 3), number(-3, 3), number(-1.5, 1.5)};
      Point volume = turn.apply(tree);
      for (double& c : volume)
        c += noise_mm * normal(random);
      spoil(tree);
      made.push_back({tree, volume});
    }
    return made;
  }

  static std::string misfit(const std::vector<PointPair>& pairs) {
    const auto found = register_points(pairs);
    if (!found) // lots may lie almost on a line
      return "not registered";
    return misfit_of(pairs, *found).value_or("");
  }

  std::mt19937_64 random{tests::fresh_seed()};
};

void scale(Point& p, double by) {
  for (double& c : p)
    c *= by;
}

TEST_F(RegistrationMisfit, says_which_scale_and_which_mirror) {
  struct Case {
    std::function<void(Point&)> spoil;
    const char* words;
  };
  for (const auto& [spoil, words] :
       {Case{[](Point& p) { scale(p, 1000); },
             "times as wide as the volume's: is the tree in micro"},
        {[](Point& p) { scale(p, 1e-3); }, "times as wide as the tree's: is the volume in micro"},
        {[](Point& p) { scale(p, 10); }, "is the volume in centimetres?"},
        {[](Point& p) { scale(p, 1.3); }, "the tree's points spread 1."},
        {[](Point& p) { p[0] = -p[0]; }, "one side is mirrored: does x run the other way? (a refl"},
        {[](Point& p) { p[2] = 7 - p[2]; },
         "one side is mirrored: does z run the other way? (a ref"},
        {[](Point& p) { std::swap(p[0], p[2]); }, "one side is mirrored: are x and z exchanged? ("},
        {[](Point& p) {
           scale(p, 1000);
           p[1] = -p[1];
         },
         "is the tree in micrometres?; and one side is mirrored: does y run the other way? ("}})
    // Few pairs may lie almost in a plane.
    for (const auto& [count, noise_mm] : {std::pair{5U, 0.0}, {10U, 0.01}, {12U, 0.03}, {50U, 0.1}})
      EXPECT_THAT(misfit(pairs(count, noise_mm, spoil, false)), HasSubstr(words))
          << count << " pairs, " << noise_mm << " mm";
  EXPECT_THAT(
      misfit(pairs(8, 0.02, [](Point& p) { p[0] = -p[0]; })),
      testing::AllOf(HasSubstr("one side is mirrored"), HasSubstr(" (a reflection leaves")));
}

// The number of pairs decides what a residual means: noise alone must not be told as a misfit.
TEST_F(RegistrationMisfit, takes_noise_for_noise) {
  for (const std::size_t count : {3U, 4U, 5U, 6U, 12U, 40U})
    for (const double noise_mm : {0.0, 0.01, 0.1, 0.3}) {
      int told = 0;
      constexpr int rounds = 100;
      for (int round = 0; round < rounds; ++round) {
        const std::string words = misfit(pairs(count, noise_mm, [](Point&) {}));
        told += !words.empty() && words != "not registered";
      }
      EXPECT_LE(told, 3) << count << " pairs, " << noise_mm << " mm";
    }
}

TEST_F(RegistrationMisfit, tells_pairs_that_do_not_belong_together) {
  const auto made = pairs(20, 0, [&](Point& p) {
    p = {number(-3, 3), number(-3, 3), number(-3, 3)};
  });
  EXPECT_THAT(misfit(made), HasSubstr("do the pairs belong together, line by line?"));
}

// Three points, and any others in a plane: a reflection of them is a turn.
TEST_F(RegistrationMisfit, cannot_tell_a_mirror_from_a_turn_in_a_plane) {
  for (const std::size_t count : {3U, 9U}) {
    auto made = pairs(
        count, 0, [](Point&) {}, false);
    for (PointPair& pair : made) {
      pair.volume[2] = 4 + 0.001 * number(-1, 1);
      pair.tree[0] = -pair.tree[0];
      pair.tree[2] = 0.001 * number(-1, 1);
    }
    EXPECT_THAT(misfit(made), testing::AnyOf("", "not registered"));
  }
}

} // namespace
} // namespace octascope::pipeline

#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/point_registration.h"
#include "pipeline/vessels/registration.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using ::testing::HasSubstr;

// Turned by the angles about z, y and x, one after the other.
RigidTransform turned(double a, double b, double c, Point shift) {
  const auto about = [](std::size_t axis, double angle) {
    RigidTransform turn;
    const std::size_t p = (axis + 1) % 3;
    const std::size_t q = (axis + 2) % 3;
    turn.rotation[p][p] = turn.rotation[q][q] = std::cos(angle);
    turn.rotation[q][p] = std::sin(angle);
    turn.rotation[p][q] = -std::sin(angle);
    return turn;
  };
  RigidTransform transform = about(0, c) * about(1, b) * about(2, a);
  transform.shift_mm = shift;
  return transform;
}

double difference(const RigidTransform& a, const RigidTransform& b) {
  double largest = 0;
  for (std::size_t row = 0; row < 3; ++row) {
    largest = std::max(largest, std::fabs(a.shift_mm[row] - b.shift_mm[row]));
    for (std::size_t column = 0; column < 3; ++column)
      largest = std::max(largest, std::fabs(a.rotation[row][column] - b.rotation[row][column]));
  }
  return largest;
}

class PointRegistrationTest : public ::testing::Test {
protected:
  double number(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  }
  Point point() { return {number(-5, 5), number(-5, 5), number(-5, 5)}; }
  RigidTransform transform() {
    return turned(number(-3, 3), number(-3, 3), number(-3, 3), point());
  }
  std::vector<PointPair> pairs(const RigidTransform& by, std::size_t count, double noise) {
    std::normal_distribution<double> normal;
    std::vector<PointPair> made;
    for (std::size_t i = 0; i < count; ++i) {
      const Point tree = point();
      Point volume = by.apply(tree);
      for (double& c : volume)
        c += noise * normal(random);
      made.push_back({tree, volume});
    }
    return made;
  }

  std::mt19937_64 random{tests::fresh_seed()};
};

TEST_F(PointRegistrationTest, finds_the_transform_of_exact_pairs) {
  for (int round = 0; round < 200; ++round) {
    const RigidTransform expected = transform();
    const std::size_t count = 3 + static_cast<std::size_t>(round % 5);
    const auto found = register_points(pairs(expected, count, 0));
    if (!found && count == 3) // three points drawn by lot may lie almost on a line
      continue;
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_LT(difference(found->volume_from_tree, expected), 1e-9);
    ASSERT_LT(found->largest_mm, 1e-9);
  }
}

TEST_F(PointRegistrationTest, finds_half_turns_and_flat_sets) {
  constexpr double pi = 3.14159265358979323846;
  for (const RigidTransform& expected :
       {turned(pi, 0, 0, {1, 2, 3}), turned(0, pi, 0, {0, 0, 0}), turned(0, 0, pi, {-1, 0, 4})}) {
    std::vector<PointPair> flat;
    for (const Point& p : {Point{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {5, 5, 0}})
      flat.push_back({p, expected.apply(p)});
    const auto found = tests::must(register_points(flat));
    EXPECT_LT(difference(found.volume_from_tree, expected), 1e-9);
  }
}

TEST_F(PointRegistrationTest, has_less_left_over_than_any_transform_beside_it) {
  const auto noisy = pairs(transform(), 6, 0.3);
  const auto found = tests::must(register_points(noisy));
  const auto squares = [&](const RigidTransform& by) {
    double sum = 0;
    for (const PointPair& pair : noisy) {
      const Point at = by.apply(pair.tree);
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum += std::pow(at[axis] - pair.volume[axis], 2);
    }
    return sum;
  };
  const double least = squares(found.volume_from_tree);
  EXPECT_NEAR(std::sqrt(least / 6), found.rms_mm, 1e-12);
  for (int i = 0; i < 200; ++i) {
    const RigidTransform beside =
        turned(number(-0.01, 0.01), number(-0.01, 0.01), number(-0.01, 0.01),
               {number(-0.01, 0.01), number(-0.01, 0.01), number(-0.01, 0.01)});
    EXPECT_GE(squares(beside * found.volume_from_tree), least);
  }
}

// Fitzpatrick, West, Maurer, IEEE Trans Med Imaging 17, 1998: the mean square of the residual is
// (1 - 2/N) of that of the points' own error.
TEST_F(PointRegistrationTest, leaves_the_residual_that_theory_says) {
  constexpr std::size_t count = 6;
  constexpr double noise = 0.01; // each axis
  double squares = 0;
  double left_out = 0;
  constexpr int rounds = 2000;
  for (int round = 0; round < rounds; ++round) {
    const auto found = tests::must(register_points(pairs(transform(), count, noise)));
    squares += found.rms_mm * found.rms_mm / rounds;
    ASSERT_EQ(found.left_out_mm.size(), count);
    left_out += *found.left_out_rms_mm / rounds;
  }
  EXPECT_NEAR(squares, (1 - 2.0 / count) * 3 * noise * noise, 0.04 * 3 * noise * noise);
  EXPECT_GT(left_out, std::sqrt(3) * noise); // the point's own error, and the fit's
}

TEST_F(PointRegistrationTest, leaves_each_pair_out) {
  auto marked = pairs(transform(), 8, 0);
  marked[3].volume[1] += 2; // one is marked wrongly
  const auto found = tests::must(register_points(marked));
  EXPECT_NEAR(found.left_out_mm[3], 2, 1e-9); // the others are exact
  EXPECT_LT(found.residuals_mm[3], 2);
  for (std::size_t i = 0; i < 8; ++i)
    if (i != 3) {
      EXPECT_GT(found.left_out_mm[i], 1e-3);
    }
  const auto three = register_points(std::vector<PointPair>{
      {{0, 0, 0}, {0, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {0, 1, 0}}});
  ASSERT_TRUE(three);
  EXPECT_TRUE(three->left_out_mm.empty());
}

TEST_F(PointRegistrationTest, refuses_points_about_which_the_tree_could_turn) {
  const auto refusal = [](std::vector<PointPair> pairs) {
    return tests::error_of(register_points(pairs)).message;
  };
  const Point o{0, 0, 0};
  EXPECT_THAT(refusal({}), HasSubstr("found 0 pairs of points, expected at least 3"));
  EXPECT_THAT(refusal({{o, o}, {{1, 0, 0}, {1, 0, 0}}}), HasSubstr("found 2 pairs"));
  EXPECT_THAT(refusal({{o, o}, {{1, 2, 3}, {1, 2, 3}}, {{2, 4, 6}, {2, 4, 6}}}),
              HasSubstr("the tree's points spread"));
  EXPECT_THAT(refusal({{o, o}, {o, o}, {o, o}}), HasSubstr("the tree's points spread 0 mm"));
  EXPECT_THAT(refusal({{o, o}, {{1, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {2, 0, 0}}}),
              HasSubstr("the volume's points spread"));
  // A cross and its mirror image: each half turn about one of the axes fits as well.
  EXPECT_THAT(refusal({{{1, 0, 0}, {-1, 0, 0}},
                       {{-1, 0, 0}, {1, 0, 0}},
                       {{0, 1, 0}, {0, -1, 0}},
                       {{0, -1, 0}, {0, 1, 0}},
                       {{0, 0, 1}, {0, 0, -1}},
                       {{0, 0, -1}, {0, 0, 1}}}),
              HasSubstr("two turns fit the points equally well"));
}

class RegistrationFile : public ::testing::Test {
protected:
  std::string refusal(std::string_view text) {
    std::filesystem::remove(folder / "r.toml"); // writing over it would wait for the disc
    const auto loaded = Registration::load(folder.write("r.toml", text));
    return loaded ? "not refused" : loaded.error().message;
  }
  tests::ScratchFolder folder;
};

TEST_F(RegistrationFile, gives_back_the_same_numbers) {
  Registration registration;
  registration.volume_from_tree = turned(0.3, -1.2, 2.2, {1.5, -20.25, 1.0 / 3});
  registration.provenance = {
      "octascope 1", "A. \"B\" C", "2026-11-21T10:00:00Z", "by hand", "pairs.csv", 6, 0.0125};
  ASSERT_TRUE(write_registration(registration, folder / "r.toml"));
  const auto loaded = tests::must(Registration::load(folder / "r.toml"));
  EXPECT_EQ(loaded.volume_from_tree, registration.volume_from_tree);
  EXPECT_EQ(loaded.provenance, registration.provenance);
  EXPECT_EQ(folder.count(), 1);
}

TEST_F(RegistrationFile, says_whose_vessels_they_are_as_far_as_somebody_said) {
  for (const PatientEye& whose : {PatientEye{"A \"B\" 4711", Eye::left}, PatientEye{"", Eye::right},
                                  PatientEye{"4711", Eye::not_said}, PatientEye{}}) {
    Registration registration;
    registration.whose = whose;
    ASSERT_TRUE(write_registration(registration, folder / "r.toml"));
    const auto loaded = tests::must(Registration::load(folder / "r.toml"));
    EXPECT_EQ(loaded.whose, whose);
    std::filesystem::remove(folder / "r.toml");
  }
  EXPECT_THAT(
      refusal("[registration]\nvolume_from_tree = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], "
              "[0, 0, 0, 1]]\n[whose]\neye = \"middle\"\n"),
      HasSubstr("eye is \"middle\", expected \"left\" or \"right\""));
}

TEST_F(RegistrationFile, needs_no_provenance) {
  EXPECT_EQ(refusal("[registration]\nvolume_from_tree = [[0, -1, 0, 2.5], [1, 0, 0, 0], "
                    "[0, 0, 1, -1], [0, 0, 0, 1]]\n"),
            "not refused");
}

TEST_F(RegistrationFile, refuses_what_is_not_rigid_and_what_it_does_not_know) {
  const auto matrix = [](std::string_view rows) {
    return "[registration]\nvolume_from_tree = " + std::string{rows} + "\n";
  };
  EXPECT_THAT(refusal(matrix("[[1.001,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")),
              HasSubstr("deviates from the identity by 0.002, expected at most 1e-05"));
  EXPECT_THAT(refusal(matrix("[[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,1]]")),
              HasSubstr("deviates from the identity by 1,"));
  EXPECT_THAT(refusal(matrix("[[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")), HasSubstr("mirrors"));
  EXPECT_THAT(refusal(matrix("[[1,0,0,1e9],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")),
              HasSubstr("shifts by 1000000000 mm"));
  EXPECT_THAT(refusal(matrix("[[1,0,0,0],[0,1,0,0],[0,0,1,0]]")), HasSubstr("3 rows, expected 4"));
  EXPECT_THAT(refusal(matrix("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[1,2,3,1]]")),
              HasSubstr("last row is another than [0, 0, 0, 1]"));
  EXPECT_THAT(refusal(matrix("[[1,0,0],[0,1,0],[0,0,1]]")), HasSubstr("4 numbers"));
  EXPECT_THAT(refusal(""), HasSubstr("volume_from_tree is missing"));
  EXPECT_THAT(refusal(matrix("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]") + "scale = 2\n"),
              HasSubstr("unknown key \"scale\""));
}

TEST_F(RegistrationFile, is_not_written_when_it_is_not_rigid) {
  Registration registration;
  registration.volume_from_tree.rotation[0][0] = 2;
  EXPECT_THAT(write_registration(registration, folder / "r.toml"),
              tests::FailsSaying("is not rigid"));
  EXPECT_EQ(folder.count(), 0);
}

TEST_F(RegistrationFile, takes_any_mutation_without_harm) {
  Registration registration;
  registration.volume_from_tree = turned(0.3, -1.2, 2.2, {1.5, -20.25, 3});
  ASSERT_TRUE(write_registration(registration, folder / "good.toml"));
  const std::string good = tests::whole_file(folder / "good.toml");
  std::mt19937_64 random{tests::fresh_seed()};
  int refused = 0;
  constexpr int rounds = 2000;
  for (int round = 0; round < rounds; ++round) {
    const std::string message = refusal(tests::mutate(good, random));
    if (message != "not refused") {
      ++refused;
      ASSERT_THAT(message, HasSubstr("r.toml"));
    }
  }
  EXPECT_GT(refused, rounds / 5);
}

TEST(VolumeFrame, turns_into_the_axes_of_pictures) {
  const VolumeGeometry geometry{512, 300, 80, 4, 10, 25}; // 2.048 mm deep, 3 × 2 mm
  const RigidTransform world = world_from_volume(geometry);
  const auto expect = [&](const Point& volume, const Point& expected) {
    const Point found = world.apply(volume);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(found[axis], expected[axis], 1e-12);
  };
  expect({0, 0, 0}, {-1.5, 1.024, -1});      // A-scan 0 at -x, depth 0 at +y, B-scan 0 at -z
  expect({3, 2, 2.048}, {1.5, -1.024, 1});   // the opposite corner
  expect({1.5, 1, 1.024}, {0, 0, 0});        // the middle
  expect({0, 0, 2.048}, {-1.5, -1.024, -1}); // deeper is down
  EXPECT_LT(difference(inverse(world) * world, RigidTransform{}), 1e-12);
}

} // namespace
} // namespace octascope::pipeline

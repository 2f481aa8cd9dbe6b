// octascope vessels register as a user runs it.
#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/registration.h"
#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

ProgramResult register_points(const ScratchFolder& folder, std::string_view points,
                              std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"vessels",  "register",
                                     "--points", folder.write("pairs.csv", points),
                                     "--out",    folder / "out.toml"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_octascope(std::move(arguments));
}

// A quarter turn about z and a shift by (1, 2, 3).
constexpr std::string_view good = "# tree x, y, z, volume x, y, z\n"
                                  "0, 0, 0,  1, 2, 3\n"
                                  "5; 0; 0;  1; 7; 3  # the first fork\n"
                                  "0 4 0 -3 2 3\n\n"
                                  "0\t0\t2\t1\t2\t5\n";

TEST(VesselsRegister, writes_a_registration_that_can_be_read) {
  const ScratchFolder folder;
  const ProgramResult result = register_points(
      folder, good, {"--author", "B. A. \"Z\"", "--subject", "4711", "--eye", "left", "--json"});
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  const json found = json::parse(result.out);
  EXPECT_EQ(found["points"], 4);
  EXPECT_NEAR(found["residual_mm"].get<double>(), 0, 1e-9);
  EXPECT_NEAR(found["left_out_mm"].get<double>(), 0, 1e-9);
  const auto loaded = pipeline::Registration::load(folder / "out.toml");
  ASSERT_TRUE(loaded) << loaded.error().message;
  const auto at = loaded->volume_from_tree.apply({1, 1, 1});
  EXPECT_NEAR(at[0], 0, 1e-9);
  EXPECT_NEAR(at[1], 3, 1e-9);
  EXPECT_NEAR(at[2], 4, 1e-9);
  EXPECT_EQ(loaded->provenance.author, "B. A. \"Z\"");
  EXPECT_EQ(loaded->provenance.points, 4);
  EXPECT_EQ(loaded->whose, (pipeline::PatientEye{"4711", pipeline::Eye::left}));
  EXPECT_EQ(loaded->provenance.source, "pairs.csv");
}

TEST(VesselsRegister, says_which_line_is_off) {
  const ScratchFolder folder;
  const ProgramResult result = register_points(folder, std::string{good} + "1 1 1 0 3 4.5\n");
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  EXPECT_THAT(result.out, HasSubstr("   7 ")); // its line in the file
  EXPECT_THAT(result.out, HasSubstr("mm rms over 5 pairs"));
}

// As the tree's points are in micrometres.
constexpr std::string_view in_um = "0 0 0 1 2 3\n5000 0 0 1 7 3\n0 4000 0 -3 2 3\n0 0 2000 1 2 5\n"
                                   "1000 1000 1000 0 3 4\n";

TEST(VesselsRegister, refuses_what_no_turn_and_shift_explains_unless_it_is_accepted) {
  const ScratchFolder folder;
  const ProgramResult refused = register_points(folder, in_um);
  EXPECT_EQ(refused.exit_status, 1);
  EXPECT_THAT(refused.err,
              HasSubstr("1000 times as wide as the volume's: is the tree in micrometres?"));
  EXPECT_THAT(refused.err, HasSubstr("--accept-misfit"));
  EXPECT_EQ(folder.count(), 1);
  const ProgramResult accepted = register_points(folder, in_um, {"--accept-misfit"});
  ASSERT_EQ(accepted.exit_status, 0) << accepted.describe();
  const auto loaded = pipeline::Registration::load(folder / "out.toml");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_THAT(loaded->provenance.method,
              HasSubstr("misfit accepted: the tree's points spread 1000"));
  EXPECT_GT(loaded->provenance.residual_mm.value_or(0), 1000);
}

TEST(VesselsRegister, registers_a_tree_to_the_one_that_is_seen_or_writes_nothing) {
  const ScratchFolder folder;
  const std::string seen = folder / "seen.swc";
  run_well({"vessels", "generate", "--phantom", "perfused", "--out", seen, "--registration",
            folder / "true.toml"});
  // The tree that is seen is in the phantom's frame here, and the planned one is the same.
  const json found = json::parse(run_well({"vessels", "register", "--tree", seen, "--to", seen,
                                           "--out", folder / "out.toml", "--author", "Z", "--json"})
                                     .out);
  EXPECT_GT(found["overlap"], 0.97);
  EXPECT_LT(found["residual_mm"], 0.005);
  const auto loaded = pipeline::Registration::load(folder / "out.toml");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->provenance.author, "Z");
  EXPECT_EQ(loaded->provenance.source, "seen.swc to seen.swc");
  for (const double shift : loaded->volume_from_tree.shift_mm)
    EXPECT_NEAR(shift, 0, 0.005);
  // From 1.5 mm beside, it is found no more.
  const ProgramResult refused =
      run_octascope({"vessels", "register", "--tree", seen, "--to", seen, "--start",
                     folder / "true.toml", "--out", folder / "no.toml"});
  EXPECT_EQ(refused.exit_status, 1);
  EXPECT_THAT(refused.err, HasSubstr("not registered to"));
  EXPECT_FALSE(std::filesystem::exists(folder / "no.toml"));
  EXPECT_EQ(run_octascope({"vessels", "register", "--tree", seen, "--out", folder / "no.toml"})
                .exit_status,
            2);
}

TEST(VesselsRegister, refuses_bad_points_and_writes_nothing) {
  const auto refuse = [](std::string_view points, std::string_view expected) {
    const ScratchFolder folder;
    const ProgramResult result = register_points(folder, points);
    EXPECT_EQ(result.exit_status, 1) << result.describe();
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr(std::string{expected}));
    EXPECT_THAT(result.err, HasSubstr("pairs.csv"));
    EXPECT_EQ(folder.count(), 1);
  };
  refuse("0 0 0 1 2 3\n1 0 0 2 2\n", "pairs.csv:2: found \"1 0 0 2 2\"");
  refuse("0 0 0 1 2 3\n1 0 0 nan 2 3\n", "pairs.csv:2");
  refuse("0 0 0 1 2 3\n1 0 0 2 2 3\n", "found 2 pairs of points, expected at least 3");
  refuse("0 0 0 1 2 3\n1 0 0 2 2 3\n2 0 0 3 2 3\n", "the tree could turn about the line");
  refuse("0 0 0 1 2 3\n1 0 0 2 2 3\n2 0 -3e200 3 2 3\n",
         "pairs.csv:3: found the coordinate -3e+200 mm, expected at most 1e+06 mm");
  refuse("0 0 0 1 2 3\n1 0 0 1e999 2 3\n", "pairs.csv:2");
  refuse("", "is empty");
  EXPECT_EQ(run_octascope({"vessels", "register"}).exit_status, 2);
  EXPECT_EQ(run_octascope({"vessels"}).exit_status, 2);
}

} // namespace
} // namespace octascope::tests

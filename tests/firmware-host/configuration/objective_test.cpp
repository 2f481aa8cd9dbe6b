#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/devices/twins.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::firmware_host {
namespace {

using testing::HasSubstr;

constexpr const char* lenses = R"([[objective]]
name = "f 200 mm"
a_mm = 6
b_mm = 4
[[objective]]
name = "f 175 mm"
a_mm = 4.5
calibration = "f175.toml"
window_offset_db = 12
window_size_db = 30
)";

class Objectives : public testing::Test {
protected:
  hal::Result<Configuration> load(const std::string& text) const {
    return load_configuration(folder_.write("c.toml", text));
  }
  std::string complaint(const std::string& text) const {
    const auto read = load(text);
    return read ? "none" : read.error().message;
  }
  tests::ScratchFolder folder_;
};

TEST_F(Objectives, give_the_scan_its_size_and_so_the_picture_its_scale) {
  const auto c =
      tests::must(load(std::string{"[microscope]\nobjective = \"f 200 mm\"\n"
                                   "[scan]\na_scans = 300\nb_scans = 80\na_spacing_um = 1\n"} +
                       lenses));
  const pipeline::ScanPlan plan = plan_of({}, c);
  EXPECT_DOUBLE_EQ(plan.a_spacing_um, 20) << "6 mm by 300 A-scans";
  EXPECT_DOUBLE_EQ(plan.b_spacing_um, 50) << "4 mm by 80 B-scans";
  EXPECT_FALSE(c.calibration);
  EXPECT_FALSE(c.window);
}

TEST_F(Objectives, leave_what_they_do_not_name_and_come_before_the_rest) {
  const auto c =
      tests::must(load(std::string{"[microscope]\nobjective = \"f 175 mm\"\n"
                                   "[scan]\nb_spacing_um = 31\n[calibration]\nfile = \"any.toml\"\n"
                                   "[display]\nwindow_offset_db = 1\nwindow_size_db = 2\n"} +
                       lenses));
  const pipeline::ScanPlan plan = plan_of({}, c);
  EXPECT_DOUBLE_EQ(plan.a_spacing_um, 15);
  EXPECT_DOUBLE_EQ(plan.b_spacing_um, 31);
  EXPECT_EQ(c.calibration, folder_ / "f175.toml");
  ASSERT_TRUE(c.window);
  EXPECT_EQ(c.window->offset_db, 12);
  EXPECT_EQ(c.window->size_db, 30);
}

TEST_F(Objectives, are_never_guessed) {
  EXPECT_THAT(complaint(lenses),
              HasSubstr("objective is missing, expected one of \"f 200 mm\", \"f 175 mm\""));
  EXPECT_THAT(complaint(std::string{"[microscope]\nobjective = \"f 300 mm\"\n"} + lenses),
              HasSubstr("objective is \"f 300 mm\", expected one of"));
  EXPECT_THAT(complaint("[microscope]\nobjective = \"f 200 mm\"\n"),
              HasSubstr("there is no [[objective]]"));
}

TEST_F(Objectives, are_refused_where_one_is_wrong) {
  const std::string chosen = "[microscope]\nobjective = \"a\"\n[[objective]]\nname = \"a\"\n";
  EXPECT_EQ(complaint(chosen), "none");
  EXPECT_THAT(complaint(chosen + "a_mm = 0\n"), HasSubstr("a_mm is 0"));
  EXPECT_THAT(complaint(chosen + "window_size_db = 3\n"), HasSubstr("go together"));
  EXPECT_THAT(complaint(chosen + "[[objective]]\nname = \"a\"\n"), HasSubstr("twice"));
  EXPECT_THAT(complaint(chosen + "[[objective]]\na_mm = 3\n"), HasSubstr("name is missing"));
  EXPECT_THAT(complaint(chosen + "focus_mm = 200\n"), HasSubstr("unknown key \"focus_mm\""));
}

// A spacing of somebody else's is in a medium of somebody else's.
TEST(MediumOf, a_plan_is_the_calibrations_where_its_depths_are) {
  pipeline::Calibration calibration = pipeline::Calibration::identity(1024);
  calibration.depth_spacing_um = 2.54;
  calibration.refractive_index = 1.38;
  pipeline::ScanPlan plan;
  plan.depth_spacing_um = 2.54;
  EXPECT_EQ(medium_of(plan, calibration), 1.38);
  for (const double written_shorter : {2.53996, 2.541})
    EXPECT_EQ(medium_of({.depth_spacing_um = written_shorter}, calibration), 1.38)
        << written_shorter;
  for (const double of_another : {3.5, 2.54 * 1.336 / 1.33})
    EXPECT_FALSE(medium_of({.depth_spacing_um = of_another}, calibration)) << of_another;
}

} // namespace
} // namespace octascope::firmware_host

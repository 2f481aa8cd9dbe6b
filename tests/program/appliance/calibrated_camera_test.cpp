// A calibration that names its camera, in the built program: docs/HAZARDS.md, row 40.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr const char* unplugged_and_exchanged = "[[fault]]\ndevice = \"line_camera\"\n"
                                                "kind = \"unplug\"\nat_s = 0.0\n"
                                                "duration_s = 0.2\ncomes_back_as = \"another\"\n";

class CalibratedCamera : public testing::Test {
protected:
  // A run with a calibration that names this camera; empty: none.
  ProgramResult run(const std::string& camera, const std::string& faults = "") {
    const auto calibration = folder.write(
        "c.toml", fmt::format("[spectrometer]\nsamples = 128\n{}[k_linear]\npolynomial = [0.0, "
                              "127.0]\n",
                              camera.empty() ? "" : "camera = \"" + camera + "\"\n"));
    std::vector<std::string> more{"--calibration", calibration, "--duration", "1.6",
                                  "--report",      report,      "--snapshot", snapshot};
    if (!faults.empty())
      more.insert(more.end(), {"--faults", folder.write("faults.toml", faults)});
    ProgramResult result = run_well(small_run(folder, more));
    told = read_report(report);
    return result;
  }
  int marks() const {
    const pipeline::Image picture = read_snapshot(snapshot);
    return count_colour(picture, badge_row(picture), ui::palette::warning);
  }

  ScratchFolder folder;
  const std::string report = folder / "report.json";
  const std::string snapshot = folder / "picture.png";
  json told;
};

TEST_F(CalibratedCamera, that_is_another_one_is_marked_to_the_end) {
  run("Octoplus, serial 7");
  EXPECT_EQ(told.at("calibration").at("camera"), "Octoplus, serial 7");
  EXPECT_EQ(told.at("calibration").at("line_camera"), "simulated spectrometer");
  EXPECT_EQ(told.at("calibration").at("verdict"), "another");
  const json fault = find_fault(told, "line_camera", "another_camera");
  ASSERT_FALSE(fault.is_null()) << told.dump(2);
  EXPECT_EQ(fault.at("count"), 1);
  EXPECT_LT(fault.at("last_s"), 1.0) << "the mark is there although the fault is over";
  EXPECT_GT(marks(), 3);
  EXPECT_GE(told.at("volumes").at("displayed"), 3) << "the picture is not interrupted";
}

TEST_F(CalibratedCamera, that_comes_back_as_another_one_is_found_out) {
  run("simulated spectrometer", unplugged_and_exchanged);
  EXPECT_EQ(told.at("calibration").at("line_camera"), "another");
  EXPECT_EQ(told.at("calibration").at("verdict"), "another");
  EXPECT_GT(marks(), 3);
}

TEST_F(CalibratedCamera, that_is_the_right_one_has_no_mark) {
  const ProgramResult result = run("simulated spectrometer");
  EXPECT_EQ(told.at("calibration").at("verdict"), "same");
  EXPECT_TRUE(find_fault(told, "line_camera", "another_camera").is_null());
  EXPECT_THAT(result.err, Not(HasSubstr("names no camera")));
}

TEST_F(CalibratedCamera, that_nobody_names_is_said_once_and_marks_nothing) {
  const ProgramResult result = run("");
  EXPECT_EQ(told.at("calibration").at("verdict"), "unknown");
  EXPECT_TRUE(find_fault(told, "line_camera", "another_camera").is_null());
  EXPECT_THAT(result.err, HasSubstr("c.toml names no camera"));
}

} // namespace
} // namespace octascope::tests

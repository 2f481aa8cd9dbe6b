// A vessel tree in the volume's picture, as a user sees it: render and run with --vessels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/files/nrrd.h"
#include "tests/program/program_support.h"
#include "tests/support/files/small_recording.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;

// One straight vessel of 1.2 mm, in µm, as SWC has it; 18 is the LCX.
constexpr std::string_view vessel = "1 18 0 0 0 150 -1\n2 18 1200 0 0 150 1\n";

std::string registration_at(double x_mm, double y_mm, double z_mm) {
  return "[registration]\nvolume_from_tree = [[1, 0, 0, " + std::to_string(x_mm) + "], [0, 1, 0, " +
         std::to_string(y_mm) + "], [0, 0, 1, " + std::to_string(z_mm) + "], [0, 0, 0, 1]]\n";
}

class VesselOverlayProgram : public testing::Test {
protected:
  // Nothing but noise below the window.
  void SetUp() override {
    const pipeline::VolumeGeometry geometry{40, 40, 32, 30, 40, 50};
    ASSERT_TRUE(pipeline::write_nrrd(folder_ / "volume.nrrd",
                                     {geometry, std::vector<float>(geometry.voxels(), 0)}));
    folder_.write("tree.swc", vessel);
  }

  ProgramResult run_render(std::vector<std::string> more) const {
    std::vector<std::string> words{"render",           "--volume", folder_ / "volume.nrrd",
                                   "--window",         "10,40",    "--size",
                                   "200x120",          "--yaw",    "0",
                                   "--tilt",           "0",        "--out",
                                   folder_ / "out.png"};
    words.insert(words.end(), more.begin(), more.end());
    return run_octascope(words, 60s);
  }

  void record(const std::string& subject, pipeline::Eye eye) const {
    pipeline::RecordingFacts facts = small_recording_facts();
    facts.subject = subject;
    facts.eye = eye;
    auto writer = pipeline::RecordingWriter::create(folder_ / "eye.h5", facts);
    ASSERT_TRUE(writer) << writer.error().message;
    append_small_volumes(*writer, 0, 1);
    ASSERT_TRUE(writer->finish({}));
  }

  // Bluish pixels: the LCX.
  static int vessel_pixels(const pipeline::Image& picture, const ui::Rect& rect) {
    int count = 0;
    for (int y = rect.y; y < rect.bottom(); ++y)
      for (int x = rect.x; x < rect.right(); ++x) {
        const auto* pixel =
            picture.pixels.data() + 3 * (static_cast<std::size_t>(y * picture.width + x));
        count += pixel[2] > pixel[0] + 40 ? 1 : 0;
      }
    return count;
  }

  ScratchFolder folder_;
};

TEST_F(VesselOverlayProgram, a_registered_tree_lies_where_the_registration_says) {
  const std::string middle = folder_.write("middle.toml", registration_at(0.2, 0.8, 0.6));
  const std::string deep = folder_.write("deep.toml", registration_at(0.2, 0.8, 1.1));
  ProgramResult result = run_render({"--vessels", folder_ / "tree.swc", "--registration", middle});
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  EXPECT_EQ(result.err, "");
  const pipeline::Image first = read_snapshot(folder_ / "out.png");
  EXPECT_GT(vessel_pixels(first, {60, 40, 80, 40}), 200);
  result = run_render({"--vessels", folder_ / "tree.swc", "--registration", deep});
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  const pipeline::Image second = read_snapshot(folder_ / "out.png");
  EXPECT_EQ(vessel_pixels(second, {60, 0, 80, 60}), 0) << "deeper is lower on the screen";
  EXPECT_GT(vessel_pixels(second, {60, 60, 80, 60}), 200);
}

TEST_F(VesselOverlayProgram, opacity_and_colours_are_the_users_choice) {
  const std::string place = folder_.write("middle.toml", registration_at(0.2, 0.8, 0.6));
  const auto render = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--vessels", folder_ / "tree.swc", "--registration", place});
    const ProgramResult result = run_render(more);
    EXPECT_EQ(result.exit_status, 0) << result.describe();
    return read_snapshot(folder_ / "out.png");
  };
  const pipeline::Image opaque = render({});
  const pipeline::Image faint = render({"--vessel-opacity", "0.3"});
  const pipeline::Image none = render({"--vessel-opacity", "0"});
  const ui::Rect all{60, 30, 80, 60};
  EXPECT_GT(vessel_pixels(opaque, all), 200);
  EXPECT_LT(vessel_pixels(faint, all), vessel_pixels(opaque, all) / 2);
  EXPECT_EQ(vessel_pixels(none, all), 0);
  EXPECT_NE(render({"--vessel-colours", "order"}).pixels, opaque.pixels);
}

TEST_F(VesselOverlayProgram, an_unregistered_tree_says_so) {
  const ProgramResult result = run_render({"--vessels", folder_ / "tree.swc"});
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  EXPECT_THAT(result.err, HasSubstr("tree.swc is not registered"));
  const pipeline::Image marked = read_snapshot(folder_ / "out.png");
  EXPECT_GT(vessel_pixels(marked, {60, 40, 80, 40}), 200) << "its middle is the volume's";
  ASSERT_EQ(run_render({"--vessels", folder_ / "tree.swc", "--vessel-opacity", "0"}).exit_status,
            0);
  const pipeline::Image unmarked = read_snapshot(folder_ / "out.png");
  EXPECT_GT(count_different(marked, unmarked, {0, 0, 200, 20}, 40), 20) << "the mark";
}

TEST_F(VesselOverlayProgram, wrong_use_is_refused) {
  EXPECT_EQ(run_render({"--registration", folder_ / "r.toml"}).exit_status, 2);
  EXPECT_EQ(run_render({"--vessels", folder_ / "tree.swc", "--vessel-opacity", "2"}).exit_status,
            2);
  ProgramResult result = run_render({"--vessels", folder_ / "nowhere.swc"});
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.err, HasSubstr("nowhere.swc"));
  folder_.write("bad.toml", "[registration]\nvolume_from_tree = [[2, 0, 0, 0], [0, 1, 0, 0], "
                            "[0, 0, 1, 0], [0, 0, 0, 1]]\n");
  result = run_render({"--vessels", folder_ / "tree.swc", "--registration", folder_ / "bad.toml"});
  EXPECT_NE(result.exit_status, 0);
  EXPECT_THAT(result.err, HasSubstr("bad.toml"));
  result = run_octascope(small_run(folder_, {"--volumes", "1", "--vessels", folder_ / "tree.swc",
                                             "--registration", folder_ / "bad.toml"}),
                         60s);
  EXPECT_NE(result.exit_status, 0) << "a tree in a wrong place would mislead";
  EXPECT_THAT(result.err, HasSubstr("bad.toml"));
}

TEST_F(VesselOverlayProgram, another_eyes_vessels_are_refused) {
  folder_.write("left.toml",
                registration_at(0.2, 0.8, 0.6) + "[whose]\nsubject = \"4711\"\neye = \"left\"\n");
  const auto show = [&](const std::string& eye) {
    return run_octascope(
        small_run(folder_, {"--volumes", "1", "--subject", "4711", "--eye", eye, "--vessels",
                            folder_ / "tree.swc", "--registration", folder_ / "left.toml"}),
        60s);
  };
  const ProgramResult own = show("left");
  EXPECT_EQ(own.exit_status, 0) << own.describe();
  const ProgramResult others = show("right");
  EXPECT_EQ(others.exit_status, 2) << others.describe();
  EXPECT_THAT(others.err,
              HasSubstr("those of subject 4711, left eye, expected those in the picture, "
                        "of subject 4711, right eye"));
}

TEST_F(VesselOverlayProgram, another_eyes_vessels_are_not_drawn_into_a_recording) {
  folder_.write("left.toml",
                registration_at(0.2, 0.8, 0.6) + "[whose]\nsubject = \"4711\"\neye = \"left\"\n");
  const auto render = [&](pipeline::Eye eye) {
    record("4711", eye);
    return run_octascope({"render", "--volume", folder_ / "eye.h5", "--size", "200x120",
                          "--vessels", folder_ / "tree.swc", "--registration",
                          folder_ / "left.toml", "--out", folder_ / "eye.png"},
                         60s);
  };
  const ProgramResult own = render(pipeline::Eye::left);
  EXPECT_EQ(own.exit_status, 0) << own.describe();
  std::filesystem::remove(folder_ / "eye.h5");
  std::filesystem::remove(folder_ / "eye.png");
  const ProgramResult others = render(pipeline::Eye::right);
  EXPECT_EQ(others.exit_status, 2) << others.describe();
  EXPECT_THAT(others.err, HasSubstr("left.toml: [whose] says that the vessels are those of subject "
                                    "4711, left eye, expected those in the picture, of subject "
                                    "4711, right eye"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "eye.png"));
}

TEST_F(VesselOverlayProgram, a_display_without_its_tree_goes_on_and_says_why) {
  folder_.write("broken.swc", "1 3 0 0 0 1 -1\n2 3 1 0 0 x 1\n");
  run_well(small_run(folder_, {"--volumes", "4", "--vessels", folder_ / "broken.swc", "--report",
                               folder_ / "report.json", "--snapshot", folder_ / "last.png"}),
           60s);
  const json report = read_report(folder_ / "report.json");
  EXPECT_GE(report["volumes"]["published"].get<int>(), 4);
  const json fault = find_fault(report, "vessels", "not_shown");
  ASSERT_FALSE(fault.is_null());
  EXPECT_THAT(fault["message"].get<std::string>(), HasSubstr("broken.swc:2"));
}

TEST_F(VesselOverlayProgram, a_running_display_shows_the_tree_and_that_it_is_not_registered) {
  const auto last = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--volumes", "5", "--snapshot", folder_ / "last.png"});
    run_well(small_run(folder_, more), 60s);
    return read_snapshot(folder_ / "last.png");
  };
  const pipeline::Image with = last({"--vessels", folder_ / "tree.swc"});
  const pipeline::Image without = last({});
  const ui::Rect view = layout_of(with).view;
  EXPECT_GT(vessel_pixels(with, view), vessel_pixels(without, view) + 50);
  EXPECT_GT(count_different(with, without, badge_row(with), 40), 100) << "the badge";
}

} // namespace
} // namespace octascope::tests

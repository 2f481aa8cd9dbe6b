// The window under an X server without a screen: the same picture as offscreen, steered by keys,
// and its end ends the program.
#include <cstdlib>
#include <memory>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "tests/support/pictures/virtual_screen.h"
#include "tests/support/pictures/window_close.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;

constexpr int attempts = 5; // a machine that is held up may show a picture that is marked STALE

// A slanted layer below a flat one; a recording, so each volume is the same.
std::string write_recording(const ScratchFolder& folder) {
  std::vector<std::uint16_t> counts;
  for (int b = 0; b < small_b_scans; ++b) {
    for (int a = 0; a < small_a_scans; ++a) {
      const double slanted = 16 + a * 0.5 + b * 0.8; // depth bins
      for (int i = 0; i < 128; ++i) {
        const double phase = 2 * std::numbers::pi * i / 128;
        const double envelope = 0.5 - 0.5 * std::cos(phase);
        const double value = 2000 + envelope * (500 * std::cos(10 * phase + 0.3 * a) +
                                                700 * std::cos(slanted * phase + 0.9 * b));
        counts.push_back(static_cast<std::uint16_t>(value));
      }
    }
  }
  return folder.write_values<std::uint16_t>("recording.raw", counts);
}

class Window : public testing::Test {
protected:
  void SetUp() override {
    if (!screen_.running())
      GTEST_SKIP() << screen_.problem();
    if (!program_exists("xdotool"))
      GTEST_SKIP() << "no xdotool here to press keys with";
  }

  std::vector<std::string> play(const std::string& display, std::vector<std::string> more) {
    std::vector<std::string> words{"run",
                                   "--config",
                                   write_small_configuration(folder_),
                                   "--spectra",
                                   recording_,
                                   "--shape",
                                   fmt::format("{},{},128", small_b_scans, small_a_scans),
                                   "--display",
                                   display,
                                   "--size",
                                   fmt::format("{}x{}", small_width, small_height),
                                   "--snapshot",
                                   snapshot_,
                                   "--report",
                                   report_};
    words.insert(words.end(), more.begin(), more.end());
    return octascope_command(std::move(words));
  }

  static bool is_unmarked(const pipeline::Image& picture) {
    return !picture.pixels.empty() &&
           count_colour(picture, badge_row(picture), ui::palette::warning) == 0 &&
           count_colour(picture, badge_row(picture), ui::palette::alarm) == 0 &&
           count_colour(picture, badge_row(picture), ui::palette::quiet_text) == 0;
  }

  // A picture of three volumes in, with no mark of a busy machine on it.
  pipeline::Image picture_on(const std::string& display) {
    pipeline::Image picture;
    for (int i = 0; i < attempts && !is_unmarked(picture); ++i) {
      const ProgramResult result = run_program(play(display, {"--volumes", "3"}));
      if (result.exit_status != 0) {
        ADD_FAILURE() << result.describe();
        return {};
      }
      picture = read_snapshot(snapshot_);
    }
    EXPECT_TRUE(is_unmarked(picture)) << display;
    return picture;
  }

  // Starts in the window and waits until volumes are shown; null, and a failed test, if it ends.
  std::unique_ptr<ProgramRun> start() {
    auto run = std::make_unique<ProgramRun>(play("window", {"--duration", "100"}));
    const bool started = run->wait_for_thread("octa-camera", 60s);
    std::this_thread::sleep_for(sanitized ? 4s : 1s);
    if (started && run->running())
      return run;
    ADD_FAILURE() << run->wait(1s).describe();
    return nullptr;
  }

  // Runs xdotool on the window; what it prints.
  static std::string on_window(const std::string& action) {
    const ProgramResult result = run_program(
        {"sh", "-c", "xdotool search --sync --onlyvisible --name '^octascope$' " + action}, 60s);
    EXPECT_EQ(result.exit_status, 0) << result.describe();
    return result.out;
  }

  VirtualScreen screen_;
  ScratchFolder folder_;
  std::string recording_ = write_recording(folder_);
  std::string snapshot_ = folder_ / "picture.png";
  std::string report_ = folder_ / "report.json";
};

TEST_F(Window, shows_what_offscreen_shows) {
  const pipeline::Image window = picture_on("window");
  EXPECT_EQ(read_report(report_)["devices"]["display"], "window");
  const pipeline::Image offscreen = picture_on("offscreen");
  ASSERT_EQ(window.width, offscreen.width);
  ASSERT_EQ(window.height, offscreen.height);
  // Above the status bar, whose figures are of the moment: in the panels, no channel of any pixel
  // is off by more than two counts of 255. How finely the volume is drawn is of the moment, too.
  const ui::Layout layout = layout_of(window);
  const int height = layout.status_bar.y;
  const ui::Rect panels{layout.view.right(), 0, window.width - layout.view.right(), height};
  EXPECT_EQ(count_different(window, offscreen, panels, 2), 0);
  EXPECT_LT(count_different(window, offscreen, layout.view, 60),
            layout.view.width * layout.view.height / 20);
}

TEST_F(Window, is_turned_by_keys_and_ended_by_q) {
  const pipeline::Image unturned = picture_on("offscreen");
  auto run = start();
  ASSERT_TRUE(run);
  on_window("windowfocus --sync key Left Left Left Left q");
  const ProgramResult result = run->wait(30s);
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  const pipeline::Image turned = read_snapshot(snapshot_);
  ASSERT_EQ(turned.width, unturned.width);
  const ui::Layout layout = layout_of(turned);
  // Without the badges above and the echo of the parameter below.
  const ui::Rect middle{layout.view.x + 8, layout.view.height / 4, layout.view.width - 16,
                        layout.view.height * 2 / 5};
  EXPECT_GT(count_different(turned, unturned, middle, 20), middle.width * middle.height / 50);
}

// However small it is made: live, and of a replay, whose status bar has fewer cells.
TEST_F(Window, made_small_and_large_again_goes_on) {
  const std::string recorded = folder_ / "recorded.h5";
  run_well({"record", "--sim", "--config", write_small_configuration(folder_), "--display",
            "offscreen", "--volumes", "1", "--out", recorded});
  for (const bool replay : {false, true}) {
    auto run = replay ? std::make_unique<ProgramRun>(octascope_command(
                            {"replay", recorded, "--display", "window", "--duration", "100"}))
                      : start();
    ASSERT_TRUE(run);
    ASSERT_TRUE(!replay || run->wait_for_thread("octa-replay", 60s));
    for (const char* size : {"300 200", "40 30", "1 1", "900 100", "800 450"})
      on_window(fmt::format("windowsize --sync {}", size));
    on_window("windowfocus --sync key q");
    const ProgramResult result = run->wait(30s);
    EXPECT_EQ(result.exit_status, 0) << result.describe();
  }
}

TEST_F(Window, closed_ends_the_program) {
  auto run = start();
  ASSERT_TRUE(run);
  const std::string id = on_window("");
  ASSERT_FALSE(id.empty());
  const auto closed = WallClock::now();
  EXPECT_EQ(close_window(std::getenv("DISPLAY"), static_cast<std::uint32_t>(std::stoul(id))), "");
  const ProgramResult result = run->wait(30s);
  EXPECT_EQ(result.exit_status, 0) << result.describe();
  EXPECT_LT(WallClock::now() - closed, sanitized ? 30s : 5s);
  EXPECT_GE(read_report(report_)["volumes"]["displayed"], 1);
}

// A lost display: the run goes on to its end, without a window.
TEST_F(Window, whose_server_goes_away_is_a_lost_display) {
  const std::string recording = folder_ / "recording.h5";
  ProgramRun run{octascope_command(
      {"record", "--sim", "--config", write_small_configuration(folder_), "--display", "window",
       "--duration", sanitized ? "12" : "6", "--out", recording, "--report", report_})};
  ASSERT_TRUE(run.wait_for_thread("octa-camera", 60s));
  std::this_thread::sleep_for(sanitized ? 4s : 1s);
  screen_.end();
  const ProgramResult result = run.wait(60s);
  EXPECT_EQ(result.exit_status, 0) << result.describe();
  EXPECT_THAT(result.out, testing::HasSubstr("the X server has gone away"));
  EXPECT_GE(read_report(report_)["volumes"]["displayed"], 1);
  run_well({"info", recording}); // finished
}

} // namespace
} // namespace octascope::tests

// As a service: a broken configuration does not take the picture away, what pedal and knob have set
// comes back, and what is edited is taken over.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "tests/support/files/mutation.h"
#include "tests/support/program/built_places.h"

namespace octascope::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;

constexpr ui::Colour warning = ui::palette::warning;

bool comes_true(const std::function<bool()>& condition) {
  const auto end = WallClock::now() + 60s;
  while (!condition() && WallClock::now() < end)
    std::this_thread::sleep_for(50ms);
  return condition();
}

class Service : public testing::Test {
protected:
  Service() {
    fs::create_directory(state());
    fs::create_directory(runtime());
  }

  fs::path state() const { return folder_ / "state"; }
  fs::path runtime() const { return folder_ / "runtime"; }
  fs::path report_file() const { return folder_ / "report.json"; }
  fs::path last_good() const { return state() / "last-good/octascope.toml"; }

  // The small configuration and more; a window that the first volume does not change.
  void configure(std::string_view more) const {
    std::ostringstream text;
    text << std::ifstream{write_small_configuration(folder_)}.rdbuf()
         << "[display]\nwindow_offset_db = 4\nwindow_size_db = 60\n"
         << more;
    folder_.write("octascope.toml", text.str());
  }
  std::vector<std::string> words(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"env", "STATE_DIRECTORY=" + state().string(),
                                 "RUNTIME_DIRECTORY=" + runtime().string()};
    std::vector<std::string> arguments{"run",        "--sim",
                                       "--config",   (folder_ / "octascope.toml").string(),
                                       "--display",  "offscreen",
                                       "--size",     "640x360",
                                       "--report",   report_file().string(),
                                       "--snapshot", (folder_ / "last.png").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    for (std::string& word : octascope_command(arguments))
      all.push_back(std::move(word));
    return all;
  }
  json run(const std::vector<std::string>& more = {"--volumes", "3"}) const {
    const ProgramResult result = run_program(words(more));
    EXPECT_EQ(result.exit_status, 0) << result.describe();
    return read_report(report_file());
  }
  ProgramResult ask(const std::vector<std::string>& more) const { // of the running one's status
    std::vector<std::string> all{"status", "--socket", (runtime() / "status.sock").string()};
    all.insert(all.end(), more.begin(), more.end());
    return run_octascope(all);
  }
  int marked_badge() const {
    const pipeline::Image picture = read_snapshot(folder_ / "last.png");
    return count_colour(picture, badge_row(picture), warning);
  }
  int marked_notice() const {
    const pipeline::Image picture = read_snapshot(folder_ / "last.png");
    return count_colour(picture, notice_row(picture), warning);
  }

  ScratchFolder folder_;
};

TEST_F(Service, runs_on_the_last_good_configuration_and_says_so) {
  configure("technique = \"maximum\"\n");
  EXPECT_EQ(find_fault(run(), "host", "configuration_refused"), nullptr);
  EXPECT_EQ(whole_file(last_good()), whole_file(folder_ / "octascope.toml"));

  configure("technique = \"raze\"\n");
  const json report = run();
  EXPECT_EQ(report["view"]["technique"], "maximum");
  const json fault = find_fault(report, "host", "configuration_refused");
  ASSERT_NE(fault, nullptr) << report.dump(2);
  EXPECT_THAT(fault["message"].get<std::string>(), HasSubstr("technique is \"raze\""));
  EXPECT_GT(marked_badge(), 3);
  EXPECT_GT(marked_notice(), 10);
  EXPECT_THAT(whole_file(last_good()), HasSubstr("maximum"))
      << "a broken one is never the last good";
}

TEST_F(Service, tells_which_configuration_it_uses) {
  configure("technique = \"maximum\"\n");
  run();
  configure("technique = \"raze\"\n");
  ProgramRun program{words({"--duration", "90"})};
  ASSERT_TRUE(comes_true([&] { return ask({}).exit_status == 0; }));
  EXPECT_THAT(ask({}).out,
              HasSubstr("REFUSED: the last good one is used, " + last_good().string()));
  const json status = json::parse(ask({"--json"}).out);
  EXPECT_EQ(status.at("configuration_state"), "last_good");
  EXPECT_EQ(status.at("configuration"), last_good().string());
  program.send_signal(SIGTERM);
  program.wait();
}

TEST_F(Service, without_a_good_configuration_shows_a_picture_and_says_so) {
  folder_.write("octascope.toml", "[display\n");
  const json report = run({"--duration", "6"}); // the built-in scan takes its time
  EXPECT_NE(find_fault(report, "host", "configuration_refused"), nullptr);
  EXPECT_GT(marked_badge(), 3);
#ifndef OCTASCOPE_SANITIZED // there the built-in scan is too much, and that is told first
  EXPECT_GT(marked_notice(), 10);
#endif
  EXPECT_FALSE(fs::exists(last_good()));
}

TEST_F(Service, at_a_console_a_broken_configuration_ends_the_run) {
  configure("technique = \"raze\"\n");
  const ProgramResult result =
      run_octascope({"run", "--sim", "--config", folder_ / "octascope.toml", "--display",
                     "offscreen", "--volumes", "1"});
  EXPECT_EQ(result.exit_status, 2) << result.describe();
  EXPECT_THAT(result.err, HasSubstr("technique is \"raze\""));
}

TEST_F(Service, brings_back_what_pedal_and_knob_have_set) {
  configure("");
  // The knob alone moves what is chosen: with the left switch held, two functions on is the window's
  // offset.
  const std::string script =
      folder_.write("turn.toml", "event = [ { time_s = 0.1, switch = 0, value = 1 },\n"
                                 "  { time_s = 0.15, knob = 0, value = 2 },\n"
                                 "  { time_s = 0.2, switch = 0, value = 0 },\n"
                                 "  { time_s = 0.3, knob = 0, value = 5 } ]\n");
  const json before = run({"--volumes", "6", "--controls", script})["view"];
  EXPECT_NE(before["window_offset_db"], 4);
  EXPECT_THAT(whole_file(state() / "settings.toml"), HasSubstr("window_offset_db = "));
  const json after = run()["view"];
  EXPECT_EQ(after["window_offset_db"], before["window_offset_db"]);
  EXPECT_EQ(after["window_size_db"], 60);
}

TEST_F(Service, starts_with_broken_settings) {
  configure("");
  folder_.write("state/settings.toml", "[settings]\ntechnique = 7\n");
  const json report = run();
  EXPECT_NE(find_fault(report, "host", "settings_broken"), nullptr);
  EXPECT_EQ(report["view"]["technique"], "rays");
  EXPECT_TRUE(fs::exists(state() / "settings.toml.broken"));
}

TEST_F(Service, takes_over_what_is_edited_while_it_runs) {
  configure("");
  ProgramRun program{words({"--duration", "90"})};
  ASSERT_TRUE(comes_true([&] { return fs::exists(last_good()); }));

  folder_.write("octascope.toml", "[display\n"); // refused: nothing changes
  std::this_thread::sleep_for(2s);
  EXPECT_TRUE(program.running());

  const std::string look = "opacity = 0.25\ntransfer = \"mine\"\n[[transfer]]\nname = \"mine\"\n"
                           "points = [[0, 0], [1, 1]]\n";
  configure("technique = \"maximum\"\n" + look);
  EXPECT_TRUE(comes_true([&] { return whole_file(last_good()).find("mine") != std::string::npos; }))
      << "taken over, and proved by the next picture";

  configure("technique = \"slices\"\nwidth = 800\n" + look);
  std::this_thread::sleep_for(2s);
  EXPECT_EQ(json::parse(ask({"--json"}).out).at("configuration_state"), "own");
  program.send_signal(SIGTERM);
  const ProgramResult result = program.wait();
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  const json report = read_report(report_file());
  EXPECT_EQ(report["view"]["technique"], "slices") << "what can be taken over is";
  EXPECT_EQ(report["view"]["transfer"], 3);
  EXPECT_NE(find_fault(report, "host", "configuration_refused"), nullptr);
  EXPECT_GT(marked_notice(), 10) << "restart to use the display's size";
}

TEST_F(Service, reads_anew_when_it_is_told_to) {
  configure("");
  ProgramRun program{words({"--duration", "90"})};
  ASSERT_TRUE(comes_true([&] { return fs::exists(last_good()); }));
  program.send_signal(SIGHUP);
  std::this_thread::sleep_for(1s);
  EXPECT_TRUE(program.running());
  program.send_signal(SIGTERM);
  EXPECT_EQ(program.wait().exit_status, 0);
}

TEST(DoctorOfConfigurations, tells_everything_that_is_wrong) {
  const ScratchFolder folder;
  const fs::path file =
      folder.write("c.toml", "[scan]\nb_scans = 0\n[display]\nopacity = 7\nwidht = 3\n");
  const ProgramResult broken = run_octascope({"doctor", "--config", file});
  EXPECT_EQ(broken.exit_status, 1) << broken.describe();
  EXPECT_THAT(broken.out, HasSubstr("c.toml:2: [scan] b_scans is 0"));
  EXPECT_THAT(broken.out, HasSubstr("c.toml:4: [display] opacity is 7"));
  EXPECT_THAT(broken.out, HasSubstr("c.toml:5: [display] unknown key \"widht\""));
  run_well({"doctor", "--config", (source_folder() / "deploy/example.toml").string()});
}

// No GPU has 3D textures of 32768.
TEST(DoctorOfConfigurations, tells_of_volumes_that_the_display_cannot_show_and_run_does_not_begin) {
  const ScratchFolder folder;
  const fs::path file =
      folder.write("c.toml", "[scan]\nsamples = 65536\na_scans = 8\nb_scans = 4\n");
  const ProgramResult doctor = run_octascope({"doctor", "--config", file});
  EXPECT_EQ(doctor.exit_status, 1) << doctor.describe();
  EXPECT_THAT(doctor.out,
              HasSubstr("found 32768 depths x 8 A-scans x 4 B-scans, expected at most"));
  const ProgramResult run = run_octascope(
      {"run", "--sim", "--config", file, "--display", "offscreen", "--duration", "1"});
  EXPECT_EQ(run.exit_status, 1) << run.describe();
  EXPECT_THAT(run.err, HasSubstr("found 32768 depths x 8 A-scans x 4 B-scans, expected at most"));
}

TEST(DoctorOfConfigurations, tells_of_a_calibration_that_names_no_camera) {
  const ScratchFolder folder;
  folder.write("k.toml",
               "[spectrometer]\nsamples = 1024\n[k_linear]\npolynomial = [0.0, 1023.0]\n");
  const fs::path file = folder.write("c.toml", "[calibration]\nfile = \"k.toml\"\n");
  const ProgramResult result = run_well({"doctor", "--config", file});
  EXPECT_THAT(result.out, HasSubstr("k.toml names no camera"));
}

} // namespace
} // namespace octascope::tests

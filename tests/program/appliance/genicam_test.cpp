// A GenICam camera through the whole program: Aravis's own GigE Vision camera, on the loopback.
#include <csignal>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "tests/support/program/genicam_description.h"
#include "tests/support/program/loopback_port.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

constexpr const char* fake_camera = "arv-fake-gv-camera-0.8";

class GenicamRun : public testing::Test {
protected:
  void SetUp() override {
    if (!program_exists(fake_camera))
      GTEST_SKIP() << "no " << fake_camera << "; install aravis-tools";
    plug_in();
    const ProgramResult devices = run_octascope({"devices", "--config", configuration()});
    if (devices.out.find("built without Aravis") != std::string::npos)
      GTEST_SKIP() << "octascope was built without Aravis; install libaravis-dev";
  }

  // It runs free, 25 frames a second: a volume takes 0.4 s.
  std::string configuration(const std::string& more = "") const {
    return folder_.write("genicam.toml", R"([scan]
samples = 256
a_scans = 24
fly_back_lines = 6
b_scans = 10
line_rate_hz = 750
depth_spacing_um = 28
a_spacing_um = 250
b_spacing_um = 300
[pipeline]
workers = 2
[devices]
line_camera = "gigevision:127.0.0.1"
)" + more);
  }

  void plug_in(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{fake_camera, "-i", "127.0.0.1", "-s", "OCT1"};
    words.insert(words.end(), more.begin(), more.end());
    camera_ = std::make_unique<ProgramRun>(std::move(words));
    std::this_thread::sleep_for(500ms);
    ASSERT_TRUE(camera_->running());
  }
  void pull_out() { camera_.reset(); }

  std::vector<std::string> command(const char* seconds, const std::string& more = "") const {
    return {"run",
            "--config",
            configuration(more),
            "--display",
            "offscreen",
            "--size",
            "960x540",
            "--duration",
            seconds,
            "--snapshot",
            folder_ / "picture.png",
            "--report",
            folder_ / "report.json"};
  }

  const ScratchFolder folder_;

private:
  const LoopbackPort port_;
  std::unique_ptr<ProgramRun> camera_;
};

// Of Aravis's camera, with Mono8 as its only pixel format; empty: it cannot be had.
std::string description_of_8_bits() {
  void* const aravis = ::dlopen("libaravis-0.8.so.0", RTLD_NOW);
  if (aravis == nullptr)
    return {};
  const auto make =
      reinterpret_cast<void* (*)(const char*)>(::dlsym(aravis, "arv_fake_camera_new"));
  const auto describe = reinterpret_cast<const char* (*)(void*, std::size_t*)>(
      ::dlsym(aravis, "arv_fake_camera_get_genicam_xml"));
  const auto unref = reinterpret_cast<void (*)(void*)>(::dlsym(aravis, "g_object_unref"));
  if (make == nullptr || describe == nullptr || unref == nullptr)
    return {};
  void* const camera = make("OCT1");
  std::size_t size = 0;
  const char* const text = describe(camera, &size);
  std::string description{text, size};
  unref(camera);
  return with_8_bits_alone(std::move(description));
}

TEST_F(GenicamRun, takes_one_that_comes_later_whatever_depth_it_has) {
  const std::string description = description_of_8_bits();
  ASSERT_FALSE(description.empty());
  pull_out();
  ProgramRun run{octascope_command(command("30"))};
  ASSERT_TRUE(run.wait_for_thread("octa-camera", 60s)) << "all is set up, without a camera";
  plug_in({"-g", folder_.write("camera.xml", description)});
  ASSERT_TRUE(run.wait_for_thread("octa-genicam", 30s));
  const ProgramResult result = run.wait(120s);
  EXPECT_EQ(result.exit_status, 0) << result.describe();
  const json report = read_report(folder_ / "report.json");
  EXPECT_EQ(report["calibration"]["line_camera"], "Aravis Fake OCT1");
  EXPECT_GT(report["volumes"]["displayed"].get<int>(), 2) << report.dump(2);
  EXPECT_TRUE(find_fault(report, "line_camera", "unsupported").is_null()) << report.dump(2);
}

TEST_F(GenicamRun, refuses_one_that_comes_later_and_has_not_the_depth_of_a_recorded_background) {
  pull_out();
  folder_.write_values<float>("dark.raw", std::vector<float>(256, 100.0F));
  folder_.write("dark.toml",
                "[spectrometer]\nsamples = 256\n[k_linear]\npolynomial = [0.0, 255.0]\n"
                "[background]\nmode = \"file\"\nfile = \"dark.raw\"\n");
  ProgramRun run{octascope_command(command("30", "[calibration]\nfile = \"dark.toml\"\n"))};
  ASSERT_TRUE(run.wait_for_thread("octa-camera", 60s));
  plug_in(); // its samples have 16 bits
  const ProgramResult result = run.wait(120s);
  EXPECT_EQ(result.exit_status, 0) << result.describe();
  const json report = read_report(folder_ / "report.json");
  EXPECT_FALSE(find_fault(report, "line_camera", "unsupported").is_null()) << report.dump(2);
}

TEST_F(GenicamRun, shows_what_the_camera_sees_and_says_that_it_is_simulated) {
  run_well(command("8"));
  const json report = read_report(folder_ / "report.json");
  EXPECT_EQ(report["devices"]["line_camera"], "aravis");
  EXPECT_EQ(report["devices"]["galvo_trigger"], "sim") << "no scanner is pulsed for a program";
  EXPECT_EQ(report["devices"]["scope_camera"], "none");
  EXPECT_TRUE(report["simulated"].get<bool>());
  EXPECT_EQ(report["calibration"]["line_camera"], "Aravis Fake OCT1");
  EXPECT_GT(report["volumes"]["displayed"].get<int>(), 2) << report.dump(2);
  const pipeline::Image picture = read_snapshot(folder_ / "picture.png");
  const int black = count_colour(picture, layout_of(picture).view, {0, 0, 0}, 40);
  const ui::Rect view = layout_of(picture).view;
  EXPECT_LT(black, 0.9 * view.width * view.height) << "the volume is in the view";
}

TEST_F(GenicamRun, commission_asks_bits_exposure_and_gain_and_shows_what_they_do) {
  const std::string camera = "\ngigevision:127.0.0.1\n256\n24\n6\n10\n750\n\n\n16\n\n";
  const std::string spectrum =
      "\n\n20\n11\n2\n\n\n\n"; // a gain that it has not, then what it has now
  const auto answers = folder_.write("answers", camera + "skip\n" + spectrum + "quit\n");
  std::vector<std::string> words{"sh", "-c", "exec \"$@\" < \"$0\"", answers};
  for (auto& word : octascope_command({"commission", "--out", folder_ / "f"}))
    words.push_back(std::move(word));
  const ProgramResult result = run_program(std::move(words));
  EXPECT_THAT(result.out, testing::AllOf(testing::HasSubstr("Exposure in µs, 10 to 1000000? [20]"),
                                         testing::HasSubstr(
                                             "found \"11\", expected a whole number from 0 to 10"),
                                         testing::HasSubstr("Gain, 0 to 10? [2]")))
      << result.describe();
  const json values = read_report(folder_ / "f/commission.json")["values"];
  EXPECT_EQ(values["significant_bits"], 16);
  EXPECT_EQ(values["exposure_us"], 20);
  EXPECT_EQ(values["gain"], 2);
  const ProgramResult look = run_octascope({"devices", "--config", folder_ / "f/working.toml"});
  EXPECT_EQ(look.exit_status, 0) << look.describe();
}

TEST_F(GenicamRun, goes_on_without_a_camera_that_goes_and_has_it_again_when_it_is_back) {
  ProgramRun run{octascope_command(command("40"))};
  ASSERT_TRUE(run.wait_for_thread("octa-genicam", 30s));
  std::this_thread::sleep_for(3s);
  pull_out();
  std::this_thread::sleep_for(10s);
  plug_in();
  const ProgramResult result = run.wait(120s);
  EXPECT_EQ(result.exit_status, 0) << result.describe();
  const json report = read_report(folder_ / "report.json");
  // Its silence or its heartbeat, whichever is noticed first.
  EXPECT_FALSE(find_fault(report, "line_camera", "silent").is_null() &&
               find_fault(report, "line_camera", "disconnected").is_null())
      << report.dump(2);
  EXPECT_TRUE(find_fault(report, "line_camera", "stuck_thread").is_null()) << report.dump(2);
  EXPECT_GT(report["volumes"]["displayed"].get<int>(), 20) << "7 before, and again for 10 s";
}

} // namespace
} // namespace octascope::tests

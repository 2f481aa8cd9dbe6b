// The whole program in an operating theatre without hardware: started without a flag, as the
// service starts it.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <nlohmann/json.hpp>

#include "tests/support/program/program_run.h"
#include "tests/support/program/trace_file.h"
#include "tests/virtual_hardware/appliance/virtual_rig.h"
#include "tests/virtual_hardware/kms/vkms_card.h"
#include "tests/virtual_hardware/support/scanout_reader.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;

constexpr const char* report_file = "/tmp/report.json";
constexpr const char* runtime_folder = "/run/octascope";
constexpr std::uint8_t left = 1, centre = 2;

class InVirtualRig : public testing::Test {
protected:
  void SetUp() override {
    if (const std::string missing = virtual_rig_missing(); !missing.empty())
      GTEST_SKIP() << missing;
    ASSERT_TRUE(write_virtual_rig_configuration("/etc/octascope", VirtualRigStart::by_hand));
    open_virtual_rig();
  }

  void open_virtual_rig() {
    auto phantom = virtual_rig_phantom(2);
    ASSERT_TRUE(phantom) << phantom.error().message;
    auto made = VirtualRig::make(std::move(*phantom));
    ASSERT_TRUE(made) << made.error().message;
    virtual_rig_ = std::move(*made);
  }

  void start(const std::vector<std::string>& environment = {},
             const std::vector<std::string>& options = {}) {
    std::filesystem::create_directories(runtime_folder);
    std::vector<std::string> words{"env", std::string{"RUNTIME_DIRECTORY="} + runtime_folder};
    std::ranges::copy(environment, std::back_inserter(words));
    std::ranges::move(
        octascope_command({"run", "--report", report_file, "--snapshot", "/tmp/last.png"}),
        std::back_inserter(words));
    std::ranges::copy(options, std::back_inserter(words));
    run_ = std::make_unique<ProgramRun>(std::move(words));
  }

  // What it says of itself while it runs; an empty object while it has no picture yet.
  static nlohmann::json status() {
    const ProgramResult told = run_octascope({"status", "--json"});
    nlohmann::json all = nlohmann::json::parse(told.out, nullptr, false);
    return all.is_object() && all.contains("picture") ? all : nlohmann::json::object();
  }

  // Its report, after it was asked to end.
  nlohmann::json end() {
    run_->send_signal(SIGTERM);
    const ProgramResult result = run_->wait(30s);
    EXPECT_EQ(result.exit_status, 0) << result.describe();
    run_.reset();
    std::ifstream file{report_file};
    nlohmann::json report = nlohmann::json::parse(file, nullptr, false);
    EXPECT_FALSE(report.is_discarded());
    RecordProperty("report", report.dump());
    std::cout << virtual_rig_->pulses() << " pulses, " << virtual_rig_->frames() << " B-scans fed; "
              << report.value("volumes", nlohmann::json{}) << report.value("lost", nlohmann::json{})
              << report.value("rates", nlohmann::json{}) << report.value("faults", nlohmann::json{})
              << '\n';
    return report;
  }

  static bool within(WallClock::duration most, const std::function<bool()>& condition) {
    const auto deadline = WallClock::now() + most;
    while (!condition()) {
      if (WallClock::now() > deadline)
        return false;
      std::this_thread::sleep_for(50ms);
    }
    return true;
  }

  // So many more volumes were scanned.
  bool scanned(std::uint64_t volumes, WallClock::duration most = 40s) {
    const std::uint64_t first = virtual_rig_->pulses();
    return within(most, [&] { return virtual_rig_->pulses() >= first + volumes; });
  }

  static ScanoutPicture screen() {
    auto picture = read_scanout();
    EXPECT_TRUE(picture) << picture.error().message;
    return picture ? std::move(*picture) : ScanoutPicture{};
  }

  // What a user changes in a file of the configuration.
  static void edit(const std::filesystem::path& file, const std::string& found,
                   const std::string& instead) {
    std::ostringstream read;
    read << std::ifstream{file}.rdbuf();
    std::string text = read.str();
    const auto at = text.find(found);
    ASSERT_NE(at, std::string::npos) << file << ": " << text;
    std::ofstream{file} << text.replace(at, found.size(), instead);
  }

  // Of what the camera sees, as a recording of it says.
  static double recorded_depth_spacing_um() {
    constexpr const char* file = "/tmp/spacing.h5";
    std::filesystem::remove(file);
    const ProgramResult kept =
        run_octascope({"record", "--out", file, "--volumes", "2", "--subject", "a bench"});
    EXPECT_EQ(kept.exit_status, 0) << kept.describe();
    const ProgramResult told = run_octascope({"info", "--json", file});
    EXPECT_EQ(told.exit_status, 0) << told.describe();
    const nlohmann::json info = nlohmann::json::parse(told.out, nullptr, false);
    EXPECT_EQ(info.value("simulated", true), false) << told.out;
    return info.value("/geometry/depth_spacing_um"_json_pointer, 0.0);
  }

  // How much of the middle of the screen is another picture: a share of 0 to 1.
  static double changed(const ScanoutPicture& a, const ScanoutPicture& b) {
    if (a.width != b.width || a.height != b.height || a.width == 0)
      return 1;
    int different = 0, all = 0;
    for (int y = a.height / 4; y < a.height * 3 / 4; ++y)
      for (int x = a.width / 4; x < a.width * 3 / 4; ++x, ++all)
        for (int c = 0; c < 3; ++c)
          if (std::abs(a.pixel(x, y)[c] - b.pixel(x, y)[c]) > 8) {
            ++different;
            break;
          }
    return static_cast<double>(different) / all;
  }

  // Of the whole screen, in the colour of what is stale.
  static double share_of_amber(const ScanoutPicture& picture) {
    int amber = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const std::uint8_t* const pixel = picture.pixel(x, y);
        amber += pixel[0] > 220 && pixel[1] > 140 && pixel[1] < 210 && pixel[2] < 110 ? 1 : 0;
      }
    return static_cast<double>(amber) / std::max(1, picture.width * picture.height);
  }

  // The trigger's entry of this kind; an empty object if there is none.
  static nlohmann::json trigger_fault(const nlohmann::json& told, const std::string& kind) {
    for (const auto& fault : told.value("faults", nlohmann::json::array()))
      if (fault["device"] == "galvo_trigger" && fault["kind"] == kind)
        return fault;
    return nlohmann::json::object();
  }

  static std::uint64_t fault_count(const nlohmann::json& report, const std::string& device) {
    std::uint64_t count = 0;
    for (const auto& fault : report["faults"])
      if (fault["device"] == device)
        count += fault["count"].get<std::uint64_t>();
    return count;
  }

  std::unique_ptr<VirtualRig> virtual_rig_;
  std::unique_ptr<ProgramRun> run_;
};

// The bench has one processor, in a machine that may be busy: it has three tries to keep the rate.
// A program that loses volumes loses them in each.
TEST_F(InVirtualRig, finds_all_five_devices_by_itself_and_loses_nothing) {
  nlohmann::json report;
  for (int attempt = 0; attempt < 3; ++attempt) {
    start();
    ASSERT_TRUE(scanned(16)); // some are passed over while the first picture is made
    report = end();
    if (report["lost"]["lines"] == 0 && fault_count(report, "galvo_trigger") == 0)
      break;
  }
  EXPECT_EQ(report["simulated"], false);
  EXPECT_EQ(report["devices"]["line_camera"], "v4l2");
  EXPECT_EQ(report["devices"]["galvo_trigger"], "gpio");
  EXPECT_EQ(report["devices"]["control_input"], "hid");
  EXPECT_EQ(report["devices"]["scope_camera"], "libcamera");
  EXPECT_EQ(report["devices"]["display"], "kms");
  EXPECT_GE(report["volumes"]["acquired"], 10);
  EXPECT_GE(report["volumes"]["displayed"], 3);
  EXPECT_EQ(report["lost"]["lines"], 0);
  EXPECT_EQ(report["lost"]["volumes"], 0);
  EXPECT_EQ(report["hot_path"]["allocations"], 0);
  EXPECT_EQ(fault_count(report, "galvo_trigger"), 0U);
}

// Every stamp is the kernel's: the camera's of its frames, the monitor's of its flips.
TEST_F(InVirtualRig, a_volumes_stages_follow_each_other_from_its_last_line_to_the_glass) {
  constexpr const char* trace_file = "/tmp/trace.json";
  std::filesystem::remove(trace_file);
  start({}, {"--trace", trace_file});
  ASSERT_TRUE(scanned(8));
  const nlohmann::json report = end();
  const TraceRows rows = read_trace(trace_file);
  ASSERT_TRUE(rows.contains("display"));
  const double sweep_us = 1e-3 * static_cast<double>(VirtualRig::plan().tick_period().count());
  double longest_ms = 0;
  std::set<std::uint64_t> volumes;
  for (const auto& [begin, event] : rows.at("display"))
    volumes.insert(event.at("args").at("volume").get<std::uint64_t>());
  EXPECT_EQ(volumes.size(), report["volumes"]["displayed"].get<std::size_t>());
  ASSERT_FALSE(volumes.empty());
  const bool lost = report["lost"]["lines"] != 0;
  for (const std::uint64_t volume : volumes) {
    const auto spans = passage(rows, volume);
    EXPECT_EQ(gap_in(spans), "") << "volume " << volume;
    longest_ms = std::max(longest_ms, 1e-3 * (spans.at("flip").end - spans.at("exposure").end));
    const double exposed_us = spans.at("exposure").end - spans.at("exposure").begin;
    if (!lost) {
      EXPECT_GT(exposed_us, 0.5 * sweep_us);
    }
  }
  EXPECT_NEAR(longest_ms, report["latency_ms"]["max"].get<double>(), 0.002);
}

// Else every depth on the screen would be wrong by the same share, unnoticed.
TEST_F(InVirtualRig, depths_are_as_far_apart_as_the_cameras_calibration_says) {
  const std::filesystem::path folder = "/etc/octascope";
  edit(folder / "calibration.toml", "spacing_um = 3.5", "spacing_um = 4.25");
  EXPECT_EQ(recorded_depth_spacing_um(), 4.25);
  edit(folder / "octascope.toml", "[scan]", "[scan]\ndepth_spacing_um = 6.5");
  EXPECT_EQ(recorded_depth_spacing_um(), 6.5) << "what [scan] says itself goes first";
}

TEST_F(InVirtualRig, a_foot_on_the_pedal_changes_what_the_monitor_shows) {
  start();
  ASSERT_TRUE(scanned(4));
  ASSERT_TRUE(virtual_rig_->tread(centre)); // freezes
  std::this_thread::sleep_for(100ms);
  ASSERT_TRUE(virtual_rig_->tread(0));
  // Frozen, the picture comes to rest, however many volumes are scanned meanwhile.
  ScanoutPicture frozen = screen();
  ASSERT_TRUE(within(30s, [&] {
    std::this_thread::sleep_for(2s);
    const ScanoutPicture before = std::exchange(frozen, screen());
    return changed(before, frozen) < 0.01;
  }));
  ASSERT_TRUE(virtual_rig_->tread(left)); // held: back to the first view; then released
  std::this_thread::sleep_for(100ms);
  ASSERT_TRUE(virtual_rig_->tread(0));
  ASSERT_TRUE(virtual_rig_->tread(centre));
  std::this_thread::sleep_for(100ms);
  ASSERT_TRUE(virtual_rig_->tread(0)); // live again
  EXPECT_TRUE(within(20s, [&] { return changed(frozen, screen()) > 0.02; })) << "live again";
  const nlohmann::json report = end();
  EXPECT_EQ(report["actions"]["freeze"], 2);
  EXPECT_EQ(report["actions"]["previous_parameter"], 1);
}

TEST_F(InVirtualRig, the_listed_keyboard_steers_and_a_strange_one_does_not) {
  auto keyboard = VirtualRig::plug_keyboard();
  const auto strange = VirtualRig::plug_strange_keyboard();
  ASSERT_TRUE(keyboard && strange);
  const auto type = [](VirtualKeyboard& on, std::uint16_t key) {
    EXPECT_TRUE(on.set(key, true));
    std::this_thread::sleep_for(100ms);
    EXPECT_TRUE(on.set(key, false));
    std::this_thread::sleep_for(1s);
  };
  start();
  ASSERT_TRUE(scanned(3));
  ASSERT_TRUE(within(20s, [&] { return (*keyboard)->is_grabbed(); }));
  EXPECT_FALSE((*strange)->is_grabbed());
  type(**strange, KEY_SPACE);
  type(**strange, KEY_Q);
  ASSERT_TRUE(run_->running());
  type(**keyboard, KEY_SPACE); // freezes
  keyboard->reset();
  keyboard = VirtualRig::plug_keyboard();
  ASSERT_TRUE(keyboard);
  ASSERT_TRUE(within(20s, [&] { return (*keyboard)->is_grabbed(); }));
  type(**keyboard, KEY_SPACE); // live again
  type(**keyboard, KEY_ESC);
  EXPECT_TRUE(within(20s, [&] { return !run_->running(); }));
  const nlohmann::json report = end();
  EXPECT_EQ(report["actions"]["freeze"], 2);
}

// As systemd starts it: the graphics driver may be loaded, and the monitor awake, a little later.
TEST_F(InVirtualRig, as_a_service_it_waits_for_its_monitor_at_the_start) {
  const auto card = find_vkms();
  ASSERT_TRUE(card);
  ASSERT_TRUE(set_cable(*card, "off"));
  start({}, {"--display", "kms"});
  const ProgramResult alone = run_->wait(30s);
  EXPECT_EQ(alone.exit_status, 1) << "nobody would start it again\n" << alone.describe();
  start({"NOTIFY_SOCKET=/run/nobody"}, {"--display", "kms"});
  std::this_thread::sleep_for(1500ms);
  const bool waits = run_->running();
  ASSERT_TRUE(set_cable(*card, "detect"));
  ASSERT_TRUE(waits);
  ASSERT_TRUE(scanned(3));
  const auto shows_one = [] {
    std::this_thread::sleep_for(500ms); // one processor: asking takes from what is asked
    return status()["volumes"]["displayed"] >= 1;
  };
  EXPECT_TRUE(within(20s, shows_one)) << status();
  EXPECT_GE(end()["volumes"]["displayed"], 1);
}

TEST_F(InVirtualRig, two_devices_vanish_at_once_and_come_back) {
  start();
  ASSERT_TRUE(scanned(4));
  virtual_rig_->pull_pedal();
  ASSERT_TRUE(virtual_rig_->chip().remove());
  std::this_thread::sleep_for(3s);
  ASSERT_TRUE(run_->running());
  ASSERT_TRUE(virtual_rig_->chip().restore());
  ASSERT_TRUE(virtual_rig_->plug_pedal());
  ASSERT_TRUE(scanned(4)) << "the scanner is triggered again";
  ASSERT_TRUE(virtual_rig_->tread(centre));
  std::this_thread::sleep_for(100ms);
  ASSERT_TRUE(virtual_rig_->tread(0));
  std::this_thread::sleep_for(1s);
  const nlohmann::json report = end();
  EXPECT_EQ(report["actions"]["freeze"], 1) << "the pedal serves again";
  EXPECT_GE(trigger_fault(report, "disconnected").value("count", 0), 1);
  EXPECT_GE(fault_count(report, "control_input"), 1U);
}

// Flips would go on without a word: nothing is drawn any more into what they show.
TEST_F(InVirtualRig, a_graphics_processor_that_is_reset_is_told_and_draws_again) {
  start({std::string{"LD_PRELOAD="} + OCTASCOPE_FAKE_DRIVER, "OCTASCOPE_FAKE_RESET=25 3"});
  nlohmann::json told;
  ASSERT_TRUE(within(40s, [&] {
    std::this_thread::sleep_for(500ms); // one processor: asking takes from what is asked
    told = status();
    return told.contains("faults") && fault_count(told, "display") > 0;
  })) << told;
  ASSERT_TRUE(scanned(3));
  ASSERT_TRUE(within(20s, [&] { return status()["devices"]["display"]["state"] == "ready"; }));
  const std::uint64_t displayed = status()["volumes"]["displayed"];
  ASSERT_TRUE(scanned(3));
  const ScanoutPicture before = screen();
  EXPECT_TRUE(within(20s, [&] { return changed(before, screen()) > 0.002; })) << "it is live";
  const nlohmann::json report = end();
  EXPECT_GT(report["volumes"]["displayed"], displayed);
  EXPECT_EQ(fault_count(report, "display"), 3U) << "a flip, and two tries to open it";
  const std::string faults = report["faults"].dump();
  EXPECT_NE(faults.find("was reset (by another program)"), std::string::npos) << faults;
}

TEST_F(InVirtualRig, a_camera_that_falls_silent_is_told_and_its_return_is_seen) {
  start();
  ASSERT_TRUE(scanned(4));
  virtual_rig_->blind_camera(true);
  std::this_thread::sleep_for(3s);
  EXPECT_GT(share_of_amber(screen()), 0.005) << "STALE, and a frame around what is old";
  virtual_rig_->blind_camera(false);
  ASSERT_TRUE(scanned(4));
  const nlohmann::json report = end();
  EXPECT_GE(report["lost"]["volumes"], 2);
  EXPECT_GE(trigger_fault(report, "missed_pulse").value("count", 0), 2);
  EXPECT_GE(report["volumes"]["displayed"], 4);
}

// The scanner scans on, so nothing but its sync line says that something is wrong.
TEST_F(InVirtualRig, a_scanner_that_does_not_answer_is_told_until_it_does) {
  constexpr const char* words = "The scanner does not answer: is it on?";
  start();
  ASSERT_TRUE(scanned(3));
  virtual_rig_->mute_scanner(true);
  nlohmann::json told;
  const auto says_so = [&] {
    std::this_thread::sleep_for(300ms); // one processor: asking takes from what is asked
    told = status();
    return told.contains("picture") && told["picture"]["notice"] == words;
  };
  EXPECT_TRUE(within(40s, says_so)) << told;
  virtual_rig_->mute_scanner(false);
  const std::uint64_t answered = virtual_rig_->pulses();
  EXPECT_TRUE(within(40s, [&] {
    return !says_so() && virtual_rig_->pulses() >= answered + 3 &&
           trigger_fault(told, "unanswered_pulse").value("last_s_ago", 0.0) > 2.5;
  })) << told;
  const nlohmann::json report = end();
  EXPECT_GE(trigger_fault(report, "unanswered_pulse").value("count", 0), 1) << report["faults"];
  EXPECT_GE(report["volumes"]["displayed"], 3);
}

// As if the camera were plugged in, or udev had just gone through it, when the twin serves already.
class BeforeVirtualRig : public InVirtualRig {
protected:
  void SetUp() override {
    if (const std::string missing = virtual_rig_missing(); !missing.empty())
      GTEST_SKIP() << missing;
    ASSERT_TRUE(write_virtual_rig_configuration("/etc/octascope", VirtualRigStart::by_hand));
  }

  void open_virtual_rig_late() {
    ASSERT_TRUE(within(30s, [] { return status().value("simulated", false); }));
    open_virtual_rig();
    const ProgramResult told =
        run_program({"udevadm", "trigger", "--action=change", "--subsystem-match=video4linux"});
    ASSERT_EQ(told.exit_status, 0) << told.describe();
  }
};

TEST_F(BeforeVirtualRig, a_camera_that_comes_later_is_told_beside_its_twin) {
  start();
  open_virtual_rig_late();
  EXPECT_TRUE(within(20s, [] {
    const nlohmann::json told = status();
    return told.contains("picture") &&
           told["picture"]["notice"] == "A line camera is there: start octascope again";
  }));
  const nlohmann::json report = end();
  EXPECT_EQ(report["devices"]["line_camera"], "sim");
  EXPECT_EQ(fault_count(report, "line_camera"), 1U);
}

TEST_F(BeforeVirtualRig,
       a_service_ends_for_a_camera_that_comes_later_and_has_it_at_the_next_start) {
  start({"NOTIFY_SOCKET=/run/nobody"}, {"--display", "kms"});
  open_virtual_rig_late();
  const ProgramResult ended = run_->wait(20s);
  EXPECT_EQ(ended.exit_status, 0) << ended.describe();
  start({"NOTIFY_SOCKET=/run/nobody"}, {"--display", "kms"});
  ASSERT_TRUE(scanned(3));
  const nlohmann::json report = end();
  EXPECT_EQ(report["devices"]["line_camera"], "v4l2");
  EXPECT_EQ(report["simulated"], false);
}

} // namespace
} // namespace octascope::tests

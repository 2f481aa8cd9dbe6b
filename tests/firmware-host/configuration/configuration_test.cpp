#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/configuration/configuration.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::firmware_host {
namespace {

using testing::HasSubstr;

class ConfigurationFile : public testing::Test {
protected:
  hal::Result<Configuration> load(std::string_view text) {
    return load_configuration(folder_.write("c.toml", text));
  }
  tests::ScratchFolder folder_;
};

TEST_F(ConfigurationFile, empty_means_the_defaults) {
  const auto c = tests::must(load(""));
  const Configuration defaults;
  EXPECT_FALSE(c.plan) << "the phantom's or the recording's own";
  EXPECT_FALSE(c.calibration);
  EXPECT_EQ(c.width, defaults.width);
  EXPECT_EQ(c.phantom, defaults.phantom);
  EXPECT_EQ(c.veil_after, defaults.veil_after);
}

TEST_F(ConfigurationFile, sets_what_it_names) {
  const auto c = tests::must(load(R"([scan]
samples = 512
a_scans = 200
fly_back_lines = 50
b_scans = 60
line_rate_hz = 100e3
depth_spacing_um = 4.0
a_spacing_um = 20
b_spacing_um = 30.5
bidirectional = true
turn_around_lines = 12
phase_offset_a_scans = 4.25
find_phase_offset = false
repeats = 2
[calibration]
file = "cal/c.toml"
[pipeline]
workers = 3
worker_cores = [1, 0]
neighbour_weights = [0.25, 0.5, 0.25]
[display]
width = 1920
height = 1080
fullscreen = true
veil_after_s = 2.5
[sim]
phantom = "nail_fold"
loop_volumes = 4
galvo_lag_us = 110.5
faults = "f.toml"
controls = "/etc/controls.toml"
)"));
  ASSERT_TRUE(c.plan);
  EXPECT_EQ(*c.plan, (pipeline::ScanPlan{.samples = 512,
                                         .a_scans = 200,
                                         .fly_back_lines = 50,
                                         .b_scans = 60,
                                         .line_rate_hz = 100e3,
                                         .depth_spacing_um = 4,
                                         .a_spacing_um = 20,
                                         .b_spacing_um = 30.5,
                                         .bidirectional = true,
                                         .turn_around_lines = 12,
                                         .scan_lag_a_scans = 4.25,
                                         .find_scan_lag = false,
                                         .repeats = 2}));
  EXPECT_EQ(c.calibration, folder_ / "cal/c.toml") << "relative to the file";
  EXPECT_EQ(c.workers, 3U);
  EXPECT_EQ(c.worker_cores, (std::vector{1, 0}));
  EXPECT_EQ(c.galvo_lag_us, 110.5);
  EXPECT_EQ(c.width, 1920);
  EXPECT_EQ(c.height, 1080);
  EXPECT_TRUE(c.fullscreen);
  EXPECT_EQ(c.veil_after, std::chrono::milliseconds{2500});
  EXPECT_EQ(c.phantom, "nail_fold");
  EXPECT_EQ(c.loop_volumes, 4);
  EXPECT_EQ(c.faults, folder_ / "f.toml");
  EXPECT_EQ(c.controls, "/etc/controls.toml");
}

TEST_F(ConfigurationFile, says_which_devices_serve) {
  const auto c = tests::must(load(R"([devices]
line_camera = "/dev/video7"
significant_bits = 10
right_shift = 2
exposure_us = 4.5
gain = -3
camera_input = 1
camera_trigger = "Line1"
packet_resend = false
galvo_trigger = "gpio"
trigger_line = "gpiochip1:7"
sync_line = "scanner-ready"
pulse_width_us = 120
control_input = "hid"
scope_camera = "none"
connector = "HDMI-A-2"
mode = "1920x1080@50"
overscan_percent = 2.5
seat = false
)"));
  const DeviceConfig& d = c.devices;
  EXPECT_EQ(d.line_camera, "/dev/video7");
  EXPECT_EQ(d.significant_bits, 10);
  EXPECT_EQ(d.right_shift, 2);
  EXPECT_EQ(d.exposure_us, 4.5);
  EXPECT_EQ(d.gain, -3);
  EXPECT_EQ(d.camera_input, 1);
  EXPECT_EQ(d.camera_trigger, "Line1");
  EXPECT_FALSE(d.packet_resend);
  EXPECT_EQ(d.galvo_trigger, "gpio");
  EXPECT_EQ(d.trigger_line, "gpiochip1:7");
  EXPECT_EQ(d.sync_line, "scanner-ready");
  EXPECT_EQ(d.pulse_width, std::chrono::microseconds{120});
  EXPECT_EQ(d.control_input, "hid");
  EXPECT_EQ(d.scope_camera, "none");
  EXPECT_EQ(d.connector, "HDMI-A-2");
  EXPECT_EQ(d.mode, "1920x1080@50");
  EXPECT_EQ(d.overscan_percent, 2.5);
  EXPECT_FALSE(d.seat);
}

TEST(MachineConfiguration, is_for_real_devices_alone) {
  RunOptions options;
  options.configuration = "mine.toml";
  EXPECT_EQ(configuration_file(options), "mine.toml");
  RunOptions simulated;
  simulated.simulate = true;
  EXPECT_FALSE(configuration_file(simulated));
}

TEST_F(ConfigurationFile, a_plan_that_names_little_keeps_the_other_defaults) {
  const auto c = tests::must(load("[scan]\nb_scans = 10\n"));
  pipeline::ScanPlan expected;
  expected.b_scans = 10;
  expected.assumed_spacings = {true, true, true};
  EXPECT_EQ(c.plan, expected);
}

TEST_F(ConfigurationFile, sets_how_a_volume_looks) {
  folder_.write("bone.csv", "0, 0, 0, 0\n1, 0.5, 0.25, 0.75\n");
  const auto c = tests::must(load(R"([display]
technique = "surface"
transfer = "bone"
colours = "dawn"
opacity = 0.25
[[transfer]]
name = "veins"
kind = "spline"
points = [[0, 0], [0.5, 1], [1, 0.5]]
colours = "amber"
[[transfer]]
name = "bone"
kind = "table"
file = "bone.csv"
)"));
  const LookConfiguration& look = c.look;
  const auto built_in = static_cast<int>(ui::TransferSet{}.functions().size());
  EXPECT_EQ(look.technique, ui::Technique::surface);
  EXPECT_EQ(look.transfer, built_in + 1);
  EXPECT_EQ(look.colour_map, look.transfers.colour_map_named("dawn"));
  EXPECT_EQ(look.opacity, 0.25F);
  ASSERT_EQ(look.transfers.functions().size(), static_cast<std::size_t>(built_in + 2));
  const ui::TransferFunction& veins =
      look.transfers.functions()[static_cast<std::size_t>(built_in)];
  EXPECT_EQ(veins.name, "veins");
  EXPECT_EQ(veins.curve.opacity(0.5F), 1);
  ASSERT_TRUE(veins.colours);
  EXPECT_EQ(veins.colours->name(), "amber");
  const ui::TransferFunction& bone = look.transfers.functions().back();
  EXPECT_EQ(bone.curve.opacity(1), 0.75F);
  ASSERT_TRUE(bone.colours) << "the file brings its own";
  EXPECT_EQ(bone.colours->at(1), (ui::TransferTable::Colour{1, 0.5F, 0.25F}));
}

TEST_F(ConfigurationFile, a_look_up_table_in_error_is_told_with_both_places) {
  folder_.write("bad.csv", "0\n0.5\n2\n");
  const auto c = tests::error_of(
      load("\n[[transfer]]\nname = \"bad\"\nkind = \"table\"\nfile = \"bad.csv\"\n"));
  EXPECT_THAT(c.message, HasSubstr("c.toml:2: [transfer]"));
  EXPECT_THAT(c.message, HasSubstr("bad.csv:3: found 2"));
}

TEST_F(ConfigurationFile, chooses_what_the_controls_do) {
  const auto named = tests::must(load("[controls]\nprofile = \"powermate\"\n"));
  EXPECT_EQ(load_controls(named)->name, "PowerMate");
  EXPECT_EQ(load_controls(Configuration{})->name, "Three-switch pedal and knob");
  folder_.write("mine.toml", "name = \"Mine\"\n");
  const auto own = tests::must(load("[controls]\nfile = \"mine.toml\"\n"));
  EXPECT_EQ(load_controls(own)->name, "Mine");
  EXPECT_THAT(load("[controls]\nprofile = \"pedal\"\n").error().message,
              testing::AllOf(HasSubstr("c.toml:1: [controls]"), HasSubstr("\"pedal\""),
                             HasSubstr("shuttle_pro")));
  EXPECT_THAT(load("[controls]\nprofile = \"powermate\"\nfile = \"mine.toml\"\n").error().message,
              HasSubstr("expected one"));
}

TEST_F(ConfigurationFile, lists_keyboards_by_vendor_and_product) {
  EXPECT_TRUE(load("").value().devices.keyboards.empty());
  const auto two = tests::must(load("[controls]\nkeyboards = [\"046d:c31c\", \"04D9:A1CD\"]\n"));
  EXPECT_EQ(two.devices.keyboards, (std::vector<std::string>{"046d:c31c", "04d9:a1cd"}));
  for (const std::string wrong : {"", "046d", "046dc31c", "046d:c31", "046d:c31cc", "046g:c31c",
                                  "0x46:c31c", "046d-c31c", "046d:*", "Logitech"}) {
    const auto refused = load("[controls]\nkeyboards = \"" + wrong + "\"\n");
    ASSERT_FALSE(refused) << wrong;
    EXPECT_THAT(refused.error().message,
                testing::AllOf(HasSubstr("c.toml:1: [controls]"), HasSubstr('"' + wrong + '"'),
                               HasSubstr("046d:c31c"), HasSubstr("octascope devices")));
  }
}

TEST_F(ConfigurationFile, that_is_missing_is_named) {
  const auto c = tests::error_of(load_configuration(folder_ / "nowhere.toml"));
  EXPECT_EQ(c.code, hal::ErrorCode::absent);
  EXPECT_THAT(c.message, HasSubstr("nowhere.toml"));
}

struct Refused {
  std::string name;
  std::string text;
  std::string told;
  friend void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }
};

class RefusedConfiguration : public testing::TestWithParam<Refused> {};

TEST_P(RefusedConfiguration, is_refused_as_a_whole_in_one_line_with_its_place) {
  const tests::ScratchFolder folder;
  const auto c = tests::error_of(load_configuration(folder.write("c.toml", GetParam().text)));
  EXPECT_THAT(c.message, HasSubstr("c.toml"));
  EXPECT_THAT(c.message, HasSubstr(GetParam().told));
  EXPECT_EQ(c.message.find('\n'), std::string::npos) << c.message;
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedConfiguration,
    testing::Values(
        Refused{"unknown_table", "[screen]\n", "unknown key \"screen\""},
        Refused{"unknown_key", "[sim]\nphantoms = \"x\"\n", "unknown key \"phantoms\""},
        Refused{"wrong_type", "[display]\nwidth = \"wide\"\n", "width is"},
        Refused{"too_small", "[display]\nwidth = 10\n", "from 320"},
        Refused{"not_a_number", "[scan]\nline_rate_hz = nan\n", "line_rate_hz is nan"},
        Refused{"no_whole_number", "[scan]\nb_scans = 2.5\n", "whole number"},
        Refused{"zero", "[scan]\na_scans = 0\n", "a_scans is 0"},
        Refused{"too_many_workers", "[pipeline]\nworkers = 1000\n", "workers is 1000"},
        Refused{"too_many_repeats", "[scan]\nrepeats = 5\n", "repeats is 5"},
        Refused{"offset_beyond_the_sweep", "[scan]\nphase_offset_a_scans = 301\n",
                "phase_offset_a_scans is 301"},
        Refused{"half_a_core", "[pipeline]\nworker_cores = [0, 1.5]\n", "core numbers"},
        Refused{"two_weights", "[pipeline]\nneighbour_weights = [1, 2]\n", "three numbers"},
        Refused{"no_own_weight", "[pipeline]\nneighbour_weights = [1, 0, 1]\n", "own (> 0)"},
        Refused{"a_table_for_a_number", "[display.width]\nx = 1\ny = 2\n", "width is"},
        Refused{"no_such_technique", "[display]\ntechnique = \"ray\"\n", "\"slices\", \"planes\""},
        Refused{"no_such_transfer", "[display]\ntransfer = \"x\"\n", "expected one of \"window\""},
        Refused{"no_such_colours", "[display]\ncolours = \"red\"\n", "\"grey\", \"amber\""},
        Refused{"no_opacity", "[display]\nopacity = 0\n", "opacity is 0"},
        Refused{"transfer_without_name", "[[transfer]]\npoints = [[0, 0], [1, 1]]\n",
                "name is missing"},
        Refused{"transfer_of_unknown_kind", "[[transfer]]\nname = \"x\"\nkind = \"bezier\"\n",
                "\"piecewise\", \"spline\", \"table\""},
        Refused{"transfer_without_points", "[[transfer]]\nname = \"x\"\n", "found 0 points"},
        Refused{"transfer_that_turns_back",
                "[[transfer]]\nname = \"x\"\npoints = [[0, 0], [0.5, 1], [0.4, 1]]\n",
                "point 3 is at u = 0.4"},
        Refused{"point_of_three", "[[transfer]]\nname = \"x\"\npoints = [[0, 0], [0.5, 1, 2]]\n",
                "points[1]"},
        Refused{"point_of_text", "[[transfer]]\nname = \"x\"\npoints = [[0, \"a\"], [1, 1]]\n",
                "points[0][1]"},
        Refused{"points_flat", "[[transfer]]\nname = \"x\"\npoints = [0, 0, 1, 1]\n", "points[0]"},
        Refused{"transfer_without_file", "[[transfer]]\nname = \"x\"\nkind = \"table\"\n",
                "file is missing"},
        Refused{"file_that_is_not_there",
                "[[transfer]]\nname = \"x\"\nkind = \"table\"\nfile = \"no.csv\"\n",
                "there is no such file"},
        Refused{"transfer_named_as_another",
                "[[transfer]]\nname = \"smooth\"\npoints = [[0, 0], [1, 1]]\n",
                "\"smooth\" is there already"},
        Refused{"gige_vision_without_address", "[devices]\nline_camera = \"gigevision:Camera-7\"\n",
                "no IPv4 address"},
        Refused{"no_such_trigger", "[devices]\ngalvo_trigger = \"usb\"\n",
                "galvo_trigger is \"usb\", expected one of: auto, sim, gpio"},
        Refused{"no_such_scope_camera", "[devices]\nscope_camera = \"\"\n", "scope_camera is"},
        Refused{"pulse_of_a_second", "[devices]\npulse_width_us = 1e6\n", "pulse_width_us is"},
        Refused{"no_toml", "[scan\n", "not TOML"}),
    [](const auto& test) { return test.param.name; });

} // namespace
} // namespace octascope::firmware_host

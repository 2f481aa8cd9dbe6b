// Every key of docs/CONFIGURATION.md's table acts at start, and on reload as the table says.
#include <array>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "firmware-host/configuration/kept/configuration_changes.h"
#include "firmware-host/devices/devices.h"
#include "firmware-host/run/live_configuration.h"
#include "tests/firmware-host/run/loop_stage.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/pictures/picture_counts.h"
#include "tests/support/program/built_places.h"
#include "tests/ui/support/synthetic_volume.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using namespace firmware_host;
namespace fs = std::filesystem;

// "section key" → whether it is taken over while the appliance runs.
std::map<std::string, bool> table_of_keys() {
  std::map<std::string, bool> keys;
  std::ifstream document{source_folder() / "docs/CONFIGURATION.md"};
  std::string section;
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("| **[")) {
      const std::size_t begin = line.find_first_not_of("| *[");
      section = line.substr(begin, line.find(']') - begin);
    } else if (line.starts_with("| `") && !section.empty()) {
      keys[section + ' ' + line.substr(3, line.find('`', 3) - 3)] = line.ends_with("| yes |");
    }
  }
  return keys;
}

struct KeyCase {
  std::string_view key; // section and key
  std::string with;
  std::string without{};
};

// A value other than the default of each key, in as short a file as can have it.
std::vector<KeyCase> key_cases() {
  const std::string faults = source_folder() / "sim/faults/examples/everything.toml";
  const std::string controls = source_folder() / "sim/controls/tour.toml";
  const std::string profile = source_folder() / "ui/controls/profiles/powermate.toml";
  const auto scan = [](std::string_view line) {
    return KeyCase{{}, "[scan]\n" + std::string{line}, "[scan]\n"};
  };
  const std::string lens = "[microscope]\nobjective = \"a\"\n[[objective]]\nname = \"a\"\n";
  const std::string window = "window_offset_db = 3\nwindow_size_db = 30\n";
  const std::string curve = "[display]\ntransfer = \"mine\"\n[[transfer]]\nname = \"mine\"\n";
  const std::string points = "points = [[0, 0], [0.5, 0.1], [1, 1]]\n";
  const auto names = [&](const std::string& first, const std::string& second) {
    return "[display]\ntransfer = \"mine\"\n[[transfer]]\nname = \"" + first + "\"\n" + points +
           "[[transfer]]\nname = \"" + second + "\"\npoints = [[0, 1], [1, 0]]\n";
  };
  const auto kinds = [&](std::string_view kind) {
    return curve + points + "kind = \"" + std::string{kind} + "\"\n";
  };
  const auto lies = [](const std::string& x, const std::string& y) {
    return "[orientation]\nright_eye_x = \"" + x + "\"\nright_eye_y = \"" + y + "\"\n";
  };
  const auto with_key = [](std::string_view key, KeyCase made) {
    made.key = key;
    return made;
  };
  return {
      with_key("scan samples", scan("samples = 512\n")),
      with_key("scan a_scans", scan("a_scans = 100\n")),
      with_key("scan fly_back_lines", scan("fly_back_lines = 50\n")),
      with_key("scan b_scans", scan("b_scans = 20\n")),
      with_key("scan line_rate_hz", scan("line_rate_hz = 100000\n")),
      // Its default, too, is something else than nothing: it comes before the calibration's.
      with_key("scan depth_spacing_um", scan("depth_spacing_um = 3.5\n")),
      with_key("scan a_spacing_um", scan("a_spacing_um = 11\n")),
      with_key("scan b_spacing_um", scan("b_spacing_um = 30\n")),
      with_key("scan bidirectional", scan("bidirectional = true\n")),
      with_key("scan turn_around_lines", scan("turn_around_lines = 9\n")),
      with_key("scan phase_offset_a_scans", scan("phase_offset_a_scans = 2\n")),
      with_key("scan find_phase_offset", scan("find_phase_offset = false\n")),
      with_key("scan repeats", scan("repeats = 2\n")),
      {"calibration file", "[calibration]\nfile = \"calibration.toml\"\n"},
      {"microscope objective",
       "[microscope]\nobjective = \"b\"\n[[objective]]\nname = \"a\"\n[[objective]]\nname = "
       "\"b\"\na_mm = 2\n",
       lens + "[[objective]]\nname = \"b\"\na_mm = 2\n"},
      {"objective name", "[microscope]\nobjective = \"b\"\n[[objective]]\nname = \"b\"\n", lens},
      {"objective a_mm", lens + "a_mm = 2\n", lens},
      {"objective b_mm", lens + "b_mm = 2\n", lens},
      {"objective calibration", lens + "calibration = \"calibration.toml\"\n", lens},
      {"objective window_offset_db", lens + "window_offset_db = 12\nwindow_size_db = 30\n",
       lens + window},
      {"objective window_size_db", lens + "window_offset_db = 3\nwindow_size_db = 20\n",
       lens + window},
      {"pipeline workers", "[pipeline]\nworkers = 3\n"},
      {"pipeline worker_cores", "[pipeline]\nworker_cores = [0]\n"},
      {"pipeline neighbour_weights", "[pipeline]\nneighbour_weights = [0, 1, 0]\n"},
      {"pipeline flow", "[scan]\nrepeats = 2\n[pipeline]\nflow = true\n", "[scan]\nrepeats = 2\n"},
      {"devices line_camera", "[devices]\nline_camera = \"sim\"\n"},
      {"devices significant_bits", "[devices]\nsignificant_bits = 10\n"},
      {"devices right_shift", "[devices]\nright_shift = 4\n"},
      {"devices exposure_us", "[devices]\nexposure_us = 4\n"},
      {"devices gain", "[devices]\ngain = 12\n"},
      {"devices camera_input", "[devices]\ncamera_input = 1\n"},
      {"devices galvo_trigger", "[devices]\ngalvo_trigger = \"gpio\"\n"},
      {"devices trigger_line", "[devices]\ntrigger_line = \"gpiochip0:17\"\n"},
      {"devices sync_line", "[devices]\nsync_line = \"gpiochip0:18\"\n"},
      {"devices pulse_width_us", "[devices]\npulse_width_us = 60\n"},
      {"devices control_input", "[devices]\ncontrol_input = \"hid\"\n"},
      {"devices scope_camera", "[devices]\nscope_camera = \"none\"\n"},
      {"devices connector", "[devices]\nconnector = \"HDMI-A-1\"\n"},
      {"devices mode", "[devices]\nmode = \"1920x1080@60\"\n"},
      {"devices overscan_percent", "[devices]\noverscan_percent = 5\n"},
      {"devices seat", "[devices]\nseat = false\n"},
      {"display width", "[display]\nwidth = 640\n"},
      {"display height", "[display]\nheight = 360\n"},
      {"display fullscreen", "[display]\nfullscreen = true\n"},
      {"display window_offset_db", "[display]\nwindow_offset_db = 12\nwindow_size_db = 30\n",
       "[display]\n" + window},
      {"display window_size_db", "[display]\nwindow_offset_db = 3\nwindow_size_db = 20\n",
       "[display]\n" + window},
      {"display veil_after_s", "[display]\nveil_after_s = 0.5\n"},
      {"display technique", "[display]\ntechnique = \"maximum\"\n"},
      {"display transfer", "[display]\ntransfer = \"surface\"\n"},
      {"display colours", "[display]\ncolours = \"amber\"\n"},
      {"display opacity", "[display]\nopacity = 0.1\n"},
      {"display rolling", "[display]\nrolling = true\n"},
      {"orientation right_eye_x", lies("temporal", "superior"), lies("nasal", "superior")},
      {"orientation right_eye_y", lies("temporal", "superior"), lies("temporal", "inferior")},
      {"orientation x_label", "[orientation]\nx_label = \"across\"\n"},
      {"orientation y_label", "[orientation]\ny_label = \"along\"\n"},
      {"orientation z_label", "[orientation]\nz_label = \"down\"\n"},
      {"transfer name", names("other", "mine"), names("mine", "other")},
      {"transfer kind", kinds("spline"), kinds("piecewise")},
      {"transfer points", curve + "points = [[0, 0], [1, 0.1]]\n", curve + points},
      {"transfer colours", curve + points + "colours = \"amber\"\n", curve + points},
      {"transfer file", curve + "kind = \"table\"\nfile = \"falling.csv\"\n",
       curve + "kind = \"table\"\nfile = \"rising.csv\"\n"},
      {"controls profile", "[controls]\nprofile = \"powermate\"\n"},
      {"controls file", "[controls]\nfile = \"" + profile + "\"\n"},
      {"controls device", "[controls]\ndevice = \"device.toml\"\n"},
      {"controls keyboards", "[controls]\nkeyboards = [\"046d:c31c\"]\n"},
      {"observation metrics", "[observation]\nmetrics = \"metrics.prom\"\n"},
      {"recordings folder", "[recordings]\nfolder = \"kept\"\n"},
      {"sim phantom", "[sim]\nphantom = \"cap\"\n"},
      {"sim loop_volumes", "[sim]\nloop_volumes = 2\n"},
      {"sim galvo_lag_us", "[sim]\ngalvo_lag_us = 40\n"},
      {"sim axial_motion", "[sim]\naxial_motion = [[10, 1.2]]\n"},
      {"sim lateral_motion", "[sim]\nlateral_motion = [[10, 1.2]]\n"},
      {"sim faults", "[sim]\nfaults = \"" + faults + "\"\n"},
      {"sim controls", "[sim]\ncontrols = \"" + controls + "\"\n"},
  };
}

// One volume, as often as it is asked for.
class OneVolume final : public pipeline::VolumeFeed {
public:
  void bring(hal::TimePoint now) {
    ++volume_.metadata.index;
    volume_.metadata.last_line = volume_.metadata.published = now;
    fresh_ = true;
  }

private:
  const pipeline::Volume* do_take_newest() override {
    return std::exchange(fresh_, false) ? &volume_ : nullptr;
  }
  bool do_has_newer() const override { return fresh_; }
  bool do_lends() const override { return true; } // though none is ever in the making
  pipeline::VolumeCounters do_counters() const override { return {}; }

  // As from the pipeline.
  pipeline::Volume volume_ = [] {
    pipeline::Volume volume = tissue_volume(small_geometry);
    volume.occupancy = pipeline::Occupancy{volume.geometry, pipeline::blank_depth_bins};
    volume.occupancy.update(volume);
    volume.work.resize(volume.b_scan_states.size());
    return volume;
  }();
  bool fresh_ = false;
};

class EveryKey : public LoopStage {
protected:
  void SetUp() override {
    LoopStage::SetUp();
    std::string curve;
    for (int i = 0; i < 1024; ++i)
      curve += std::to_string(i) + "\n";
    folder_.write("k.txt", curve);
    folder_.write("calibration.toml",
                  "[spectrometer]\nsamples = 1024\n[k_linear]\ntable = \"k.txt\"\n");
    folder_.write("rising.csv", "0\n0.5\n1\n");
    folder_.write("falling.csv", "1\n0.5\n0\n");
    folder_.write("device.toml", "usb = \"1234:00ff\"\nname = \"pedal\"\n"
                                 "[[switch]]\nbyte = 1\nmask = 4\n");
  }

  Configuration read(const std::string& text) {
    auto read = load_configuration(folder_.write("octascope.toml", text));
    EXPECT_TRUE(read) << text << read.error().message;
    return read ? *read : Configuration{};
  }

  // What a run is made of, where that is more than the configuration itself.
  static auto made_of(const Configuration& c) {
    const hal::DisplayConfig display = display_config({}, c);
    return std::tuple{plan_of({}, c),
                      std::tuple{c.depth_spacing_said, c.calibration,
                                 c.objective ? c.objective->name : std::string{}},
                      std::tuple{c.workers, c.worker_cores, c.neighbour_weights.here, c.flow,
                                 c.devices, display.width, display.height, display.fullscreen},
                      std::tuple{c.metrics, c.recording_folder},
                      std::tuple{c.phantom, c.loop_volumes, c.galvo_lag_us, c.tissue_motion,
                                 c.faults, c.controls}};
  }

  void start(const std::string& text) {
    const Configuration configuration = read(text);
    const fs::path file = folder_ / "octascope.toml";
    ChosenConfiguration chosen;
    chosen.configuration = configuration;
    chosen.wanted = chosen.used = file;
    live_ =
        std::make_unique<LiveConfiguration>(chosen, RunOptions{}, std::nullopt, clock_, faults_);
    RenderLoopSetup made = setup();
    made.window_from_first_volume = true;
    made.view.legend_visible = shows_profile(text);
    if (configuration.orientation.on_eye.right_eye_x)
      made.host.whose.eye = pipeline::Eye::right;
    made.freshness = {.volume_period = 141ms, .veil_after = configuration.veil_after};
    auto controls = load_controls(configuration);
    ASSERT_TRUE(controls) << controls.error().message;
    made.controls = std::move(*controls);
    live_->configure(made);
    open(std::move(made), volumes_of_tissue_, nullptr, nullptr);
    live_->follow(std::make_unique<ConfigurationWatch>(file, ReloadSignal::ignored));
    volumes_of_tissue_.bring(clock_.now());
    turn();
  }

  // In the legend, which hides the small pictures, and whose pages turn with time.
  static bool shows_profile(const std::string& text) { return text.starts_with("[controls]"); }
  ui::Rect legend_title() const {
    const pipeline::VolumeGeometry& g = small_geometry;
    const ui::Layout layout = ui::lay_out(
        display_.width(), display_.height(),
        {.b_scan = g.a_mm() / g.depth_mm(), .en_face = g.a_mm() / g.b_mm(), .has_scope = false},
        ui::LayoutKind::volume, {.legend = true});
    return {layout.legend.x, layout.legend.y, layout.legend.width / 2,
            static_cast<int>(36 * layout.unit)};
  }

  // What is said of the file once it was read again.
  std::string reload(const std::string& text) {
    folder_.write("octascope.toml", text);
    for (int i = 0; i < 5000 && live_->notice().empty(); ++i) {
      live_->advance(*loop_);
      turn();
      std::this_thread::sleep_for(1ms);
    }
    return std::string{live_->notice()};
  }

  // Above the status bar, whose figures are of the moment; where the veil has come, or not yet.
  pipeline::Image picture() {
    volumes_of_tissue_.bring(clock_.now());
    turn_until(clock_.now() + 700ms);
    auto drawn = loop_->picture();
    EXPECT_TRUE(drawn);
    drawn->height = ui::lay_out(drawn->width, drawn->height, {}).status_bar.y;
    drawn->pixels.resize(static_cast<std::size_t>(drawn->width * drawn->height * 3));
    return std::move(*drawn);
  }

  ScratchFolder folder_;
  OneVolume volumes_of_tissue_;
  std::unique_ptr<LiveConfiguration> live_;
};

TEST_F(EveryKey, of_the_table_is_tried_here) {
  std::set<std::string> table;
  for (const auto& [key, live] : table_of_keys())
    table.insert(key);
  std::set<std::string> tried;
  for (const KeyCase& one : key_cases())
    EXPECT_TRUE(tried.insert(std::string{one.key}).second) << one.key;
  EXPECT_GE(table.size(), 60U);
  EXPECT_EQ(tried, table);
}

TEST_F(EveryKey, that_waits_acts_at_start_and_is_named_when_it_is_edited) {
  const std::map<std::string, bool> table = table_of_keys();
  for (const KeyCase& one : key_cases()) {
    if (table.at(std::string{one.key}))
      continue;
    SCOPED_TRACE(one.key);
    const Configuration without = read(one.without);
    const Configuration with = read(one.with);
    EXPECT_NE(made_of(without), made_of(with));
    EXPECT_EQ(changes_for_a_restart(without, with).size(), 1U);
    EXPECT_THAT(changes_for_a_restart(without, without), testing::IsEmpty());
  }
}

TEST_F(EveryKey, that_does_not_wait_shows_at_start_and_the_same_when_it_is_edited) {
  const std::map<std::string, bool> table = table_of_keys();
  for (const KeyCase& one : key_cases()) {
    if (!table.at(std::string{one.key}))
      continue;
    SCOPED_TRACE(one.key);
    start(one.with);
    const pipeline::Image started = picture();
    const std::string without =
        shows_profile(one.with) && one.without.empty() ? "[controls]\n" : one.without;
    start(without);
    const pipeline::Image before = picture();
    EXPECT_EQ(reload(one.with), "Configuration read anew");
    const pipeline::Image edited = picture();
    const ui::Rect all =
        shows_profile(one.with) ? legend_title() : ui::Rect{0, 0, started.width, started.height};
    EXPECT_GT(count_different(started, before, all, 0), 20);
    EXPECT_EQ(count_different(started, edited, all, 0), 0);
  }
}

TEST_F(EveryKey, that_waits_is_told_on_the_display) {
  start("");
  EXPECT_EQ(reload("[recordings]\nfolder = \"kept\"\n[controls]\nkeyboards = [\"046d:c31c\"]\n"),
            "Restart to use [controls] devices, [recordings]");
}

} // namespace
} // namespace octascope::tests

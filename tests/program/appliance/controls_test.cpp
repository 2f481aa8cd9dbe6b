// Every action, done by the twin's pedal and knob: what becomes of the view, and of the picture.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include "pipeline/recordings/recording_reader.h"
#include "pipeline/vessels/registration.h"
#include "tests/program/program_support.h"
#include "tests/support/program/built_places.h"
#include "ui/view/action.h"

namespace octascope::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string script() {
  return (source_folder() / "sim" / "controls" / "every_action.toml").string();
}

// As the small one, with a window that the first volume does not change.
fs::path write_configuration(const ScratchFolder& folder, std::string_view more) {
  std::ostringstream text;
  text << std::ifstream{write_small_configuration(folder)}.rdbuf()
       << "[display]\nwindow_offset_db = 4\nwindow_size_db = 60\n"
       << more;
  return folder.write("controls.toml", text.str());
}

// Runs in `folder`, where snapshots then lie.
ProgramResult run_in(const ScratchFolder& folder, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"sh", "-c", "cd \"$0\" && exec \"$@\"", folder.path().string()};
  const std::vector<std::string> program = octascope_command(arguments);
  words.insert(words.end(), program.begin(), program.end());
  return run_program(words);
}

// The pictures that the surgeon kept, the first one first.
std::vector<pipeline::Image> kept_pictures(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator{folder})
    if (entry.path().filename().string().starts_with("octascope-") &&
        entry.path().extension() == ".png")
      files.push_back(entry.path());
  std::ranges::sort(files, {}, [](const fs::path& file) { return fs::last_write_time(file); });
  std::vector<pipeline::Image> pictures;
  for (const fs::path& file : files)
    pictures.push_back(read_snapshot(file));
  return pictures;
}

// The one that the pedal began, and the program's end ended.
std::size_t recorded_volumes(const fs::path& folder) {
  std::size_t volumes = 0;
  for (const auto& entry : fs::directory_iterator{folder}) {
    if (entry.path().extension() != ".h5")
      continue;
    const auto reader = pipeline::RecordingReader::open(entry.path());
    EXPECT_TRUE(reader) << reader.error().message;
    if (reader && reader->end().finished)
      volumes += reader->volumes().size();
  }
  return volumes;
}

fs::path kept_registration(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator{folder})
    if (entry.path().filename().string().starts_with("registration-"))
      return entry.path();
  return {};
}

// The middle of the volume's picture: no badge, no echo, no figure of the status bar.
int changed_in_the_middle(const pipeline::Image& a, const pipeline::Image& b) {
  const ui::Rect view = layout_of(a).view;
  return count_different(
      a, b, {view.width / 5, view.height / 5, view.width * 3 / 5, view.height * 3 / 5}, 8);
}

TEST(Controls, a_pedal_and_a_knob_do_everything) {
  const ScratchFolder folder;
  const fs::path report_file = folder / "report.json";
  const fs::path last_file = folder / "last.png";
  folder.write("tree.swc", "1 18 -300 0 0 200 -1\n2 18 300 0 0 200 1\n");
  const ProgramResult result = run_in(
      folder, {"run", "--sim", "--config", write_configuration(folder, ""), "--display",
               "offscreen", "--size", "640x360", "--controls", script(), "--duration", "24.6",
               "--vessels", "tree.swc", "--report", report_file, "--snapshot", last_file});
  ASSERT_EQ(result.exit_status, 0) << result.describe();

  const json report = read_report(report_file);
  const json& actions = report.at("actions");
  EXPECT_EQ(actions.size(), ui::action_count);
  for (const auto& [name, count] : actions.items())
    EXPECT_GE(count.get<int>(), 1) << name;
  EXPECT_EQ(actions["snapshot"], 4);
  EXPECT_EQ(actions["adjust"], 40);
  EXPECT_EQ(actions["next_parameter"], 40);

  const json& view = report.at("view");
  expect_all(view, json::parse(R"({
    "window_offset_db": 6, "window_size_db": 58, "yaw_deg": 41, "tilt_deg": 38, "distance": 3,
    "parallax_deg": 3.5, "technique": "shaded", "layout": "quad", "stereo": "side_by_side",
    "cut": "b_scan", "see_through_db": 14, "frozen": true, "rolling": true, "vessels": "off", "box": false, "legend": true,
    "figures": "strip", "selected": "figures", "zoom_to_tissue": false, "calliper": false, "vessel_colours": "order", "vessel_shift_mm": [0, 0, 0]
  })"));
  EXPECT_EQ(view["b_scan"], small_b_scans / 2 + 2);
  EXPECT_EQ(view["a_scan"], small_a_scans / 2 + 8);
  EXPECT_EQ(view["mark_1_a"], small_a_scans / 3 - 4);
  EXPECT_EQ(view["mark_2_a"], small_a_scans * 2 / 3 + 3);
  EXPECT_EQ(view["mark_1_depth"].get<int>() - view["mark_2_depth"].get<int>(), 5 + 2);
  EXPECT_NEAR(view["opacity"].get<double>(), 0.6, 1e-3);
  EXPECT_NEAR(view["vessel_opacity"].get<double>(), 0.7, 1e-3);

  // The tree lay with its middle in the volume's; then it was turned and shifted.
  const fs::path kept_place = kept_registration(folder.path());
  const auto registration = pipeline::Registration::load(kept_place);
  ASSERT_TRUE(registration) << registration.error().message << '\n' << result.describe();
  EXPECT_EQ(registration->provenance.method, "moved by hand on the display");
  EXPECT_EQ(registration->provenance.source, "tree.swc, before: not registered");
  const auto& turned = registration->volume_from_tree.rotation;
  EXPECT_NEAR(turned[2][1], std::sin(4 * 0.5 * std::numbers::pi / 180), 2e-3);
  EXPECT_NEAR(turned[0][2], std::sin(-4 * 0.5 * std::numbers::pi / 180), 2e-3);

  EXPECT_GE(recorded_volumes(folder.path()), 1U);

  const std::vector<pipeline::Image> kept = kept_pictures(folder.path());
  ASSERT_EQ(kept.size(), 4U) << "as it was, rotated, without the box, with another window";
  for (std::size_t i = 1; i < kept.size(); ++i)
    EXPECT_GT(changed_in_the_middle(kept[i - 1], kept[i]), 50) << "picture " << i + 1;
  const pipeline::Image last = read_snapshot(last_file);
  const ui::Rect right{last.width * 2 / 3, 0, last.width / 3, last.height * 2 / 3};
  EXPECT_GT(count_different(kept.back(), last, right, 8), 2000) << "the legend";
}

TEST(Controls, a_profile_of_ones_own_is_read_or_refused_with_its_line) {
  const ScratchFolder folder;
  folder.write("mine.toml", "name = \"Mine\"\n[[bind]]\nswitch = \"lefty\"\naction = \"box\"\n");
  const ProgramResult result =
      run_octascope({"run", "--sim", "--config",
                     write_configuration(folder, "[controls]\nfile = \"mine.toml\"\n"), "--display",
                     "offscreen", "--volumes", "1"});
  EXPECT_NE(result.exit_status, 0);
  EXPECT_NE(result.err.find("mine.toml:2: [bind] switch is \"lefty\""), std::string::npos)
      << result.err;
}

} // namespace
} // namespace octascope::tests

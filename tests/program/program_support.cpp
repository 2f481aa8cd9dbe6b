#include "tests/program/program_support.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace octascope::tests {

namespace fs = std::filesystem;

fs::path write_small_configuration(const ScratchFolder& folder) {
  return folder.write("small.toml", R"([scan]
samples = 128
a_scans = 24
fly_back_lines = 6
b_scans = 20
line_rate_hz = 3000
depth_spacing_um = 28
a_spacing_um = 250
b_spacing_um = 300
[pipeline]
workers = 2
[sim]
loop_volumes = 1
)");
}

ProgramResult run_well(std::vector<std::string> arguments, WallClock::duration most) {
  ProgramResult result = run_octascope(std::move(arguments), most);
  EXPECT_EQ(result.exit_status, 0) << result.describe();
  return result;
}

std::string run_refused(const ScratchFolder& folder, std::vector<std::string> arguments,
                        int exit_status) {
  const auto before = listing(folder.path());
  const ProgramResult result = run_octascope(std::move(arguments), std::chrono::seconds{60});
  EXPECT_EQ(result.exit_status, exit_status) << result.describe();
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  EXPECT_TRUE(result.err.starts_with("octascope") && result.err.ends_with('\n')) << result.err;
  EXPECT_EQ(listing(folder.path()), before);
  return result.err;
}

std::vector<std::string> small_run(const ScratchFolder& folder, std::vector<std::string> more) {
  std::vector<std::string> words{
      "run",       "--sim",     "--config", write_small_configuration(folder),
      "--display", "offscreen", "--size",   fmt::format("{}x{}", small_width, small_height)};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

nlohmann::json read_report(const fs::path& file) {
  std::ifstream in{file};
  auto report = nlohmann::json::parse(in, nullptr, false);
  if (report.is_object())
    return report;
  ADD_FAILURE() << file << " is no report";
  return nlohmann::json::object();
}

void expect_all(const nlohmann::json& said, const nlohmann::json& expected) {
  for (const auto& [key, value] : expected.items()) {
    SCOPED_TRACE(key);
    if (!said.contains(key))
      ADD_FAILURE() << "missing";
    else if (value.is_object())
      expect_all(said[key], value);
    else if (value.is_number_float() && said[key].is_number())
      EXPECT_NEAR(said[key].get<double>(), value.get<double>(), 1e-9);
    else
      EXPECT_EQ(said[key], value);
  }
}

nlohmann::json find_fault(const nlohmann::json& report, std::string_view device,
                          std::string_view kind) {
  for (const auto& fault : report.at("faults")) {
    if (fault.at("device") == device && fault.at("kind") == kind)
      return fault;
  }
  return nullptr;
}

void expect_nothing_lost(const nlohmann::json& report) {
  if (!find_fault(report, "pipeline", "late_tick").is_null() ||
      !find_fault(report, "line_camera", "late_frame").is_null())
    return;
  EXPECT_EQ(report["lost"], (nlohmann::json{{"lines", 0}, {"b_scans", 0}, {"volumes", 0}}));
  EXPECT_EQ(report["hot_path"]["allocations"], 0);
}

pipeline::Image read_snapshot(const fs::path& file) {
  auto image = pipeline::read_png(file);
  if (image)
    return std::move(*image);
  ADD_FAILURE() << image.error().message;
  return {};
}

ui::Layout layout_of(const pipeline::Image& picture) {
  return ui::lay_out(picture.width, picture.height, {});
}

// The frame of a stale view is outside.
ui::Rect badge_row(const pipeline::Image& picture) {
  return layout_of(picture).marks;
}

ui::Rect notice_row(const pipeline::Image& picture) {
  const ui::Layout layout = layout_of(picture);
  ui::Rect row = layout.notice;
  row.width = std::min(row.width, static_cast<int>(20 * layout.unit));
  return row;
}

std::vector<std::string> listing(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator{folder})
    names.push_back(entry.path().string());
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace octascope::tests

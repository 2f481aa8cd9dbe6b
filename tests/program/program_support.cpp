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

nlohmann::json find_fault(const nlohmann::json& report, std::string_view device,
                          std::string_view kind) {
  for (const auto& fault : report.at("faults")) {
    if (fault.at("device") == device && fault.at("kind") == kind)
      return fault;
  }
  return nullptr;
}

pipeline::Image read_snapshot(const fs::path& file) {
  auto image = pipeline::read_png(file);
  if (image)
    return std::move(*image);
  ADD_FAILURE() << image.error().message;
  return {};
}

namespace {

// Every channel of the pixel there, as the largest difference from another pixel.
int difference(const std::uint8_t* a, const std::uint8_t* b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

const std::uint8_t* pixel(const pipeline::Image& picture, int x, int y) {
  return &picture
              .pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                           static_cast<std::size_t>(x))];
}

} // namespace

int count_colour(const pipeline::Image& picture, const ui::Rect& where, ui::Colour colour,
                 int tolerance) {
  if (picture.channels != 3 || picture.pixels.empty())
    return 0;
  const std::uint8_t wanted[3] = {colour.r, colour.g, colour.b};
  int count = 0;
  for (int y = where.y; y < where.bottom(); ++y) {
    for (int x = where.x; x < where.right(); ++x)
      count += difference(pixel(picture, x, y), wanted) <= tolerance;
  }
  return count;
}

int count_different(const pipeline::Image& a, const pipeline::Image& b, const ui::Rect& where,
                    int tolerance) {
  int count = 0;
  for (int y = where.y; y < where.bottom(); ++y) {
    for (int x = where.x; x < where.right(); ++x)
      count += difference(pixel(a, x, y), pixel(b, x, y)) > tolerance;
  }
  return count;
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

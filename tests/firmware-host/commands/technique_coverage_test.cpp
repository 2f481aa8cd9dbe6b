// No technique leaves out what all others show: of each phantom, from several sides.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "firmware-host/commands/volume/render.h"
#include "firmware-host/run/volume_source.h"
#include "pipeline/surface/iso_surface_thread.h"
#include "pipeline/volume/level_scale.h"
#include "sim/phantoms/phantom.h"
#include "sim/phantoms/phantom_instrument.h"
#include "ui/canvas/palette.h"
#include "ui/transfer/auto_window.h"
#include "ui/volume/surface_technique.h"

namespace octascope::tests {
namespace {

constexpr int width = 320;
constexpr int height = 200;

// What is drawn in a picture, pixel by pixel.
class Mask {
public:
  explicit Mask(bool all) : drawn_(std::size_t{width} * height, all ? 1 : 0) {}
  // `darkest`: that is seen, of 255.
  explicit Mask(const pipeline::Image& picture, int darkest) : Mask{false} {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        at(x, y) = picture.pixel(x, y)[1] >= ui::palette::background.g + darkest ? 1 : 0;
  }

  std::uint8_t& at(int x, int y) { return drawn_[static_cast<std::size_t>(y * width + x)]; }
  bool within(int x, int y, int reach) const {
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height - 1); ++v)
      for (int u = std::max(x - reach, 0); u <= std::min(x + reach, width - 1); ++u)
        if (drawn_[static_cast<std::size_t>(v * width + u)] != 0)
          return true;
    return false;
  }
  void keep(const Mask& other) {
    for (std::size_t i = 0; i < drawn_.size(); ++i)
      drawn_[i] &= other.drawn_[i];
  }
  void take_out_near(const Mask& other, int reach) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        at(x, y) = at(x, y) != 0 && !other.within(x, y, reach) ? 1 : 0;
  }
  std::ptrdiff_t count() const { return std::ranges::count(drawn_, 1); }

  // Pixels of the largest piece that hangs together.
  std::ptrdiff_t largest_piece() const {
    Mask left = *this;
    std::ptrdiff_t largest = 0;
    std::vector<std::array<int, 2>> open;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        std::ptrdiff_t pixels = 0;
        open.push_back({x, y});
        while (!open.empty()) {
          const auto [u, v] = open.back();
          open.pop_back();
          if (u < 0 || v < 0 || u >= width || v >= height || left.at(u, v) == 0)
            continue;
          left.at(u, v) = 0;
          ++pixels;
          for (const auto& [du, dv] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
            open.push_back({u + du, v + dv});
        }
        largest = std::max(largest, pixels);
      }
    return largest;
  }

private:
  std::vector<std::uint8_t> drawn_;
};

// Vertices of the surface that a view shows, by the column of voxels that they are in.
class SurfaceColumns {
public:
  SurfaceColumns(const pipeline::Volume& volume, float level) : geometry_{volume.geometry} {
    pipeline::IsoSurfaceThread thread{pipeline::blank_depth_bins};
    thread.show(volume);
    thread.request(level);
    thread.wait();
    for (const pipeline::IsoVertex& vertex : thread.take_newest()->vertices)
      depths_mm_[{static_cast<int>(static_cast<double>(vertex.position_mm[1]) * 1e3 /
                                   geometry_.a_spacing_um),
                  static_cast<int>(static_cast<double>(vertex.position_mm[2]) * 1e3 /
                                   geometry_.b_spacing_um)}]
          .push_back(vertex.position_mm[0]);
  }

  bool has(int a, int b, float depth_mm, float within_mm) const {
    for (int v = b - 1; v <= b + 1; ++v)
      for (int u = a - 4; u <= a + 4; ++u)
        if (const auto found = depths_mm_.find({u, v}); found != depths_mm_.end())
          if (std::ranges::any_of(found->second,
                                  [&](float at) { return std::abs(at - depth_mm) < within_mm; }))
            return true;
    return false;
  }

private:
  pipeline::VolumeGeometry geometry_;
  std::map<std::array<int, 2>, std::vector<float>> depths_mm_;
};

// Of twelve voxels from there on, as a count.
float mean_level(const pipeline::Volume& volume, int a, int b, int bin) {
  constexpr int length = 12;
  const int depths = volume.geometry.depths;
  const auto voxels = volume.b_scan(b).subspan(
      static_cast<std::size_t>(a * depths + std::clamp(bin, 0, depths - length)), length);
  return static_cast<float>(std::accumulate(voxels.begin(), voxels.end(), 0)) / length;
}

class TechniqueCoverage : public testing::TestWithParam<std::string_view> {};

TEST_P(TechniqueCoverage, leaves_out_nothing_that_all_others_show) {
  firmware_host::VolumeRequest request;
  request.phantom = std::string{GetParam()};
  const auto loaded = firmware_host::load_volume(request);
  ASSERT_TRUE(loaded) << loaded.error().message;
  for (const auto& [yaw, tilt] :
       {std::array{35.0F, 50.0F}, {-60.0F, 70.0F}, {150.0F, 60.0F}, {0.0F, 85.0F}}) {
    std::map<ui::Technique, Mask> masks;
    for (const ui::Technique technique : ui::all_techniques) {
      firmware_host::RenderOptions options;
      options.view.technique = technique;
      options.view.yaw_deg = yaw;
      options.view.tilt_deg = tilt;
      options.view.box_visible = false;
      options.width = width;
      options.height = height;
      const auto picture = firmware_host::render_volume(loaded->volume, options);
      ASSERT_TRUE(picture) << picture.error().message;
      // What is lit may be dark: it is there, nevertheless.
      const bool lit = technique == ui::Technique::shaded || technique == ui::Technique::surface;
      masks.emplace(technique, Mask{*picture, lit ? 15 : 30});
    }
    for (const ui::Technique technique : ui::all_techniques) {
      SCOPED_TRACE(testing::Message() << to_string(technique) << " from " << yaw << ", " << tilt);
      Mask others{true};
      for (const auto& [other, mask] : masks)
        if (other != technique)
          others.keep(mask);
      Mask missing = others;
      missing.take_out_near(masks.at(technique), 2);
      EXPECT_GT(others.count(), width * height / 40);
      // A surface is open where the volume ends: the tissue's cut face is not drawn.
      EXPECT_LE(missing.count(), others.count() / 200);
      EXPECT_LE(missing.largest_piece(), 50);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Phantoms, TechniqueCoverage, testing::ValuesIn(sim::phantom_names),
                         [](const auto& test) { return std::string{test.param}; });

// An instrument before tissue, which no silhouette tells.
TEST(InstrumentInSurface, is_where_the_others_show_it) {
  constexpr const char* name = "anterior_eye";
  const auto phantom = sim::make_phantom(name, 1);
  ASSERT_TRUE(phantom) << phantom.error().message;
  ASSERT_NE((*phantom)->instrument(), nullptr);
  firmware_host::VolumeRequest request;
  request.phantom = name;
  const auto loaded = firmware_host::load_volume(request);
  ASSERT_TRUE(loaded) << loaded.error().message;
  const pipeline::VolumeGeometry& g = loaded->volume.geometry;
  const auto window = ui::suggest_window(loaded->volume);
  ASSERT_TRUE(window);
  ui::ViewState view;
  view.window_offset_db = window->offset_db;
  view.window_size_db = window->size_db;
  const SurfaceColumns surface{loaded->volume, ui::surface_level(view)};
  const float middle_db = window->offset_db + window->size_db / 2;
  int there = 0;
  int shown = 0;
  for (int b = 0; b < g.b_scans; ++b) {
    const auto pose = (*phantom)->instrument()->pose((b + 0.5) / g.b_scans); // a loop of one volume
    for (int a = 0; a < g.a_scans; a += 3) {
      const auto top =
          pose.top_at(static_cast<float>((a + 0.5 - g.a_scans / 2.0) * g.a_spacing_um * 1e-3),
                      static_cast<float>((b + 0.5 - g.b_scans / 2.0) * g.b_spacing_um * 1e-3));
      if (!top || static_cast<double>(top->depth_mm) > g.depth_mm() || top->facing < 0.5F)
        continue;
      // In the open, and bright enough to be more than a haze to the others: under the cornea's
      // reflex it is dark.
      const auto bin =
          static_cast<int>(static_cast<double>(top->depth_mm) * 1e3 / g.depth_spacing_um);
      if (mean_level(loaded->volume, a, b, bin) < pipeline::level_count(middle_db) ||
          mean_level(loaded->volume, a, b, bin - 30) > pipeline::level_count(window->offset_db))
        continue;
      ++there;
      shown += surface.has(a, b, top->depth_mm, 0.08F) ? 1 : 0;
    }
  }
  EXPECT_GT(there, 40);
  EXPECT_GT(shown, there * 95 / 100);
}

} // namespace
} // namespace octascope::tests

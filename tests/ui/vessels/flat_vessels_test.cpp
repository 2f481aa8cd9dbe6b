// Vessels in the flat pictures, by what they do to them.
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <gmock/gmock.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "tests/ui/support/renderer_stage.h"
#include "tests/ui/support/vessels/vessel_along.h"
#include "ui/gl/framebuffer.h"
#include "ui/vessels/sections/flat_vessels.h"

namespace octascope::tests {
namespace {

using ui::FlatVessels;
using ui::VesselPanel;

// ---- A picture of vessels alone, over black.

constexpr int pixels_per_mm = 100;
constexpr ui::Rect panel_rect{0, 0, 300, 179}; // a B-scan of the small geometry
constexpr float plane_mm = 20.5F * 0.075F;     // of its B-scan 20

class FlatVesselsTest : public GlTest {
protected:
  void SetUp() override {
    open(panel_rect.width, panel_rect.height);
    if (IsSkipped())
      return;
    auto made = FlatVessels::create();
    ASSERT_TRUE(made) << made.error().message;
    vessels_.emplace(std::move(*made));
    view_.b_scan = 20;
  }
  void TearDown() override { vessels_.reset(); }

  pipeline::Image draw(VesselPanel panel, const ui::PicturePlace& place) {
    glViewport(0, 0, panel_rect.width, panel_rect.height);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const auto drawn = vessels_->draw(panel, {view_, geometry_, tissue_, volume_}, place, 1,
                                      panel_rect, panel_rect.height);
    EXPECT_TRUE(drawn) << drawn.error().message;
    return ui::gl::read_framebuffer(panel_rect.width, panel_rect.height);
  }
  pipeline::Image draw_b_scan() {
    return draw(VesselPanel::b_scan,
                ui::place_in_panel(ui::FlatPicture::b_scan, geometry_, {}, panel_rect));
  }
  // Through the tree's frame, which is the volume's.
  void show(const pipeline::ClusterArrays& tree) {
    vessels_->show({tree.view(), {}, pipeline::RigidTransform{}});
  }

  // From 0.45 mm on; what lies down to 1.12 mm is in the slab of the en-face picture.
  void show_tissue() {
    pipeline::Volume volume = uniform_volume(geometry_, 60);
    for (int b = 0; b < geometry_.b_scans; ++b)
      for (int a = 0; a < geometry_.a_scans; ++a)
        std::fill_n(volume.b_scan(b).begin() + a * geometry_.depths + 36, 24, std::uint8_t{150});
    pipeline::Occupancy occupancy{geometry_, pipeline::blank_depth_bins};
    occupancy.update(volume);
    tissue_.update(occupancy, volume.b_scan_states);
  }

  const pipeline::VolumeGeometry geometry_ = small_geometry;
  ui::TissueMap tissue_;
  ui::ViewState view_;
  std::uint64_t volume_ = 1;
  std::optional<FlatVessels> vessels_;
};

int green(const pipeline::Image& image, int x, int y) {
  return image.pixel(x, y)[1];
}

// Green of the vessel's colour times the opacities of line and tint (vessel_section.frag).
constexpr double line_green = 255 * 0.76 * 0.9;
constexpr double tint_green = 255 * 0.76 * 0.22;

TEST_F(FlatVesselsTest, a_vessel_in_the_plane_is_a_band_and_across_it_a_ring) {
  // Radius 6 pixels; its axis 100.5 pixels down.
  const auto along = vessel_along({{0.5F, plane_mm, 1.005F}, {2.5F, plane_mm, 1.005F}}, 0.06F);
  show(along);
  pipeline::Image picture = draw_b_scan();
  for (const int x : {80, 150, 220}) {
    EXPECT_NEAR(green(picture, x, 100), tint_green, 3) << "inside";
    EXPECT_GT(green(picture, x, 94) + green(picture, x, 95), line_green * 0.8) << "the upper wall";
    EXPECT_GT(green(picture, x, 105) + green(picture, x, 106), line_green * 0.8) << "the lower one";
    EXPECT_EQ(green(picture, x, 91), 0);
    EXPECT_EQ(green(picture, x, 109), 0);
  }
  EXPECT_EQ(green(picture, 40, 100), 0);
  const auto across = vessel_along({{1.005F, 0.5F, 0.805F}, {1.005F, 2.5F, 0.805F}}, 0.06F);
  show(across);
  picture = draw_b_scan();
  double sum = 0;
  double x_sum = 0;
  double y_sum = 0;
  for (int y = 60; y < 100; ++y)
    for (int x = 80; x < 120; ++x) {
      const double from_axis = std::hypot(x + 0.5 - 100.5, y + 0.5 - 80.5);
      const int value = green(picture, x, y);
      sum += value;
      x_sum += value * (x + 0.5);
      y_sum += value * (y + 0.5);
      if (from_axis < 4.5) {
        EXPECT_NEAR(value, tint_green, 3);
      } else if (from_axis > 7.5) {
        EXPECT_EQ(value, 0);
      } else if (std::abs(from_axis - 6) < 0.2) {
        EXPECT_NEAR(value, line_green, 25);
      }
    }
  EXPECT_NEAR(x_sum / sum, 100.5, 0.05);
  EXPECT_NEAR(y_sum / sum, 0.805 * panel_rect.height / geometry_.depth_mm(), 0.05);
}

TEST_F(FlatVesselsTest, at_a_slant_the_line_is_the_exact_ellipse) {
  // At 30° to the plane, in which it runs along the fast axis: half axes r / sin 30° and r.
  const float down_mm = 0.905F;
  const auto tree = vessel_along(
      {{1.505F - 0.866F, plane_mm - 0.5F, down_mm}, {1.505F + 0.866F, plane_mm + 0.5F, down_mm}},
      0.08F);
  show(tree);
  const pipeline::Image picture = draw_b_scan();
  int judged = 0;
  for (int y = 70; y < 110; ++y)
    for (int x = 110; x < 190; ++x) {
      const double across = (x + 0.5 - 150.5) / 16;
      const double down = (y + 0.5 - 90.5) / 8;
      const double from_ellipse = std::abs(std::hypot(across, down) - 1) * 8;
      if (from_ellipse < 0.15) {
        ++judged;
        EXPECT_GT(green(picture, x, y), line_green * 0.6) << x << ' ' << y;
      } else if (from_ellipse > 2.5) {
        EXPECT_LT(green(picture, x, y), tint_green + 3) << x << ' ' << y;
      }
    }
  EXPECT_GT(judged, 10);
}

TEST_F(FlatVesselsTest, no_line_runs_through_a_vessel_where_segments_meet) {
  const auto tree = vessel_along({{0.5F, plane_mm, 1.005F},
                                  {0.9F, plane_mm, 1.005F},
                                  {1.5F, plane_mm + 0.01F, 1.005F},
                                  {2.0F, plane_mm, 1.005F},
                                  {2.5F, plane_mm, 1.005F}},
                                 0.06F);
  show(tree);
  const pipeline::Image picture = draw_b_scan();
  for (int x = 52; x < 249; ++x)
    EXPECT_NEAR(green(picture, x, 100), tint_green, 3) << x;
}

TEST_F(FlatVesselsTest, fade_with_the_distance_from_the_plane) {
  const float radius_mm = 0.06F;
  const auto reach_mm = static_cast<float>(ui::section_reach_mm(geometry_));
  EXPECT_NEAR(reach_mm, 0.15F, 1e-6F) << "two steps between B-scans";
  for (const float side : {-1.0F, 1.0F})
    for (const float share : {0.1F, 0.25F, 0.5F, 0.75F, 0.9F}) {
      const float y_mm = plane_mm + side * (radius_mm + share * reach_mm);
      const auto tree = vessel_along({{0.5F, y_mm, 1.005F}, {2.5F, y_mm, 1.005F}}, radius_mm);
      show(tree);
      const pipeline::Image picture = draw_b_scan();
      EXPECT_NEAR(green(picture, 150, 100), tint_green * (1 - double{share}), 3) << share;
      EXPECT_LT(green(picture, 150, 95), tint_green) << "no line: the plane cuts no wall";
      EXPECT_EQ(green(picture, 150, 91), 0);
    }
  const float y_mm = plane_mm + radius_mm + 1.05F * reach_mm;
  const auto beyond = vessel_along({{0.5F, y_mm, 1.005F}, {2.5F, y_mm, 1.005F}}, radius_mm);
  show(beyond);
  EXPECT_EQ(green(draw_b_scan(), 150, 100), 0);
}

TEST_F(FlatVesselsTest, a_vessel_that_is_cut_is_not_broken_by_one_that_is_not) {
  const auto cut = vessel_along({{0.5F, plane_mm, 1.005F}, {2.5F, plane_mm, 1.005F}}, 0.06F);
  show(cut);
  const pipeline::Image alone = draw_b_scan();
  pipeline::VesselTree both;
  both.positions_mm = {{0.5F, plane_mm, 1.005F},
                       {2.5F, plane_mm, 1.005F},
                       {1.5F, plane_mm + 0.2F, 0.3F},
                       {1.5F, plane_mm + 0.2F, 1.6F}};
  both.radii_mm = {0.06F, 0.06F, 0.12F, 0.12F};
  both.parents = {pipeline::no_parent, 0, pipeline::no_parent, 2};
  both.orders = {8, 8, 8, 8};
  both.branches.assign(4, pipeline::VesselBranch::unknown);
  const auto arrays = pipeline::build_clusters(both);
  show(arrays);
  const pipeline::Image crossed = draw_b_scan();
  EXPECT_GT(green(crossed, 150, 60), 5) << "it is there";
  for (int x = 130; x < 170; ++x)
    for (const int y : {94, 95, 105, 106})
      EXPECT_GE(green(crossed, x, y) + 2, green(alone, x, y)) << x;
}

TEST_F(FlatVesselsTest, obey_the_opacity) {
  const auto tree = vessel_along({{0.5F, plane_mm, 1.005F}, {2.5F, plane_mm, 1.005F}}, 0.06F);
  show(tree);
  const int full = green(draw_b_scan(), 150, 95);
  view_.vessel_opacity = 0.5F;
  EXPECT_NEAR(green(draw_b_scan(), 150, 95), full / 2.0, 3);
}

TEST_F(FlatVesselsTest, lie_in_the_microscopes_picture_as_the_scan_does) {
  show_tissue();
  // Along the fast axis through the middle of the field.
  const auto tree = vessel_along({{0.3F, 1.5F, 0.7F}, {2.7F, 1.5F, 0.7F}}, 0.1F);
  show(tree);
  const ui::ScanField turned{{{{0.4F, 0.2F}, {0.8F, 0.4F}, {0.6F, 0.8F}, {0.2F, 0.6F}}}};
  const pipeline::Image picture =
      draw(VesselPanel::microscope, ui::place_in_field(geometry_, turned, panel_rect));
  // From the middle of the first A-scans' side to the middle of the last ones'.
  const auto at = [](double share) {
    return std::array{300 * (0.3 + 0.4 * share), 179 * (0.4 + 0.2 * share)};
  };
  for (const double share : {0.15, 0.5, 0.85}) {
    const auto [x, y] = at(share);
    EXPECT_NEAR(green(picture, static_cast<int>(x), static_cast<int>(y)), tint_green, 4) << share;
  }
  for (const double share : {0.0, 1.0}) {
    const auto [x, y] = at(share);
    EXPECT_EQ(green(picture, static_cast<int>(x), static_cast<int>(y)), 0) << share;
  }
  EXPECT_EQ(green(picture, 150, 40), 0);
}

TEST_F(FlatVesselsTest, from_above_deep_vessels_are_weak_and_break_no_strong_one) {
  show_tissue();
  pipeline::VesselTree both;
  both.positions_mm = {
      {0.3F, 1.5F, 0.7F}, {2.7F, 1.5F, 0.7F}, {1.5F, 0.3F, 1.37F}, {1.5F, 2.7F, 1.37F}};
  both.radii_mm = {0.1F, 0.1F, 0.1F, 0.1F};
  both.parents = {pipeline::no_parent, 0, pipeline::no_parent, 2};
  both.orders = {8, 8, 8, 8};
  both.branches.assign(4, pipeline::VesselBranch::unknown);
  const auto tree = pipeline::build_clusters(both);
  show(tree);
  const pipeline::Image picture =
      draw(VesselPanel::en_face,
           ui::place_in_panel(ui::FlatPicture::from_above, geometry_, {}, panel_rect));
  const int middle = panel_rect.height / 2;
  EXPECT_NEAR(green(picture, 80, middle), tint_green, 4) << "in the slab";
  EXPECT_NEAR(green(picture, 150, 40), tint_green * 6 / 16, 4)
      << "a quarter of a millimetre deeper";
  int wall = 0;
  for (int y = middle - 12; y < middle; ++y)
    wall = std::max(wall, green(picture, 80, y));
  EXPECT_GT(wall, 2 * tint_green);
  for (int x = 130; x < 170; ++x) {
    int here = 0;
    for (int y = middle - 12; y < middle; ++y)
      here = std::max(here, green(picture, x, y));
    EXPECT_GE(here + 2, wall) << x;
  }
}

TEST_F(FlatVesselsTest, pictures_are_kept_until_something_changes) {
  const auto tree = vessel_along({{0.5F, plane_mm, 1.005F}, {2.5F, plane_mm, 1.005F}}, 0.06F);
  show(tree);
  const pipeline::Image first = draw_b_scan();
  const std::uint64_t drawings = vessels_->drawings();
  ++volume_;
  view_.yaw_deg += 5;
  EXPECT_EQ(draw_b_scan().pixels, first.pixels);
  EXPECT_EQ(vessels_->drawings(), drawings);
  view_.b_scan = 21;
  EXPECT_NE(draw_b_scan().pixels, first.pixels);
  EXPECT_EQ(vessels_->drawings(), drawings + 1);
}

// ---- In the whole display.

class VesselsInPanels : public RendererTest {
protected:
  static constexpr int width = 1280;
  static constexpr int height = 720;

  void SetUp() override {
    open_renderer(width, height);
    if (IsSkipped())
      return;
    show_scene();
    view_.layout = ui::LayoutKind::quad;
    view_.zoom_to_tissue = false;
    view_.b_scan = 20;
    view_.a_scan = 50;
    show_tree(pipeline::RigidTransform{});
  }

  void show_tree(const std::optional<pipeline::RigidTransform>& registration) {
    ASSERT_TRUE(
        renderer_->show_vessels({arrays_.view(), {1.5, plane_mm, 0.8}, registration}, clock_));
  }

  ui::Layout places() const {
    const pipeline::VolumeGeometry& g = small_geometry;
    const double deep = g.depth_mm();
    return ui::lay_out(width, height,
                       {g.a_mm() / deep, g.a_mm() / g.b_mm(), 4.0 / 3, true, g.b_mm() / deep},
                       view_.layout);
  }

  // Pixels that the vessels change in B-scan, crossed one, en face and microscope.
  std::array<int, 4> changes() {
    ui::ViewState hidden = view_;
    hidden.vessels = ui::VesselsShown::off;
    const pipeline::Image with = draw(view_, status_);
    const pipeline::Image without = draw(hidden, status_);
    const ui::Layout at = places();
    return {changed(with, without, at.b_scan.picture), changed(with, without, at.crossed.picture),
            changed(with, without, at.en_face.picture), changed(with, without, at.scope.picture)};
  }

  // A T in the plane of B-scan 20, in the tissue.
  const pipeline::ClusterArrays arrays_ =
      vessel_along({{0.3F, plane_mm, 0.8F}, {2.7F, plane_mm, 0.8F}, {1.5F, 2.8F, 0.8F}}, 0.06F);
  ui::ViewState view_;
  ui::Status status_ = live_status();
};

using testing::Each;
using testing::ElementsAre;
using testing::Gt;

TEST_F(VesselsInPanels, are_in_each_flat_picture_of_each_layout) {
  for (const ui::LayoutKind kind : {ui::LayoutKind::volume, ui::LayoutKind::b_scan,
                                    ui::LayoutKind::microscope, ui::LayoutKind::quad}) {
    view_.layout = kind;
    const ui::Layout at = places();
    const auto [b_scan, crossed, en_face, scope] = changes();
    EXPECT_GT(b_scan, 200);
    EXPECT_TRUE(crossed > 8 || !at.crossed.shown());
    EXPECT_GT(en_face, 200);
    EXPECT_GT(scope, 40);
  }
}

TEST_F(VesselsInPanels, are_not_where_they_are_not_registered) {
  show_tree(std::nullopt);
  EXPECT_THAT(changes(), Each(0));
}

TEST_F(VesselsInPanels, leave_the_b_scan_when_it_moves_away) {
  view_.b_scan = 5;
  EXPECT_EQ(changes()[0], 0);
  EXPECT_GT(changes()[1], 8) << "the crossed one has not moved";
}

TEST_F(VesselsInPanels, are_not_drawn_into_a_b_scan_that_is_missing) {
  auto volume = tissue_volume(small_geometry);
  volume.b_scan_states[20] = pipeline::BScanState::missing;
  ASSERT_TRUE(renderer_->show_volume(volume));
  EXPECT_EQ(changes()[0], 0);
  EXPECT_GT(changes()[1], 8);
}

TEST_F(VesselsInPanels, are_not_drawn_over_an_old_microscope_picture) {
  status_.now += std::chrono::seconds{5};
  EXPECT_EQ(changes()[3], 0);
  EXPECT_GT(changes()[2], 200);
}

TEST_F(VesselsInPanels, are_not_drawn_over_a_live_microscope_picture_from_an_old_volume) {
  for (const ui::Liveness liveness :
       {ui::Liveness::stale, ui::Liveness::veiled, ui::Liveness::frozen}) {
    status_.freshness = {liveness, std::chrono::seconds{2}, {}};
    EXPECT_EQ(changes()[3], 0);
    EXPECT_GT(changes()[2], 100) << "where the en face's own mark says how old it is";
  }
}

TEST_F(VesselsInPanels, lie_in_both_eyes_pictures) {
  view_.stereo = ui::StereoMode::side_by_side;
  ui::ViewState hidden = view_;
  hidden.vessels = ui::VesselsShown::off;
  const pipeline::Image with = draw(view_, status_);
  const pipeline::Image without = draw(hidden, status_);
  const ui::Rect b_scan = places().b_scan.picture;
  const int left =
      changed(with, without, {b_scan.x / 2, b_scan.y, b_scan.width / 2, b_scan.height});
  const int right =
      changed(with, without, {width / 2 + b_scan.x / 2, b_scan.y, b_scan.width / 2, b_scan.height});
  EXPECT_GT(left, 100);
  EXPECT_NEAR(left, right, 8);
}

} // namespace
} // namespace octascope::tests

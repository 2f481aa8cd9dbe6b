// Vessels within the volume: what veils them, what they hide, and where they are not, nothing.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "pipeline/volume/level_scale.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/golden.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/ray_caster/ray_frame.h"
#include "ui/ray_caster/ray_geometry.h"
#include "ui/renderer.h"
#include "ui/scene/volume_painter.h"
#include "ui/view/plane_box.h"
#include "ui/view/vessel_look.h"

namespace octascope::tests {
namespace {

using ui::RayBackend;
using ui::Technique;

// Odd: the middle of the picture is the middle of a pixel.
constexpr int width = 97;
constexpr int height = 61;
constexpr ui::Rect rect{0, 0, width, height};

struct Way {
  const char* name;
  Technique technique;
  RayBackend backend;
};
constexpr Way ways[] = {
    {"slices", Technique::slices, RayBackend::shader},
    {"planes", Technique::planes, RayBackend::shader},
    {"rays by GL", Technique::rays, RayBackend::shader},
    {"rays by the processor", Technique::rays, RayBackend::processor},
    {"shaded by GL", Technique::shaded, RayBackend::shader},
    {"shaded by the processor", Technique::shaded, RayBackend::processor},
    {"maximum by GL", Technique::maximum, RayBackend::shader},
    {"maximum by the processor", Technique::maximum, RayBackend::processor},
};

constexpr float straight_radius_mm = 0.25F;

// One vessel along the fast axis through the tree's origin.
pipeline::ClusterArrays straight_vessel() {
  pipeline::VesselTree tree;
  tree.positions_mm = {{-1.2F, 0, 0}, {1.2F, 0, 0}};
  tree.radii_mm = {straight_radius_mm, straight_radius_mm};
  tree.parents = {pipeline::no_parent, 0};
  tree.orders = {11, 11};
  tree.branches = {pipeline::VesselBranch::lad, pipeline::VesselBranch::lad};
  return pipeline::build_clusters(tree);
}

// `beyond_mm` from the volume's centre along the slow axis.
ui::PlacedVessels placed(const pipeline::ClusterArrays& tree, const pipeline::VolumeGeometry& g,
                         double beyond_mm) {
  pipeline::RigidTransform transform;
  transform.shift_mm = {g.a_mm() / 2, g.b_mm() / 2 + beyond_mm, g.depth_mm() / 2};
  return {tree.view(), {}, transform};
}

struct Rgb {
  double red = 0;
  double green = 0;
  double blue = 0;
};
Rgb mixed(const Rgb& from, const Rgb& to, double share) {
  return {from.red + share * (to.red - from.red), from.green + share * (to.green - from.green),
          from.blue + share * (to.blue - from.blue)};
}

class VesselOverlayTest : public GlTest {
protected:
  void SetUp() override {
    open(width, height);
    if (IsSkipped())
      return;
    auto made = ui::VolumePainter::create();
    ASSERT_TRUE(made) << made.error().message;
    painter_.emplace(std::move(*made));
    painter_->want_processor();
  }
  void TearDown() override { painter_.reset(); }

  void show(pipeline::Volume volume) {
    shown_ = std::move(volume);
    ASSERT_TRUE(painter_->show(shown_));
  }

  ui::Camera camera(const ui::ViewState& view) const {
    return ui::make_camera(view, ui::box_extents_mm(shown_.geometry),
                           static_cast<float>(width) / height);
  }

  // Over black, rows from the bottom.
  std::vector<std::uint8_t> draw(const ui::ViewState& view, RayBackend backend) {
    const ui::DrawQuality quality{1, 400, backend};
    EXPECT_TRUE(painter_->finish(shown_, view, quality));
    const auto updated = painter_->update(ui::StereoEye::left, view, camera(view), quality, rect);
    EXPECT_TRUE(updated) << updated.error().message;
    glViewport(0, 0, width, height);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    painter_->composite(ui::StereoEye::left, rect, height);
    std::vector<std::uint8_t> rgba(std::size_t{4} * width * height);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
  }

  static Rgb middle(const std::vector<std::uint8_t>& rgba) {
    const std::size_t at = std::size_t{4} * (width * (height / 2) + width / 2);
    return {static_cast<double>(rgba[at]), static_cast<double>(rgba[at + 1]),
            static_cast<double>(rgba[at + 2])};
  }

  std::optional<ui::VolumePainter> painter_;
  pipeline::Volume shown_;
};

// Along the slow axis, from the side of the last B-scan.
ui::ViewState along_slow_axis(Technique technique) {
  ui::ViewState view;
  view.yaw_deg = 0;
  view.tilt_deg = 0;
  view.distance = 3;
  view.opacity = 0.08F;
  view.technique = technique;
  return view;
}

// Light and opacity, 0 to 255 and 0 to 1, of `length_mm` of a uniform volume from its near side on.
struct Slab {
  double light = 0;
  double opacity = 0;
};
Slab slab(const Way& way, const ui::ViewState& view, const ui::Camera& camera,
          const pipeline::VolumeGeometry& geometry, double grey, double length_mm) {
  if (length_mm <= 0)
    return {};
  if (way.technique == Technique::maximum)
    return {255 * grey, grey};
  const ui::RayGeometry rays = ui::ray_geometry(geometry, camera);
  const double reference = ui::reference_step_mm(ui::box_extents_mm(geometry) / 2.0F);
  const double near = camera.depth_of({0, 0, geometry.b_mm() / 2});
  constexpr int parts = 2000;
  const double per_part =
      1 - std::pow(1 - grey * double{view.opacity}, length_mm / reference / parts);
  Slab result;
  double powers = 0;
  double depths = 0;
  for (int i = 0; i < parts; ++i) {
    const double depth = near + length_mm * (i + 0.5) / parts;
    const double weight = (1 - result.opacity) * per_part;
    powers += std::pow(weight, 4);
    depths += std::pow(weight, 4) * depth;
    result.light += 255 * grey * weight;
    result.opacity += weight;
  }
  if (way.technique == Technique::shaded) {
    const double share = (depths / powers - double{rays.cue_near_mm}) * double{rays.cue_per_mm};
    result.light *= 1 - double{ui::depth_cue} * std::clamp(share, 0.0, 1.0);
    // No slope anywhere, and the same all around.
    const double shade = double{ui::level_light} *
                         std::clamp(double{ui::open_light} - grey, double{ui::least_open}, 1.0);
    const double above = std::clamp((grey - static_cast<double>(ui::gleam_from)) /
                                        static_cast<double>(ui::gleam_to - ui::gleam_from),
                                    0.0, 1.0);
    result.light *= shade + above * above * (3 - 2 * above) * (1 - shade);
  }
  return result;
}

// The straight vessel's, where it rises to the eye.
Rgb vessel_colour(const ui::Camera& camera, const pipeline::VolumeGeometry& geometry,
                  double beyond_mm) {
  const ui::RayGeometry rays = ui::ray_geometry(geometry, camera);
  const ui::VesselLook look{ui::VesselColouring::branch, ui::depth_cue, rays.cue_near_mm,
                            rays.cue_near_mm + 1 / rays.cue_per_mm};
  const float surface_mm = static_cast<float>(beyond_mm) + straight_radius_mm;
  const double light = 255 * double{ui::vessel_fading(look, camera.depth_of({0, 0, surface_mm}))};
  const ui::VesselColour& colour =
      ui::branch_colours[static_cast<std::size_t>(pipeline::VesselBranch::lad)];
  return {light * double{colour[0]}, light * double{colour[1]}, light * double{colour[2]}};
}

TEST_F(VesselOverlayTest, a_uniform_volume_veils_a_vessel_as_theory_says) {
  const pipeline::VolumeGeometry& g = small_geometry;
  constexpr float level_db = 26; // half of the window
  show(uniform_volume(g, static_cast<std::uint8_t>(pipeline::level_count(level_db))));
  const auto tree = straight_vessel();
  for (const Way& way : ways) {
    const ui::ViewState first = along_slow_axis(way.technique);
    const double window_db =
        double{first.window_size_db} * double{ui::window_stretch(first.technique)};
    const double from_db = double{first.window_offset_db} +
                           double{ui::window_lift(first.technique)} * double{first.window_size_db};
    const double grey = (double{level_db} - from_db) / window_db;
    const ui::Camera eye = camera(first);
    const Slab whole = slab(way, first, eye, g, grey, g.b_mm());
    // Before the volume, near its front, in its middle, at its back, behind it: between slices.
    for (const double beyond_mm : {g.b_mm() / 2 + 0.3, 1.05, 0.0, -1.05, -g.b_mm() / 2 - 0.3}) {
      ASSERT_TRUE(painter_->show_vessels(placed(tree, g, beyond_mm), clock_));
      const double before =
          std::clamp(g.b_mm() / 2 - beyond_mm - double{straight_radius_mm}, 0.0, g.b_mm());
      const Slab veil = slab(way, first, eye, g, grey, before);
      const Rgb vessel = vessel_colour(eye, g, beyond_mm);
      const double left = 1 - veil.opacity;
      const Rgb opaque{veil.light + left * vessel.red, veil.light + left * vessel.green,
                       veil.light + left * vessel.blue};
      for (const float opacity : {1.0F, 0.5F, 0.0F}) {
        ui::ViewState view = first;
        view.vessel_opacity = opacity;
        const Rgb expected =
            mixed({whole.light, whole.light, whole.light}, opaque, double{opacity});
        const Rgb found = middle(draw(view, way.backend));
        const std::string what = std::string{way.name} + ", " + std::to_string(beyond_mm) +
                                 " mm, opacity " + std::to_string(opacity);
        // A sample more or less before the vessel, and the light of a vessel's rounding.
        EXPECT_NEAR(found.red, expected.red, 4) << what;
        EXPECT_NEAR(found.green, expected.green, 4) << what;
        EXPECT_NEAR(found.blue, expected.blue, 4) << what;
      }
    }
  }
}

TEST_F(VesselOverlayTest, a_surface_hides_what_is_behind_it_and_nothing_before_it) {
  const pipeline::VolumeGeometry& g = small_geometry;
  pipeline::Volume volume = uniform_volume(g, 0);
  for (int b = 5; b < g.b_scans - 10; ++b)
    std::ranges::fill(volume.b_scan(b), std::uint8_t{200});
  show(std::move(volume));
  const auto tree = straight_vessel();
  ui::ViewState view = along_slow_axis(Technique::surface);
  const Rgb surface = middle(draw(view, RayBackend::shader));
  EXPECT_GT(surface.red, 60) << "there is a surface";
  const Rgb vessel = vessel_colour(camera(view), g, 1.3);
  for (const float opacity : {1.0F, 0.5F}) {
    view.vessel_opacity = opacity;
    ASSERT_TRUE(painter_->show_vessels(placed(tree, g, 1.3), clock_));
    const Rgb before = middle(draw(view, RayBackend::shader));
    const Rgb expected = mixed(surface, vessel, double{opacity});
    EXPECT_NEAR(before.red, expected.red, 3);
    EXPECT_NEAR(before.blue, expected.blue, 3);
    ASSERT_TRUE(painter_->show_vessels(placed(tree, g, 0), clock_));
    const Rgb behind = middle(draw(view, RayBackend::shader));
    EXPECT_NEAR(behind.red, surface.red, 1);
    EXPECT_NEAR(behind.blue, surface.blue, 1);
  }
}

TEST_F(VesselOverlayTest, where_there_is_no_vessel_the_picture_is_the_volumes) {
  const pipeline::VolumeGeometry& g = small_geometry;
  show(tissue_volume(g));
  const auto tree = straight_vessel();
  for (const Way& way : ways) {
    ui::ViewState view = along_slow_axis(way.technique);
    view.yaw_deg = 30;
    view.tilt_deg = 40;
    view.opacity = 0.05F;
    ASSERT_TRUE(painter_->show_vessels({}, clock_));
    const auto alone = draw(view, way.backend);
    ASSERT_TRUE(painter_->show_vessels(placed(tree, g, 0.4), clock_));
    view.vessels = ui::VesselsShown::off;
    EXPECT_EQ(draw(view, way.backend), alone) << way.name << ": hidden";
    view.vessels = ui::VesselsShown::both;
    view.vessel_opacity = 0;
    EXPECT_EQ(draw(view, way.backend), alone) << way.name << ": with no opacity";
    for (const float opacity : {1.0F, 0.4F}) {
      view.vessel_opacity = opacity;
      const auto both = draw(view, way.backend);
      // Its ends and its thickness, projected.
      const ui::Camera eye = camera(view);
      std::size_t elsewhere = 0;
      std::size_t changed = 0;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const std::size_t at = std::size_t{4} * static_cast<std::size_t>(y * width + x);
          const bool same = std::equal(alone.begin() + static_cast<std::ptrdiff_t>(at),
                                       alone.begin() + static_cast<std::ptrdiff_t>(at) + 3,
                                       both.begin() + static_cast<std::ptrdiff_t>(at));
          float nearest = 1e9F;
          for (int i = 0; i <= 240; ++i) {
            const glm::vec2 p = eye.project({-1.2F + 0.01F * static_cast<float>(i), 0, 0.4F});
            nearest = std::min(
                nearest, std::hypot(static_cast<float>(x) + 0.5F - (width / 2.0F + p.x * height),
                                    static_cast<float>(height - 1 - y) + 0.5F -
                                        (height / 2.0F + p.y * height)));
          }
          const float radius =
              0.25F * height / (2 * eye.tan_half_height * eye.depth_of({0, 0, 0.4F}));
          if (nearest > 1.3F * radius + 2)
            elsewhere += same ? 0 : 1;
          else
            changed += same ? 0 : 1;
        }
      EXPECT_EQ(elsewhere, 0U) << way.name << ", opacity " << opacity;
      EXPECT_GT(changed, 30U) << way.name << ", opacity " << opacity;
    }
  }
}

TEST_F(VesselOverlayTest, processor_and_gl_draw_the_same_picture) {
  const pipeline::VolumeGeometry& g = small_geometry;
  show(tissue_volume(g));
  const auto tree = straight_vessel();
  ASSERT_TRUE(painter_->show_vessels(placed(tree, g, 0.2), clock_));
  for (const Technique technique : {Technique::rays, Technique::shaded, Technique::maximum})
    for (const float opacity : {1.0F, 0.6F}) {
      ui::ViewState view = along_slow_axis(technique);
      view.yaw_deg = 50;
      view.tilt_deg = 25;
      view.opacity = 0.3F;
      view.vessel_opacity = opacity;
      const auto by_gl = draw(view, RayBackend::shader);
      const auto by_processor = draw(view, RayBackend::processor);
      double sum = 0;
      for (std::size_t i = 0; i < by_gl.size(); ++i)
        sum += std::abs(static_cast<double>(by_gl[i]) - static_cast<double>(by_processor[i]));
      EXPECT_LE(sum / static_cast<double>(by_gl.size()), 1)
          << ui::to_string(technique) << ' ' << opacity;
    }
}

TEST_F(VesselOverlayTest, a_picture_is_kept_until_the_vessels_change) {
  const pipeline::VolumeGeometry& g = small_geometry;
  show(tissue_volume(g));
  const auto tree = straight_vessel();
  ASSERT_TRUE(painter_->show_vessels(placed(tree, g, 0.2), clock_));
  for (const RayBackend backend : {RayBackend::shader, RayBackend::processor}) {
    ui::ViewState view = along_slow_axis(Technique::rays);
    const auto first = draw(view, backend);
    const std::uint64_t drawings = painter_->drawings();
    EXPECT_EQ(draw(view, backend), first);
    EXPECT_EQ(painter_->drawings(), drawings);
    view.vessel_nudge.shift_mm[2] = 0.1F;
    EXPECT_NE(draw(view, backend), first) << "moved";
    view.vessel_nudge = {};
    view.vessel_colouring = ui::VesselColouring::order;
    EXPECT_NE(draw(view, backend), first) << "other colours";
    view.vessel_colouring = ui::VesselColouring::branch;
    EXPECT_EQ(draw(view, backend), first) << "as before";
  }
  const ui::VesselOverlay* vessels = painter_->vessels();
  ASSERT_NE(vessels, nullptr);
  EXPECT_EQ(vessels->account().total(), 1U);
}

// A fork of three vessels through layers of tissue, to be looked at.
pipeline::ClusterArrays forked_vessels() {
  using pipeline::VesselBranch;
  pipeline::VesselTree tree;
  tree.positions_mm = {{-1.3F, -0.2F, 0.1F},  {-0.3F, 0.1F, 0.25F}, {0.5F, -0.1F, -0.1F},
                       {1.4F, 0.3F, -0.5F},   {0.3F, 0.7F, 0},      {0.9F, 1.3F, -0.3F},
                       {-0.4F, -0.9F, -0.2F}, {0.3F, -1.4F, -0.5F}};
  tree.radii_mm = {0.12F, 0.11F, 0.1F, 0.08F, 0.06F, 0.04F, 0.07F, 0.05F};
  tree.parents = {pipeline::no_parent, 0, 1, 2, 1, 4, 0, 6};
  tree.orders = {11, 11, 10, 10, 9, 9, 9, 9};
  tree.branches = {VesselBranch::lcx, VesselBranch::lcx, VesselBranch::lcx, VesselBranch::lcx,
                   VesselBranch::lad, VesselBranch::lad, VesselBranch::rca, VesselBranch::rca};
  return pipeline::build_clusters(tree);
}

TEST_F(VesselOverlayTest, pictures_are_as_kept) {
  painter_.reset();
  open(320, 200);
  const auto made = ui::Renderer::create();
  ASSERT_TRUE(made) << made.error().message;
  ui::Renderer& renderer = **made;
  const auto tissue = tissue_volume(small_geometry);
  ASSERT_TRUE(renderer.show_volume(tissue));
  const auto tree = forked_vessels();
  ui::PlacedVessels vessels = placed(tree, small_geometry, 0);
  ASSERT_TRUE(renderer.show_vessels(vessels, clock_));
  ui::ViewState view;
  view.opacity = 0.06F;
  view.distance = 2.4F;
  view.box_visible = false;
  const auto expect_kept = [&](const std::string& name) {
    ASSERT_TRUE(renderer.prepare(tissue, view));
    ASSERT_TRUE(renderer.draw_volume_alone(view, 320, 200));
    expect_golden(renderer.read_back(320, 200), "vessels/" + name, golden_similarity);
  };
  expect_kept("veiled");
  view.technique = Technique::shaded;
  view.vessel_opacity = 0.6F;
  expect_kept("shaded_translucent");
  view.technique = Technique::surface;
  view.vessel_opacity = 1;
  view.vessel_colouring = ui::VesselColouring::order;
  expect_kept("surface_orders");
  view.technique = Technique::planes;
  view.vessel_colouring = ui::VesselColouring::branch;
  vessels.volume_from_tree.reset();
  ASSERT_TRUE(renderer.show_vessels(vessels, clock_));
  expect_kept("not_registered");
}

TEST_F(VesselOverlayTest, what_is_not_registered_lies_in_the_middle) {
  const pipeline::VolumeGeometry& g = small_geometry;
  const auto tree = straight_vessel();
  const ui::PlacedVessels vessels{tree.view(), {7, 8, 9}, std::nullopt};
  const auto at = ui::world_from_tree(vessels, {}, g) * glm::vec4{7, 8, 9, 1};
  EXPECT_NEAR(at.x, 0, 1e-5);
  EXPECT_NEAR(at.y, 0, 1e-5);
  EXPECT_NEAR(at.z, 0, 1e-5);
}

// A quarter turn about the depth axis takes the fast axis to the slow one; shifts come after it.
TEST_F(VesselOverlayTest, nudges_turn_about_the_volumes_centre_and_then_shift) {
  const pipeline::VolumeGeometry& g = small_geometry;
  const auto tree = straight_vessel();
  const ui::PlacedVessels vessels = placed(tree, g, 0);
  ui::VesselNudge nudge;
  nudge.turn_deg[2] = 90;
  nudge.shift_mm = {0.5F, 0, 0.25F};
  const auto to = ui::volume_from_tree(vessels, nudge, g).apply({1, 0, 0});
  EXPECT_NEAR(to[0], g.a_mm() / 2 + 0.5, 1e-9);
  EXPECT_NEAR(to[1], g.b_mm() / 2 + 1, 1e-9);
  EXPECT_NEAR(to[2], g.depth_mm() / 2 + 0.25, 1e-9);
}

} // namespace
} // namespace octascope::tests

// Pictures of vessel trees by GL, against the shape computed in double precision and each other.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "tests/support/allocation_counter.h"
#include "tests/support/vessels/random_tree.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/vessels/reference_vessels.h"
#include "tests/ui/support/vessels/vessel_stage.h"
#include "ui/gl/context_info.h"
#include "ui/vessels/quads/streamed_quads_method.h"

namespace octascope::tests {
namespace {

using ui::VesselMethodKind;

// From around, from above, and close by.
std::vector<ui::VesselView> views_of(const VesselStage& stage) {
  std::vector<ui::VesselView> views;
  for (const auto& [yaw, tilt, closer] : {std::array{35.0F, 15.0F, 1.0F},
                                          {160.0F, -50.0F, 1.0F},
                                          {0.0F, 90.0F, 1.0F},
                                          {80.0F, 0.0F, 2.0F}}) {
    ui::VesselView view = stage.whole();
    view.yaw_deg = yaw;
    view.tilt_deg = tilt;
    view.mm_per_pixel /= closer;
    views.push_back(view);
  }
  return views;
}

// Along the first segment thinner than that: seen from its end.
ui::VesselView end_on(const VesselStage& stage, const pipeline::VesselTree& tree, float radius_mm) {
  ui::VesselView view = stage.whole();
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    if (tree.parents[i] != pipeline::no_parent && tree.radii_mm[i] < radius_mm) {
      const auto& a = tree.positions_mm[tree.parents[i]];
      const auto& b = tree.positions_mm[i];
      const glm::vec3 axis = glm::normalize(glm::vec3{b[0] - a[0], b[1] - a[1], b[2] - a[2]});
      view.target_mm = {b[0], b[1], b[2]};
      view.yaw_deg = glm::degrees(std::atan2(axis.x, axis.z));
      view.tilt_deg = glm::degrees(std::asin(axis.y));
      break;
    }
  return view;
}

std::size_t pixel_count() {
  return std::size_t{VesselStage::width} * VesselStage::height;
}

class VesselMethods : public GlTest {
protected:
  void SetUp() override { open(VesselStage::width, VesselStage::height); }
};

TEST_F(VesselMethods, quads_are_the_shape_to_a_hundredth_of_a_pixel_and_tubes_to_one) {
  const pipeline::VesselTree tree = random_tree(1000, 3);
  VesselStage stage{tree};
  auto views = views_of(stage);
  for (const float radius : {0.5F, 0.05F, 0.01F})
    views.push_back(end_on(stage, tree, radius));
  for (const ui::VesselView& view : views) {
    const ui::VesselScene scene = stage.scene(view);
    const auto reference = reference_vessels(scene);
    const auto covered = std::ranges::count_if(reference, &ReferenceVesselPixel::covered);
    ASSERT_GT(covered, 500) << "the view shows something";
    for (const VesselMethodKind kind : drawn_methods) {
      const bool tubes = kind == VesselMethodKind::tubes_gpu || kind == VesselMethodKind::tubes_cpu;
      // Twice as near, the outline of a real ball is an ellipse that is longer than the disc by a
      // twentieth of its radius.
      const bool whole = view.mm_per_pixel > 0.9F * stage.whole().mm_per_pixel;
      const double tolerance = !tubes ? 0.01 : whole ? 1 : 2;
      const DrawnVessels drawn = stage.draw(stage.method(kind), scene);
      int wrong = 0;
      double worst = 0;
      for (std::size_t i = 0; i < pixel_count(); ++i) {
        const double inside = reference[i].inside_px;
        const double off = drawn.covered(i) ? -inside : inside;
        wrong += off > tolerance ? 1 : 0;
        worst = std::max(worst, off);
      }
      EXPECT_EQ(wrong, 0) << to_string(kind) << " at yaw " << view.yaw_deg << ", tilt "
                          << view.tilt_deg << ", " << view.mm_per_pixel << " mm a pixel: off by "
                          << worst << " pixels";
    }
  }
}

// Where the surface's own depth is not written (below 8 pixels of radius): that of the axis.
TEST_F(VesselMethods, quads_have_the_distance_and_brightness_of_the_nearest_axis) {
  pipeline::VesselTree tree = random_tree(1000, 4);
  for (float& radius : tree.radii_mm) // 1 to 8 pixels, in all views
    radius = std::clamp(radius, 0.16F, 0.2F);
  VesselStage stage{tree};
  for (const ui::VesselView& view : views_of(stage)) {
    const ui::VesselScene scene = stage.scene(view);
    const auto reference = reference_vessels(scene);
    const DrawnVessels drawn = stage.draw(stage.method(VesselMethodKind::quads_gpu), scene);
    int compared = 0;
    int apart = 0;
    for (std::size_t i = 0; i < pixel_count(); ++i) {
      const ReferenceVesselPixel& pixel = reference[i];
      if (!pixel.covered() || pixel.to_outline_px < 0.01)
        continue;
      ++compared;
      const double depth_mm = distance_mm(scene.camera, drawn.depth[i]);
      int brightest = 0; // of a branch's colour, whatever it is
      for (std::size_t channel = 0; channel < 3; ++channel)
        brightest = std::max(brightest, int{drawn.colour.pixels[3 * i + channel]});
      bool like_a_branch = false;
      for (const ui::VesselColour& colour : ui::branch_colours) {
        const auto strongest = static_cast<double>(std::max({colour[0], colour[1], colour[2]}));
        like_a_branch |= std::abs(255 * strongest * pixel.brightness - brightest) <= 2;
      }
      apart += !like_a_branch || std::abs(depth_mm - pixel.depth_mm) > 0.001 ? 1 : 0;
    }
    EXPECT_GT(compared, 300);
    EXPECT_LE(apart, compared / 500) << "at yaw " << view.yaw_deg << ": where two are equally near";
  }
}

TEST_F(VesselMethods, near_vessels_bulge_towards_the_eye_by_their_radius) {
  pipeline::VesselTree tree;
  tree.positions_mm = {{-5, 0, 0}, {5, 0, 0}};
  tree.radii_mm = {1, 1};
  tree.parents = {pipeline::no_parent, 0};
  tree.orders = {11, 11};
  tree.branches = {pipeline::VesselBranch::rca, pipeline::VesselBranch::rca};
  VesselStage stage{tree};
  ui::VesselView view = stage.whole();
  view.target_mm = {};
  view.yaw_deg = 0;
  view.tilt_deg = 0;
  const ui::VesselScene scene = stage.scene(view);
  for (const VesselMethodKind kind : drawn_methods) {
    const DrawnVessels drawn = stage.draw(stage.method(kind), scene);
    const auto middle = static_cast<std::size_t>(VesselStage::height / 2 * VesselStage::width +
                                                 VesselStage::width / 2);
    EXPECT_NEAR(distance_mm(scene.camera, drawn.depth[middle]),
                scene.camera.depth_of(glm::vec3{0}) - 1, 0.02F)
        << to_string(kind);
    EXPECT_EQ(drawn.account.drawn, 1U);
  }
}

// To the last bit where the processor is the GPU, too; others round their sums in their own way, so that an
// outline may pass a pixel's middle on the other side.
void expect_same(const DrawnVessels& drawn, const DrawnVessels& expected, VesselMethodKind kind) {
  if (ui::gl::describe_context().software) {
    EXPECT_TRUE(drawn.colour == expected.colour) << to_string(kind);
    EXPECT_TRUE(drawn.depth == expected.depth) << to_string(kind);
    return;
  }
  constexpr float hardly = 1e-5F;
  std::size_t apart = 0;
  for (std::size_t i = 0; i < expected.depth.size(); ++i)
    apart += std::abs(drawn.depth[i] - expected.depth[i]) > hardly ? 1U : 0U;
  EXPECT_LE(apart, expected.depth.size() / 500) << to_string(kind);
}

TEST_F(VesselMethods, whoever_expands_quads_makes_the_same_picture_to_the_last_bit) {
  VesselStage stage{random_tree(20000, 5)};
  for (const ui::VesselView& view : views_of(stage))
    for (const auto colouring : {ui::VesselColouring::branch, ui::VesselColouring::order}) {
      const ui::VesselScene scene = stage.scene(view, colouring);
      const DrawnVessels quads = stage.draw(stage.method(VesselMethodKind::quads_gpu), scene);
      for (const auto kind : {VesselMethodKind::quads_cpu, VesselMethodKind::balanced}) {
        const DrawnVessels drawn = stage.draw(stage.method(kind), scene);
        expect_same(drawn, quads, kind);
      }
    }
}

// Equal but for the colour: with nothing but red and white, the green of a pixel says who drew it.
TEST_F(VesselMethods, balanced_shows_and_reports_who_drew_what) {
  if (!ui::gl::describe_context().software)
    GTEST_SKIP() << "a GPU rounds in another way than the processor: colours alone cannot tell";
  VesselStage stage{random_tree(60000, 6)};
  const ui::VesselScene scene = stage.scene(stage.whole(), ui::VesselColouring::diagnostic);
  const DrawnVessels quads = stage.draw(stage.method(VesselMethodKind::quads_gpu), scene);
  auto& balanced = dynamic_cast<ui::StreamedQuadsMethod&>(stage.method(VesselMethodKind::balanced));
  bool shared = false;
  for (int attempt = 0; attempt < 50 && !shared; ++attempt) {
    const DrawnVessels drawn = stage.draw(balanced, scene);
    const ui::VesselShares shares = balanced.shares();
    EXPECT_EQ(shares.of_gl + shares.of_processor, drawn.account.drawn);
    EXPECT_TRUE(drawn.depth == quads.depth);
    std::size_t white = 0;
    for (std::size_t i = 0; i < pixel_count(); ++i) {
      const auto* found = drawn.colour.pixels.data() + 3 * i;
      const auto* expected = quads.colour.pixels.data() + 3 * i;
      ASSERT_EQ(found[0], expected[0]);
      const bool is_white = found[1] == found[0] && found[2] == found[0] && found[0] > 0;
      ASSERT_TRUE(is_white || (found[1] == expected[1] && found[2] == expected[2]));
      white += is_white ? 1 : 0;
    }
    EXPECT_TRUE(shares.of_processor > 0 || white == 0);
    shared = shares.of_gl > 0 && shares.of_processor > 0 && white > 0;
  }
  EXPECT_TRUE(shared) << "in fifty pictures, both have drawn";
}

TEST_F(VesselMethods, culling_changes_no_pixel_and_everything_is_accounted_for) {
  VesselStage stage{random_tree(4000, 7)};
  ui::VesselView close = stage.whole();
  close.mm_per_pixel /= 40;
  close.target_mm = {1, 0, 0};
  ui::VesselView aside = stage.whole();
  aside.target_mm += glm::vec3{15, 3, 0};
  aside.mm_per_pixel /= 3;
  std::uint64_t culled = 0;
  for (const ui::VesselView& view : {close, aside, stage.whole()}) {
    const ui::VesselScene scene = stage.scene(view);
    for (const VesselMethodKind kind : drawn_methods) {
      const DrawnVessels all = stage.draw(stage.method(kind, ui::ClusterChoice::all), scene);
      const DrawnVessels some = stage.draw(stage.method(kind), scene);
      expect_same(some, all, kind);
      EXPECT_EQ(all.account.drawn, stage.tree().segments);
      EXPECT_EQ(some.account.total(), stage.tree().segments);
      culled += some.account.culled;
    }
  }
  EXPECT_GT(culled, 0U);
}

TEST_F(VesselMethods, the_tree_may_be_moved_into_another_frame) {
  const pipeline::VesselTree tree = random_tree(1000, 8);
  VesselStage stage{tree};
  ui::VesselScene scene = stage.scene(stage.whole());
  const glm::vec3 target = stage.whole().target_mm;
  scene.world_from_tree = glm::translate(glm::mat4{1}, target) *
                          glm::rotate(glm::mat4{1}, 0.7F, glm::normalize(glm::vec3{1, 2, 3})) *
                          glm::translate(glm::mat4{1}, -target);
  const auto reference = reference_vessels(scene);
  const DrawnVessels drawn = stage.draw(stage.method(VesselMethodKind::quads_gpu), scene);
  for (std::size_t i = 0; i < pixel_count(); ++i)
    if (std::abs(reference[i].inside_px) > 0.01) {
      ASSERT_EQ(drawn.covered(i), reference[i].covered()) << i;
    }
}

TEST_F(VesselMethods, another_tree_is_another_picture_and_none_is_empty) {
  const auto nodes = std::make_shared<ui::NodeTexture>();
  for (const VesselMethodKind kind : drawn_methods) {
    auto method = ui::make_vessel_method(kind, nodes, {{}, {VesselStage::sectors}, {}});
    ASSERT_TRUE(method) << method.error().message;
    for (const unsigned seed : {1U, 2U}) {
      VesselStage stage{random_tree(300, seed)};
      const ui::VesselScene scene = stage.scene(stage.whole());
      EXPECT_TRUE(stage.draw(**method, scene).depth == stage.draw(stage.method(kind), scene).depth)
          << to_string(kind);
    }
    VesselStage empty{pipeline::VesselTree{}};
    const DrawnVessels drawn = empty.draw(**method, empty.scene(empty.whole()));
    EXPECT_EQ(drawn.account.total(), 0U);
    EXPECT_TRUE(std::ranges::all_of(drawn.depth, [](float depth) { return depth == 1; }));
  }
}

TEST_F(VesselMethods, drawing_allocates_nothing_after_the_first_frames) {
  VesselStage stage{random_tree(5000, 9)};
  auto picture = ui::VesselPicture::create();
  ASSERT_TRUE(picture) << picture.error().message;
  for (const VesselMethodKind kind : drawn_methods) {
    ui::VesselMethod& method = stage.method(kind);
    // The driver compiles when a combination comes for the first time, and with two threads it is
    // not known when the last has come.
    int without = 0;
    for (int frame = 0; frame < 60 && without < 6; ++frame) {
      ui::VesselView view = stage.whole();
      view.yaw_deg = static_cast<float>(40 * frame);
      view.mm_per_pixel /= static_cast<float>(1 + frame % 3);
      const std::uint64_t before = allocations_of_this_thread();
      EXPECT_TRUE(picture->draw(method, stage.scene(view)));
      without = allocations_of_this_thread() == before ? without + 1 : 0;
    }
    EXPECT_EQ(without, 6) << to_string(kind);
  }
}

TEST(VesselMethodNames, are_found_again) {
  for (const VesselMethodKind kind : ui::all_vessel_methods)
    EXPECT_EQ(ui::vessel_method_named(to_string(kind)), kind);
  EXPECT_FALSE(ui::vessel_method_named("lines"));
}

} // namespace
} // namespace octascope::tests

// Along a flight from the whole heart to the end of the LAD: the hybrid shows what full quads show,
// nothing pops up, and no connected vessel is lost.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "sim/coronary_tree/coronary_tree.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/picture_file.h"
#include "tests/ui/support/vessels/vessel_stage.h"
#include "ui/vessels/hybrid/hybrid_method.h"
#include "ui/vessels/hybrid/quads_share.h"
#include "ui/vessels/view/vessel_flight.h"

namespace octascope::tests {
namespace {

using Kind = ui::VesselMethodKind;

constexpr int width = VesselStage::width;
constexpr int height = VesselStage::height;
#ifdef OCTASCOPE_SANITIZED
constexpr std::uint32_t segments = 12'000;
constexpr int stretches = 5;
#else
constexpr std::uint32_t segments = 30'000;
constexpr int stretches = 14;
#endif
// Of each stretch. More pixels a step would change the picture so much that what pops up did not
// show beside it.
constexpr int steps = 3;
constexpr float step_px = 0.5F;

// Of 255. A frame of the hybrid may change by what quads change by in the same step, and so much.
// What it shows at the pixels' centres may differ from quads by so much, a pixel that shows
// something else counting 255; its colours are smoothed.
constexpr double most_beside_quads = 2;
constexpr double most_beyond_quads_step = 0.5;

// A heart of so few segments ends at order 5. Its orders are counted from the bottom, so that those
// that may be thinner than a pixel, and merged, are there too.
pipeline::VesselTree heart(std::uint64_t seed) {
  auto grown = sim::generate_coronary_tree({segments, seed, 2});
  EXPECT_TRUE(grown) << grown.error().message;
  const std::uint8_t lowest = *std::ranges::min_element(grown->tree.orders);
  for (std::uint8_t& order : grown->tree.orders)
    order = static_cast<std::uint8_t>(order - std::min<std::uint8_t>(lowest, 3));
  return std::move(grown->tree);
}

// The centre lines of connected vessels in a picture.
struct Centrelines {
  int places = 0; // a pixel apart, within the picture
  int lost = 0;   // with nothing as near as the vessel within a pixel
};

class CentrelineCheck {
public:
  CentrelineCheck(const ui::VesselScene& scene, const DrawnVessels& drawn)
      : scene_{scene}, drawn_{drawn} {}

  Centrelines check(const pipeline::VesselTree& tree) {
    for (std::size_t i = 0; i < tree.nodes(); ++i)
      if (tree.parents[i] != pipeline::no_parent && tree.orders[i] >= ui::least_order_kept_visible)
        follow(tree, i);
    return found_;
  }

private:
  struct Pixel {
    glm::vec2 at; // columns from the left, rows from the top
    float depth_mm;
  };

  Pixel project(const glm::vec3& place) const {
    const glm::vec2 p = scene_.camera.project(place);
    return {{width / 2.0F + p.x * height, height / 2.0F + p.y * height},
            scene_.camera.depth_of(place)};
  }

  void follow(const pipeline::VesselTree& tree, std::size_t node) {
    const auto place = [&](std::size_t i) {
      const auto& p = tree.positions_mm[i];
      return glm::vec3{p[0], p[1], p[2]};
    };
    const glm::vec3 from = place(tree.parents[node]);
    const glm::vec3 to = place(node);
    const float near_mm = 1.01F * scene_.camera.near_mm;
    const Pixel a = project(from);
    const Pixel b = project(to);
    if (a.depth_mm < near_mm || b.depth_mm < near_mm)
      return; // cut by the near plane
    const float length_px = glm::distance(a.at, b.at);
    const float slope_mm = std::abs(a.depth_mm - b.depth_mm) / std::max(length_px, 1.0F);
    // Where it is relief, its surface lies before the axis; places of clusters are rounded; a pixel
    // beside the place may be of its neighbour on the line.
    const float tolerance_mm =
        3 * slope_mm + 2 * tree.radii_mm[node] + 0.004F * std::max(a.depth_mm, b.depth_mm);
    const int parts = 1 + static_cast<int>(std::min(length_px, 2000.0F));
    for (int i = 0; i <= parts; ++i) {
      const Pixel pixel =
          project(from + (to - from) * (static_cast<float>(i) / static_cast<float>(parts)));
      look(pixel, tolerance_mm);
    }
  }

  void look(const Pixel& pixel, float tolerance_mm) {
    if (pixel.at.x < 1 || pixel.at.y < 1 || pixel.at.x >= width - 1 || pixel.at.y >= height - 1)
      return;
    const int x = static_cast<int>(pixel.at.x);
    const int y = static_cast<int>(pixel.at.y);
    float nearest = 1;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        nearest =
            std::min(nearest, drawn_.depth[static_cast<std::size_t>((y + dy) * width + x + dx)]);
    ++found_.places;
    found_.lost +=
        nearest < 1 && distance_mm(scene_.camera, nearest) <= double{pixel.depth_mm + tolerance_mm}
            ? 0
            : 1;
  }

  const ui::VesselScene& scene_;
  const DrawnVessels& drawn_;
  Centrelines found_;
};

// Of 255, by what the pixels' centres show.
double beside(const ui::Camera& camera, const DrawnVessels& a, const DrawnVessels& b) {
  std::size_t others = 0;
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    const double a_mm = distance_mm(camera, a.depth[i]);
    const double b_mm = distance_mm(camera, b.depth[i]);
    others += a.covered(i) != b.covered(i) || std::abs(a_mm - b_mm) > 1e-3 * b_mm;
  }
  return 255 * static_cast<double>(others) / static_cast<double>(a.depth.size());
}

// How a method's pictures differ from those of full quads, and from their own predecessors.
struct Comparison {
  double from_quads = 0;   // at most
  double change = 0;       // from frame to frame, at most
  double beyond_quads = 0; // of which, what quads do not change by, at most
  std::uint64_t merged = 0;
  Centrelines lines;
};

class VesselFlightTest : public GlTest {
protected:
  void SetUp() override { open(width, height); }

  // `before_frame` is called with each frame's stretch and step.
  template <class BeforeFrame>
  static Comparison fly(VesselStage& stage, const pipeline::VesselTree& tree,
                        ui::VesselMethod& method, BeforeFrame before_frame) {
    const ui::VesselFlight flight{stage.tree(), width, height};
    ui::VesselMethod& quads = stage.method(Kind::quads_cpu);
    const float step = step_px / flight.pixels();
    Comparison result;
    for (int stretch = 0; stretch < stretches; ++stretch) {
      std::optional<DrawnVessels> last;
      std::optional<DrawnVessels> last_quads;
      const float begin = (1 - steps * step) * static_cast<float>(stretch) / (stretches - 1);
      for (int i = 0; i <= steps; ++i) {
        const ui::VesselScene scene = stage.scene(flight.at(begin + step * static_cast<float>(i)));
        before_frame(stretch, i);
        DrawnVessels drawn = stage.draw(method, scene);
        DrawnVessels full = stage.draw(quads, scene);
        EXPECT_EQ(drawn.account.total(), stage.tree().segments) << stretch << ' ' << i;
        result.merged += drawn.account.merged;
        result.from_quads = std::max(result.from_quads, beside(scene.camera, drawn, full));
        const Centrelines lines = CentrelineCheck{scene, drawn}.check(tree);
        result.lines.places += lines.places;
        result.lines.lost += lines.lost;
        if (last) {
          const double change = compare(drawn.colour, last->colour).mean;
          result.change = std::max(result.change, change);
          result.beyond_quads =
              std::max(result.beyond_quads, change - compare(full.colour, last_quads->colour).mean);
        }
        last = std::move(drawn);
        last_quads = std::move(full);
      }
    }
    fmt::print(
        "  {:.2f}/255 from quads; {:.2f}/255 from frame to frame, {:.2f} beyond quads; {} of "
        "{} places lost\n",
        result.from_quads, result.change, result.beyond_quads, result.lines.lost,
        result.lines.places);
    return result;
  }

  static void expect_as_quads(const Comparison& found) {
    EXPECT_LE(found.from_quads, most_beside_quads);
    EXPECT_LE(found.beyond_quads, most_beyond_quads_step);
    EXPECT_GT(found.change, 0.5); // else it does not fly
    EXPECT_EQ(found.lines.lost, 0);
    EXPECT_GT(found.lines.places, 1000 * stretches);
  }

  static std::unique_ptr<ui::HybridMethod> hybrid(ui::HybridMethod::Share share) {
    auto made = ui::HybridMethod::create(1, {}, std::move(share));
    EXPECT_TRUE(made) << made.error().message;
    return std::make_unique<ui::HybridMethod>(std::move(*made));
  }
};

TEST_F(VesselFlightTest, goes_from_the_whole_heart_to_the_end_of_the_lad) {
  const pipeline::VesselTree tree = heart(1);
  VesselStage stage{tree};
  const ui::VesselFlight flight{stage.tree(), width, height};
  EXPECT_EQ(flight.at(0), stage.whole());
  EXPECT_GT(flight.length_mm(), 80); // as long as the heart
  const ui::VesselView end = flight.at(1);
  EXPECT_NEAR(end.mm_per_pixel, 0.004, 1e-5);
  bool met = false;
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    const auto& p = tree.positions_mm[i];
    if (glm::distance(glm::vec3{p[0], p[1], p[2]}, end.target_mm) < 0.02F) {
      EXPECT_EQ(tree.branches[i], pipeline::VesselBranch::lad);
      EXPECT_GE(tree.orders[i], ui::least_order_kept_visible);
      met = true;
    }
  }
  EXPECT_TRUE(met);
  // Nowhere faster than elsewhere: what is in the middle moves by few pixels in a thousandth.
  for (int i = 0; i < 1000; ++i) {
    const ui::VesselView a = flight.at(static_cast<float>(i) / 1000);
    const ui::VesselView b = flight.at(static_cast<float>(i + 1) / 1000);
    EXPECT_LE(glm::distance(a.target_mm, b.target_mm) / b.mm_per_pixel, 1.1e-3F * flight.pixels())
        << i;
    EXPECT_NEAR(a.mm_per_pixel / b.mm_per_pixel, 1, 0.01) << i;
  }
}

TEST_F(VesselFlightTest, comes_close_to_any_tree) {
  for (const ui::VesselFlight& flight :
       {ui::VesselFlight{{}, width, height},
        ui::VesselFlight{pipeline::build_clusters({}).view(), width, height}}) {
    EXPECT_EQ(flight.length_mm(), 0);
    EXPECT_EQ(flight.at(1).target_mm, flight.at(0).target_mm);
    EXPECT_GT(flight.pixels(), 0);
  }
}

TEST_F(VesselFlightTest, shows_what_quads_show_all_the_way) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const pipeline::VesselTree tree = heart(seed);
    VesselStage stage{tree};
    expect_as_quads(fly(stage, tree, stage.method(Kind::hybrid), [](int, int) {}));
  }
}

TEST_F(VesselFlightTest, shows_it_with_a_share_of_gl_too) {
  const pipeline::VesselTree tree = heart(3);
  VesselStage stage{tree};
  auto quads = ui::QuadsShare::create(std::make_shared<ui::NodeTexture>());
  ASSERT_TRUE(quads) << quads.error().message;
  expect_as_quads(fly(stage, tree, *hybrid({std::move(*quads), 1.5F}), [](int, int) {}));
}

TEST_F(VesselFlightTest, loses_no_connected_vessel_however_much_is_merged) {
  const pipeline::VesselTree tree = heart(4);
  VesselStage stage{tree};
  const auto method = hybrid({});
  method->set_detail_px(0.4F);
  const Comparison found = fly(stage, tree, *method, [](int, int) {});
  EXPECT_GT(found.merged, 0U);
  EXPECT_LE(found.beyond_quads, most_beyond_quads_step);
  EXPECT_EQ(found.lines.lost, 0);
}

// The checks above can fail: a detail that jumps is a picture that pops, and vessels that are drawn
// as thin as they are get lost.
TEST_F(VesselFlightTest, would_tell_what_pops) {
  const pipeline::VesselTree tree = heart(1);
  VesselStage stage{tree};
  const auto method = hybrid({});
  const Comparison found = fly(stage, tree, *method, [&](int stretch, int i) {
    method->set_detail_px(stretch == 2 && i == 2 ? 3.0F : 0.0F);
  });
  EXPECT_GT(found.from_quads, most_beside_quads);
  EXPECT_GT(found.beyond_quads, most_beyond_quads_step);
}

TEST_F(VesselFlightTest, would_tell_what_is_lost) {
  const pipeline::VesselTree tree = heart(1);
  pipeline::VesselTree unconnected = tree;
  for (std::uint8_t& order : unconnected.orders)
    order = std::min<std::uint8_t>(order, ui::least_order_kept_visible - 1);
  VesselStage stage{tree};
  VesselStage other{unconnected};
  ui::VesselView far = ui::VesselFlight{stage.tree(), width, height}.at(0);
  far.mm_per_pixel *= 4; // they are much thinner than a pixel
  const auto lost = [&](VesselStage& drawing) {
    const ui::VesselScene scene = drawing.scene(far);
    const DrawnVessels drawn = drawing.draw(drawing.method(Kind::hybrid), scene);
    return CentrelineCheck(scene, drawn).check(tree).lost;
  };
  EXPECT_EQ(lost(stage), 0);
  EXPECT_GT(lost(other), 10);
}

} // namespace
} // namespace octascope::tests

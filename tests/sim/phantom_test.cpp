#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sim/phantoms/phantom.h"
#include "sim/phantoms/phantom_anterior_eye.h"
#include "sim/phantoms/phantom_profile.h"
#include "sim/phantoms/phantom_tree.h"
#include "tests/support/fails_with.h"

namespace octascope::sim {
namespace {

using tests::FailsSaying;

bool same(const Column& a, const Column& b) {
  const auto same_layer = [](const Layer& l, const Layer& m) {
    return l.top_mm == m.top_mm && l.bottom_mm == m.bottom_mm &&
           l.backscatter_counts == m.backscatter_counts && l.flowing == m.flowing;
  };
  const auto same_surface = [](const Surface& s, const Surface& t) {
    return s.depth_mm == t.depth_mm && s.amplitude_counts == t.amplitude_counts;
  };
  return std::ranges::equal(a.layers(), b.layers(), same_layer) &&
         std::ranges::equal(a.surfaces(), b.surfaces(), same_surface);
}

class EveryPhantom : public testing::TestWithParam<std::string_view> {
protected:
  std::unique_ptr<Phantom> phantom_ = *make_phantom(GetParam(), 1);
  pipeline::VolumeGeometry field_ = phantom_->suggested_plan().geometry();

  template <class Visit> void for_each_place(const Visit& visit) const {
    constexpr int places = 60;
    for (int j = 0; j < places; ++j)
      for (int i = 0; i < places; ++i)
        visit(static_cast<float>(((i + 0.5) / places - 0.5) * field_.a_mm()),
              static_cast<float>(((j + 0.5) / places - 0.5) * field_.b_mm()));
  }
};

TEST_P(EveryPhantom, knows_its_name_and_suggests_a_plan_that_is_valid) {
  EXPECT_EQ(phantom_->name(), GetParam());
  EXPECT_FALSE(phantom_->title().empty());
  EXPECT_TRUE(phantom_->suggested_plan().validate());
}

TEST_P(EveryPhantom, comes_round_with_the_phase) {
  Column now;
  Column later;
  for_each_place([&](float x, float y) {
    phantom_->fill(now, 0.25, x, y);
    phantom_->fill(later, 3.25, x, y);
    ASSERT_TRUE(same(now, later)) << "at " << x << ", " << y;
  });
}

TEST_P(EveryPhantom, has_vessels_and_tissue_within_the_depth_range) {
  int with_vessel = 0;
  int with_tissue = 0;
  int places = 0;
  Column column;
  for_each_place([&](float x, float y) {
    phantom_->fill(column, 0, x, y);
    bool vessel = false;
    bool tissue = false;
    for (const Layer& layer : column.layers()) {
      const bool inside = layer.top_mm < static_cast<float>(field_.depth_mm());
      EXPECT_GT(layer.top_mm, 0.1F) << "above the first bins at " << x << ", " << y;
      vessel = vessel || (inside && layer.flowing);
      tissue = tissue || (inside && !layer.flowing);
    }
    EXPECT_LT(column.layers().size(), Column::most_layers) << "at " << x << ", " << y;
    ++places;
    with_vessel += vessel ? 1 : 0;
    with_tissue += tissue ? 1 : 0;
  });
  EXPECT_EQ(with_tissue, places);
  EXPECT_GT(with_vessel, places / 50);
  EXPECT_LT(with_vessel, places / 2);
}

// Its nodes lie in blood, but where the nail hides it, and the registration brings them to the voxels that the twin makes there.
TEST_P(EveryPhantom, has_a_tree_of_its_vessels_in_its_volume) {
  const PhantomTree made = phantom_tree(*phantom_);
  const pipeline::VesselTree& tree = made.tree;
  ASSERT_GT(tree.nodes(), 100U);
  std::size_t in_blood = 0;
  std::size_t roots = 0;
  Column column;
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    const auto [x, y, z] = tree.positions_mm[i];
    phantom_->fill(column, 0, x, y);
    in_blood += std::ranges::any_of(column.layers(), [&, depth = z](const Layer& layer) {
      return layer.flowing && layer.top_mm <= depth && depth <= layer.bottom_mm;
    });
    roots += tree.parents[i] == pipeline::no_parent;
    const pipeline::Point at = made.volume_from_tree.apply({x, y, z});
    // The middle of voxel (a, b, d) is seen at the depth of bin d by the beam's place of a and b.
    EXPECT_NEAR(at[0] / (field_.a_spacing_um / 1000) - 0.5,
                double{x} / (field_.a_spacing_um / 1000) + (field_.a_scans - 1) / 2.0, 1e-3);
    EXPECT_NEAR(at[1] / (field_.b_spacing_um / 1000) - 0.5,
                double{y} / (field_.b_spacing_um / 1000) + (field_.b_scans - 1) / 2.0, 1e-3);
    EXPECT_NEAR(at[2] / (field_.depth_spacing_um / 1000) - 0.5,
                double{z} / (field_.depth_spacing_um / 1000), 1e-3);
  }
  EXPECT_GT(static_cast<double>(in_blood), 0.9 * static_cast<double>(tree.nodes()));
  EXPECT_LT(roots, tree.nodes() / 10);
}

INSTANTIATE_TEST_SUITE_P(Phantom, EveryPhantom, testing::ValuesIn(phantom_names),
                         [](const auto& test) { return std::string{test.param}; });

TEST(Phantom, an_unknown_name_is_refused_with_the_known_ones) {
  EXPECT_THAT(make_phantom("teapot", 1), FailsSaying("teapot", "nail_fold"));
}

TEST(AnteriorEye, pupil_shows_the_lens_and_no_iris) {
  const AnteriorEye eye(1);
  Column column;
  const auto pigmented = [&] {
    return std::ranges::any_of(column.layers(),
                               [](const Layer& layer) { return layer.attenuation_per_mm > 10; });
  };
  eye.fill(column, 0.5, AnteriorEye::axis_x_mm - 1, 0);
  EXPECT_FALSE(pigmented());
  EXPECT_TRUE(std::ranges::any_of(column.surfaces(), [](const Surface& surface) {
    return std::abs(surface.depth_mm - AnteriorEye::lens_front_mm(1)) < 1e-4F;
  }));
  eye.fill(column, 0.5, AnteriorEye::axis_x_mm - 3, 0);
  EXPECT_TRUE(pigmented());
}

TEST(AnteriorEye, the_instrument_reflects_and_casts_a_full_shadow) {
  const AnteriorEye eye(1);
  const auto pose = eye.instrument()->pose(0.1);
  const float x = 3;
  float y = -2;
  while (y < 4 && !pose.top_at(x, y))
    y += 0.02F;
  y += 0.15F;
  const auto top = pose.top_at(x, y);
  ASSERT_TRUE(top);

  const pipeline::VolumeGeometry geometry = eye.suggested_plan().geometry();
  const ProfileMaker maker(geometry, 1);
  auto profile = maker.make_profile();
  Column column;
  eye.fill(column, 0.1, x, y);
  maker.fill(profile, column, x, y, {});
  const auto metal = static_cast<std::size_t>(top->depth_mm * 1e3F /
                                              static_cast<float>(geometry.depth_spacing_um));
  float brightest = 0;
  for (std::size_t d = 0; d < profile.scatterers.size(); ++d) {
    const float amplitude = std::abs(profile.scatterers[d]);
    if (d <= metal + 6)
      brightest = std::max(brightest, amplitude);
    else
      ASSERT_EQ(amplitude, 0) << "in the shadow, at bin " << d;
  }
  EXPECT_GT(brightest, 0);
  for (const Reflector& surface : profile.surfaces)
    EXPECT_TRUE(surface.depth_bin <= static_cast<double>(metal) + 6 ||
                surface.amplitude_counts == 0);
}

TEST(Instrument, follows_a_closed_path) {
  const AnteriorEye eye(1);
  const auto start = eye.instrument()->pose(0).bounds_mm();
  const auto half = eye.instrument()->pose(0.5).bounds_mm();
  EXPECT_EQ(start, eye.instrument()->pose(1).bounds_mm());
  EXPECT_GT(start[0] - half[0], 0.5F) << "the tip goes there and back";
}

} // namespace
} // namespace octascope::sim

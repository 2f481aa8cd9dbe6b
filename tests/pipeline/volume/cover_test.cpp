// Tissue that covers other tissue, made up of noise and slabs.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/volume/cover.h"
#include "pipeline/volume/volume.h"

namespace octascope::tests {
namespace {

using pipeline::Volume;

constexpr pipeline::VolumeGeometry geometry{200, 64, 24, 9, 32, 115};
constexpr std::uint8_t tissue = 95; // 20 dB above the noise

struct Slab {
  int first;
  int end;
};

Volume noise_with(std::initializer_list<Slab> slabs) {
  Volume volume{geometry};
  std::mt19937 random{5};
  for (std::size_t i = 0; i < volume.levels.size(); ++i) {
    const int z = static_cast<int>(i % 200);
    const bool in_slab =
        std::ranges::any_of(slabs, [&](const Slab& s) { return z >= s.first && z < s.end; });
    volume.levels[i] = static_cast<std::uint8_t>((in_slab ? tissue : 45) + random() % 11);
  }
  return volume;
}

// With the cover lowered by 20 counts; empty where nothing covers.
Volume weakened(const Volume& volume) {
  pipeline::Occupancy occupancy{volume.geometry, pipeline::blank_depth_bins};
  occupancy.update(volume);
  pipeline::Cover cover;
  cover.find(occupancy);
  Volume to{volume.geometry};
  if (cover.empty())
    return Volume{};
  for (int b = 0; b < volume.geometry.b_scans; ++b)
    cover.weaken(b, volume.b_scan(b), 20, to.b_scan(b));
  return to;
}

TEST(Cover, is_a_layer_with_a_gap_and_tissue_under_it) {
  Volume volume = noise_with({{30, 80}, {130, 170}});
  volume.b_scan(12)[32 * 200 + 50] = 160; // an instrument in the layer
  volume.b_scan(12)[33 * 200 + 50] = 3;   // and a hole
  const Volume to = weakened(volume);
  ASSERT_EQ(to.levels.size(), volume.levels.size());
  for (std::size_t i = 0; i < to.levels.size(); ++i) {
    const auto z = static_cast<int>(i % 200);
    if (z >= 130) {
      ASSERT_EQ(to.levels[i], volume.levels[i]) << "what is covered stays, at " << z;
    } else if (z >= 30 && z < 80 && volume.levels[i] >= tissue && volume.levels[i] < 160) {
      ASSERT_EQ(to.levels[i], volume.levels[i] - 20) << z;
    }
  }
  EXPECT_EQ(to.b_scan(12)[32 * 200 + 50], 160) << "instruments stay";
  EXPECT_EQ(to.b_scan(12)[33 * 200 + 50], 1) << "what was measured stays above nothing";
}

// An iso-surface asks place by place.
TEST(Cover, says_by_which_share_a_place_is_lowered) {
  Volume volume = noise_with({{30, 80}, {130, 170}});
  for (int b = 0; b < 24; ++b) // tissue that covers nothing, since it has no end
    for (int a = 0; a < 16; ++a)
      std::fill_n(volume.b_scan(b).begin() + a * 200 + 80, 120, tissue);
  pipeline::Occupancy occupancy{geometry, pipeline::blank_depth_bins};
  occupancy.update(volume);
  pipeline::Cover cover;
  EXPECT_EQ(cover.share_at({0.5F, 1, 1}), 0);
  cover.find(occupancy);
  constexpr int counts = 20;
  std::vector<std::uint8_t> to(geometry.b_scan_voxels());
  int partly = 0;
  for (const int b : {0, 11, 23}) {
    cover.weaken(b, volume.b_scan(b), counts, to);
    for (int a = 0; a < geometry.a_scans; ++a)
      for (const int z : {35, 55, 79, 90, 130, 160}) {
        const auto voxel = static_cast<std::size_t>(a * geometry.depths + z);
        const int level = volume.b_scan(b)[voxel];
        const float share = cover.share_at({(static_cast<float>(z) + 0.5F) * 0.009F,
                                            (static_cast<float>(a) + 0.5F) * 0.032F,
                                            (static_cast<float>(b) + 0.5F) * 0.115F});
        partly += share > 0.1F && share < 0.9F ? 1 : 0;
        ASSERT_NEAR(level - to[voxel], counts * share, 0.51) << b << ", " << a << ", " << z;
      }
  }
  EXPECT_GT(partly, 10);
  cover.clear();
  EXPECT_TRUE(cover.empty());
  EXPECT_EQ(cover.share_at({0.5F, 1, 1}), 0);
}

TEST(Cover, is_not_what_covers_nothing) {
  EXPECT_TRUE(weakened(noise_with({})).levels.empty());
  EXPECT_TRUE(weakened(noise_with({{30, 80}})).levels.empty()) << "a sheet alone in air";
  EXPECT_TRUE(weakened(noise_with({{30, 200}})).levels.empty()) << "thick tissue";
  EXPECT_TRUE(weakened(noise_with({{30, 80}, {90, 170}})).levels.empty()) << "a fold's small gap";
}

// A pupil is no window: under it there is no iris, but it is the same cornea.
TEST(Cover, reaches_over_where_nothing_lies_under_it) {
  Volume volume = noise_with({{30, 80}, {130, 170}});
  for (int b = 6; b < 18; ++b)
    for (int a = 16; a < 48; ++a)
      std::fill_n(volume.b_scan(b).begin() + a * 200 + 130, 70, std::uint8_t{45});
  const Volume to = weakened(volume);
  ASSERT_FALSE(to.levels.empty());
  EXPECT_EQ(to.b_scan(12)[32 * 200 + 60], volume.b_scan(12)[32 * 200 + 60] - 20);
}

TEST(Cover, is_found_under_a_line_that_is_none) {
  Volume volume = noise_with({{30, 80}, {130, 170}});
  for (int b = 0; b < 24; ++b)
    for (int a = 0; a < 40; ++a)
      std::fill_n(volume.b_scan(b).begin() + a * 200 + 1, 3, tissue);
  const Volume to = weakened(noise_with({{30, 80}, {130, 170}}));
  const Volume lined = weakened(volume);
  ASSERT_FALSE(lined.levels.empty());
  EXPECT_EQ(lined.b_scan(12)[20 * 200 + 60], to.b_scan(12)[20 * 200 + 60]);
}

// An instrument so near under it that no gap is left, from the border of the scan inwards.
TEST(Cover, goes_on_over_an_instrument_that_touches_it) {
  Volume volume = noise_with({{30, 80}, {130, 170}});
  for (int b = 10; b < 14; ++b)
    for (int a = 0; a < 40; ++a)
      std::fill_n(volume.b_scan(b).begin() + a * 200 + 80, 120, std::uint8_t{160});
  const Volume to = weakened(volume);
  ASSERT_FALSE(to.levels.empty());
  for (const int a : {0, 20, 39})
    for (const int z : {35, 60, 75}) {
      const auto voxel = static_cast<std::size_t>(a * 200 + z);
      EXPECT_EQ(to.b_scan(12)[voxel], volume.b_scan(12)[voxel] - 20) << a << ", " << z;
      EXPECT_EQ(to.b_scan(12)[static_cast<std::size_t>(a * 200 + 90)], 160) << "it stays";
    }
}

TEST(Cover, takes_volumes_of_any_shape) {
  for (const pipeline::VolumeGeometry& g :
       {pipeline::VolumeGeometry{1, 1, 1}, {4100, 9, 2}, {33, 17, 5}}) {
    Volume volume{g};
    EXPECT_TRUE(weakened(volume).levels.empty());
  }
}

} // namespace
} // namespace octascope::tests

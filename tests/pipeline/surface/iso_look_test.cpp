// What the corners of a surface tell of their volume.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/surface/iso_surface_thread.h"

namespace octascope::pipeline {
namespace {

constexpr VolumeGeometry shape{320, 96, 24, 5, 10, 40}; // eight voxels to a sample
constexpr float surface_level = 100;

// From 0.8 mm on.
Volume half_tissue(std::uint8_t tissue = 150) {
  Volume volume{shape};
  std::ranges::fill(volume.b_scan_states, BScanState::good);
  for (std::size_t i = 0; i < volume.levels.size(); ++i)
    volume.levels[i] = i % 320 < 160 ? 50 : tissue;
  return volume;
}

IsoMesh surface_of(const Volume& volume, const Cover& cover = {}) {
  IsoSurfaceThread thread{0};
  thread.show(volume, cover);
  thread.request(surface_level);
  thread.wait();
  return *thread.take_newest();
}

// A sheet of metal, so thin that smoothing would make tissue of it.
TEST(IsoLook, is_as_bright_as_what_is_near_along_the_depth) {
  for (const int depth : {100, 160, 192, 240}) {
    Volume volume = half_tissue();
    for (int b = 8; b < 16; ++b)
      for (int a = 32; a < 64; ++a)
        std::fill_n(volume.b_scan(b).begin() + a * 320 + depth, 4, std::uint8_t{230});
    const bool near = depth < 200;
    int bright = 0;
    for (const IsoVertex& vertex : surface_of(volume).vertices) {
      const float off = std::max(std::abs(vertex.position_mm[1] - 0.48F),
                                 std::abs(vertex.position_mm[2] - 0.48F));
      if (vertex.position_mm[0] < 0.7F) // the sheet's own
        continue;
      if (off < 0.1F) {
        ++bright;
        ASSERT_EQ(vertex.brightest, near ? 230 : 150) << depth;
      } else if (off > 0.25F) {
        ASSERT_EQ(vertex.brightest, 150) << depth;
      }
    }
    EXPECT_GT(bright, 20);
  }
}

// The brightest of raw speckle would be metal anywhere.
TEST(IsoLook, is_calm_where_nothing_was_averaged) {
  Volume volume{{80, 48, 40, 20, 20, 20}};
  std::ranges::fill(volume.b_scan_states, BScanState::good);
  for (std::size_t i = 0; i < volume.levels.size(); ++i)
    volume.levels[i] = i % 80 < 40 ? 50 : i % 7 == 0 ? 192 : 143;
  for (const IsoVertex& vertex : surface_of(volume).vertices)
    ASSERT_NEAR(vertex.brightest, 150, 10);
}

TEST(IsoLook, is_a_cover_s_where_that_is) {
  Volume volume = half_tissue();
  for (std::size_t i = 0; i < volume.levels.size(); ++i)
    volume.levels[i] = i % 320 >= 32 && i % 320 < 80 ? 150 : volume.levels[i];
  Occupancy occupancy{shape, 0};
  occupancy.update(volume);
  Cover cover;
  cover.find(occupancy);
  ASSERT_FALSE(cover.empty());
  int covers = 0;
  for (const IsoVertex& vertex : surface_of(volume, cover).vertices) {
    covers += vertex.position_mm[0] < 0.6F ? 1 : 0;
    ASSERT_EQ(vertex.cover, vertex.position_mm[0] < 0.6F ? 255 : 0);
  }
  EXPECT_GT(covers, 1000);
  for (const IsoVertex& vertex : surface_of(volume).vertices)
    ASSERT_EQ(vertex.cover, 0) << "nothing is seen through";
}

// What was shown later has no say.
TEST(IsoLook, is_that_of_the_volume_that_the_surface_was_taken_from) {
  const Volume dim = half_tissue();
  const Volume bright = half_tissue(220);
  IsoSurfaceThread thread{0};
  int dim_ones = 0;
  int bright_ones = 0;
  for (int i = 0; i < 100; ++i) {
    thread.show(i % 2 == 0 ? dim : bright);
    thread.request(surface_level);
    if (i > 90) // some at least are finished
      thread.wait();
    const IsoMesh* mesh = thread.take_newest();
    if (mesh == nullptr)
      continue;
    // Of the higher step the surface lies a little higher.
    const bool higher = mesh->vertices.front().position_mm[0] < 0.795F;
    ++(higher ? bright_ones : dim_ones);
    for (const IsoVertex& vertex : mesh->vertices)
      ASSERT_EQ(vertex.brightest, higher ? 220 : 150);
  }
  EXPECT_GT(dim_ones, 2);
  EXPECT_GT(bright_ones, 2);
}

} // namespace
} // namespace octascope::pipeline

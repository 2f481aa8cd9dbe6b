// The thread that takes surfaces: with real threads, so that a thread sanitizer has what to look
// at.
#include <algorithm>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "pipeline/surface/iso_surface_thread.h"

namespace octascope::pipeline {
namespace {

constexpr VolumeGeometry geometry{40, 32, 24, 20, 20, 20};

// Levels rise from 0 by `slope` a depth bin: the surface of level L lies at bin L / slope.
Volume slope_volume(int slope) {
  Volume volume{geometry};
  std::ranges::fill(volume.b_scan_states, BScanState::good);
  for (std::size_t i = 0; i < volume.levels.size(); ++i)
    volume.levels[i] = static_cast<std::uint8_t>(std::min(static_cast<int>(i % 40) * slope, 255));
  return volume;
}

float depth_in_bins(const IsoMesh& mesh) {
  EXPECT_FALSE(mesh.vertices.empty());
  return mesh.vertices.empty() ? -1 : mesh.vertices.front().position_mm[0] / 0.020F - 0.5F;
}

TEST(IsoSurfaceThread, makes_nothing_unasked) {
  IsoSurfaceThread thread{0};
  thread.request(100);
  thread.wait();
  EXPECT_EQ(thread.take_newest(), nullptr) << "there is no volume";
  thread.show(slope_volume(5));
  thread.wait();
  EXPECT_FALSE(thread.has_newer()) << "nobody asked";
}

TEST(IsoSurfaceThread, fulfils_the_newest_request) {
  IsoSurfaceThread thread{0};
  thread.show(slope_volume(5));
  thread.request(100);
  thread.wait();
  const IsoMesh* mesh = thread.take_newest();
  ASSERT_NE(mesh, nullptr);
  EXPECT_NEAR(depth_in_bins(*mesh), 20, 0.02);
  EXPECT_EQ(thread.take_newest(), nullptr) << "taken already";

  thread.request(50); // another level of the same volume
  thread.wait();
  mesh = thread.take_newest();
  ASSERT_NE(mesh, nullptr);
  EXPECT_NEAR(depth_in_bins(*mesh), 10, 0.02);

  thread.request(50);
  thread.wait();
  EXPECT_FALSE(thread.has_newer()) << "asked for already";
  thread.show(slope_volume(4));
  thread.request(100);
  thread.wait();
  mesh = thread.take_newest();
  ASSERT_NE(mesh, nullptr);
  EXPECT_NEAR(depth_in_bins(*mesh), 25, 0.02);
  EXPECT_EQ(mesh->extents_mm, (std::array{0.8F, 0.64F, 0.48F}));
}

// Requests come faster than meshes; what comes out last is what was asked for last, all of it, and
// what a taken mesh holds does not change under the reader's hands.
TEST(IsoSurfaceThread, keeps_up_with_a_surgeon_who_turns_the_knob) {
  IsoSurfaceThread thread{0};
  const Volume even = slope_volume(5);
  const Volume odd = slope_volume(6);
  int taken = 0;
  // On a busy machine all turns of the knob may be over before the thread runs at all.
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds{20};
  for (int i = 0; i < 400 || (taken == 0 && std::chrono::steady_clock::now() < patience); ++i) {
    if (i >= 400)
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
    if (i % 3 == 0)
      thread.show(i % 2 == 0 ? even : odd);
    thread.request(static_cast<float>(60 + i % 60));
    if (const IsoMesh* mesh = thread.take_newest()) {
      ++taken;
      const auto [least, most] = std::ranges::minmax_element(mesh->corners);
      ASSERT_NE(least, mesh->corners.end());
      ASSERT_LT(*most, mesh->vertices.size());
      for (const IsoVertex& vertex : mesh->vertices) // one plane, of one request
        ASSERT_NEAR(vertex.position_mm[0], mesh->vertices.front().position_mm[0], 1e-4);
    }
  }
  thread.show(even);
  thread.request(75);
  thread.wait();
  const IsoMesh* last = thread.take_newest();
  ASSERT_NE(last, nullptr);
  EXPECT_NEAR(depth_in_bins(*last), 15, 0.02);
  EXPECT_GT(taken, 0) << "meshes keep coming, of " << thread.abandoned() << " given up";
}

TEST(IsoSurfaceThread, ends_while_it_is_busy) {
  for (int i = 0; i < 20; ++i) {
    IsoSurfaceThread thread{0};
    thread.show(slope_volume(5));
    thread.request(100);
  }
}

} // namespace
} // namespace octascope::pipeline

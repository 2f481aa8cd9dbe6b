#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "ui/layout/box_edges.h"
#include "ui/view/plane_box.h"

namespace octascope::ui {
namespace {

constexpr glm::vec3 half{1.5F, 0.9F, 1.2F};

float polygon_area(const PlanePolygon& polygon) {
  glm::vec3 sum{0};
  for (std::size_t i = 2; i < static_cast<std::size_t>(polygon.count); ++i)
    sum += glm::cross(polygon.corners[i - 1] - polygon.corners[0],
                      polygon.corners[i] - polygon.corners[0]);
  return glm::length(sum) / 2;
}

TEST(PlaneBox, axis_aligned_cuts_are_the_faces_rectangles) {
  EXPECT_NEAR(polygon_area(intersect_plane_box(half, {1, 0, 0}, 0.3F)), 1.8 * 2.4, 1e-5);
  EXPECT_NEAR(polygon_area(intersect_plane_box(half, {0, -1, 0}, 0.5F)), 3.0 * 2.4, 1e-5);
  EXPECT_NEAR(polygon_area(intersect_plane_box(half, {0, 0, 1}, -1.1F)), 3.0 * 1.8, 1e-5);
}

TEST(PlaneBox, the_diagonal_cut_of_a_cube_is_a_regular_hexagon) {
  const PlanePolygon hexagon =
      intersect_plane_box(glm::vec3{1}, glm::normalize(glm::vec3{1, 1, 1}), 0);
  EXPECT_EQ(hexagon.count, 6);
  // Corners in the middles of edges: side √2, area 3√3/2 · 2.
  EXPECT_NEAR(polygon_area(hexagon), 3 * std::sqrt(3.0), 1e-5);
}

TEST(PlaneBox, near_a_corner_it_is_a_triangle) {
  const glm::vec3 n = glm::normalize(glm::vec3{1, 1, 1});
  const float below = 0.1F; // under the corner (1, 1, 1)
  const PlanePolygon triangle = intersect_plane_box(glm::vec3{1}, n, std::sqrt(3.0F) - below);
  EXPECT_EQ(triangle.count, 3);
  EXPECT_NEAR(polygon_area(triangle), 1.5F * std::sqrt(3.0F) * below * below, 1e-5);
}

TEST(PlaneBox, outside_there_is_nothing) {
  EXPECT_EQ(intersect_plane_box(half, {0, 1, 0}, 0.91F).count, 0);
  EXPECT_EQ(intersect_plane_box(half, {0, 1, 0}, -0.91F).count, 0);
}

TEST(PlaneBox, polygons_of_any_direction_are_convex_and_add_up_to_the_volume) {
  std::mt19937 random{7};
  std::uniform_real_distribution<float> component{-1, 1};
  for (int trial = 0; trial < 200; ++trial) {
    const glm::vec3 n =
        glm::normalize(glm::vec3{component(random), component(random), component(random)});
    const float reach = glm::dot(glm::abs(n), half);
    constexpr int planes = 400;
    const float spacing = 2 * reach / planes;
    double volume = 0;
    for (int i = 0; i < planes; ++i) {
      const PlanePolygon polygon =
          intersect_plane_box(half, n, -reach + (static_cast<float>(i) + 0.5F) * spacing);
      ASSERT_GE(polygon.count, 3);
      ASSERT_LE(polygon.count, 6);
      const auto count = static_cast<std::size_t>(polygon.count);
      for (std::size_t k = 0; k < count; ++k) {
        const glm::vec3 a = polygon.corners[k];
        const glm::vec3 b = polygon.corners[(k + 1) % count];
        const glm::vec3 c = polygon.corners[(k + 2) % count];
        ASSERT_GE(glm::dot(glm::cross(b - a, c - b), n), -1e-4F) << "corners in their order";
      }
      volume += static_cast<double>(polygon_area(polygon) * spacing);
    }
    EXPECT_NEAR(volume, 3.0 * 1.8 * 2.4, 0.01);
  }
}

TEST(PlaneStackSpacing, half_a_spacing_from_both_borders) {
  ViewState view;
  view.yaw_deg = 0;
  view.tilt_deg = 0;
  const Camera camera = make_camera(view, 2.0F * half, 1.5F);
  const StackSpacing spacing = space_planes(camera, half, 10);
  EXPECT_NEAR(spacing.spacing_mm, 0.24, 1e-5);
  EXPECT_NEAR(camera.eye.z - spacing.first_mm, 1.2 - 0.12, 1e-5);
  EXPECT_NEAR(camera.eye.z - (spacing.first_mm + 9 * spacing.spacing_mm), -1.2 + 0.12, 1e-5);
}

TEST(PlaneStackSpacing, no_farther_apart_than_the_step) {
  ViewState view;
  view.yaw_deg = 0;
  view.tilt_deg = 0;
  const Camera camera = make_camera(view, 2.0F * half, 1.5F);
  EXPECT_EQ(count_planes(camera, half, 0.24F, 1000), 10);
  EXPECT_EQ(count_planes(camera, half, 0.2399F, 1000), 11);
  EXPECT_EQ(count_planes(camera, half, 0.001F, 1000), 1000);
  EXPECT_EQ(count_planes(camera, half, 5, 1000), 2);
  for (const float step_mm : {0.5F, 0.07F, 0.011F})
    EXPECT_LE(space_planes(camera, half, count_planes(camera, half, step_mm, 1000)).spacing_mm,
              step_mm);
}

TEST(PlaneStackSpacing, begins_at_the_near_plane_when_the_eye_is_inside) {
  ViewState view;
  view.distance = 0.6F;
  const Camera camera = make_camera(view, 2.0F * half, 1.5F);
  const StackSpacing spacing = space_planes(camera, half, 64);
  EXPECT_GT(spacing.first_mm, camera.near_mm);
  EXPECT_LT(spacing.first_mm, camera.near_mm + spacing.spacing_mm);
}

TEST(BoxEdges, seen_obliquely_nine_are_in_front_and_three_behind) {
  ViewState view;
  view.yaw_deg = 30;
  view.tilt_deg = 25;
  const auto edges = project_box(make_camera(view, 2.0F * half, 1), 2.0F * half, {0, 0, 100, 100});
  int in_front = 0;
  for (const BoxEdge& edge : edges) {
    EXPECT_TRUE(edge.visible);
    in_front += edge.in_front ? 1 : 0;
  }
  EXPECT_EQ(in_front, 9);
}

TEST(BoxEdges, land_where_the_matrices_put_them) {
  ViewState view;
  view.yaw_deg = -50;
  view.tilt_deg = 40;
  const Rect rect{10, 20, 300, 200};
  const Camera camera = make_camera(view, 2.0F * half, 1.5F);
  for (const BoxEdge& edge : project_box(camera, 2.0F * half, rect)) {
    bool found = false;
    for (unsigned i = 0; i < 8; ++i) {
      const glm::vec4 clip =
          camera.view_projection * glm::vec4{(i & 1U) != 0 ? half.x : -half.x,
                                             (i & 2U) != 0 ? half.y : -half.y,
                                             (i & 4U) != 0 ? half.z : -half.z, 1};
      const float x = 10 + 150 * (1 + clip.x / clip.w);
      const float y = 20 + 100 * (1 - clip.y / clip.w);
      found = found || (std::abs(x - edge.from.x) < 0.01F && std::abs(y - edge.from.y) < 0.01F);
    }
    EXPECT_TRUE(found);
  }
}

} // namespace
} // namespace octascope::ui

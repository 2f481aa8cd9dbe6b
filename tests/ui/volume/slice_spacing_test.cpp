// Which slices of the volume are drawn, in which order.
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "ui/volume/slice_spacing.h"

namespace octascope::tests {
namespace {

constexpr pipeline::VolumeGeometry geometry{12, 20, 7, 50, 40, 90}; // 0.6 × 0.8 × 0.63 mm

ui::Camera camera_at(float yaw_deg, float tilt_deg) {
  ui::ViewState view;
  view.yaw_deg = yaw_deg;
  view.tilt_deg = tilt_deg;
  return ui::make_camera(view, ui::box_extents_mm(geometry), 1);
}

TEST(SliceSpacing, takes_the_axis_that_is_nearest_to_the_view) {
  const auto axis_at = [](float yaw_deg, float tilt_deg) {
    return ui::space_slices(camera_at(yaw_deg, tilt_deg), geometry, 0.001F, 2048).axis;
  };
  EXPECT_EQ(axis_at(0, 0), 2);
  EXPECT_EQ(axis_at(44, 0), 2);
  EXPECT_EQ(axis_at(46, 0), 0);
  EXPECT_EQ(axis_at(180, 0), 2);
  EXPECT_EQ(axis_at(-90, 20), 0);
  EXPECT_EQ(axis_at(0, 46), 1);
  EXPECT_EQ(axis_at(45, -60), 1);
}

TEST(SliceSpacing, goes_through_the_middle_of_every_voxel_from_the_eye_on) {
  const float voxel_mm[] = {0.04F, 0.05F, 0.09F};
  for (const auto& [yaw_deg, tilt_deg] : {std::pair{0.0F, 0.0F},
                                          {180.0F, 0.0F},
                                          {90.0F, 0.0F},
                                          {-90.0F, 0.0F},
                                          {0.0F, 80.0F},
                                          {0.0F, -80.0F}}) {
    const ui::Camera camera = camera_at(yaw_deg, tilt_deg);
    const ui::SliceSpacing spacing = ui::space_slices(camera, geometry, 0.001F, 2048);
    const float voxel = voxel_mm[spacing.axis];
    ASSERT_EQ(spacing.drawn, spacing.slices);
    EXPECT_FLOAT_EQ(spacing.spacing_mm, voxel);
    EXPECT_LT(spacing.direction * camera.eye[spacing.axis], 0) << "away from the eye";
    for (int i = 0; i < spacing.drawn; ++i)
      EXPECT_NEAR(spacing.offset_mm(i) * spacing.direction,
                  (static_cast<float>(i) + 0.5F) * voxel - spacing.half_mm, 1e-6F);
  }
}

TEST(SliceSpacing, leaves_slices_out_where_the_step_is_longer) {
  for (const auto& [step_mm, most, drawn] : {std::tuple{0.04F, 2048, 20},
                                             {0.08F, 2048, 10},
                                             {0.1F, 2048, 8},
                                             {0.001F, 6, 6},
                                             {9.0F, 9, 1}}) {
    const ui::SliceSpacing spacing = ui::space_slices(camera_at(90, 0), geometry, step_mm, most);
    ASSERT_EQ(spacing.drawn, drawn) << step_mm;
    EXPECT_FLOAT_EQ(spacing.spacing_mm * static_cast<float>(drawn), 0.8F);
    for (int i = 0; i < drawn; ++i) {
      const float offset = spacing.offset_mm(i);
      const float voxel = (offset + 0.4F) / 0.04F - 0.5F;
      EXPECT_NEAR(voxel, std::round(voxel), 1e-4F) << "one of the volume's own";
      const float even = ((static_cast<float>(i) + 0.5F) / static_cast<float>(drawn) - 0.5F) * 0.8F;
      EXPECT_LE(std::abs(offset * spacing.direction - even), 0.0201F) << i << " of " << drawn;
    }
  }
}

} // namespace
} // namespace octascope::tests

// Where a place of the volume is in a panel, and in the microscope's picture.
#include <gtest/gtest.h>

#include "tests/ui/support/synthetic_volume.h"
#include "ui/vessels/sections/picture_place.h"

namespace octascope::tests {
namespace {

using ui::FlatPicture;

TEST(PicturePlace, follows_the_panels_crop) {
  const ui::Crop crop{{0.25F, 0.75F}, {0.5F, 1}, {0, 0.5F}};
  const ui::Rect rect{40, 50, 300, 200};
  const auto expect_at = [&](FlatPicture picture, glm::vec2 at_mm, glm::vec2 pixels) {
    const auto place = ui::place_in_panel(picture, small_geometry, crop, rect);
    EXPECT_NEAR(place.pixels(at_mm).x, pixels.x, 0.01F);
    EXPECT_NEAR(place.pixels(at_mm).y, pixels.y, 0.01F);
  };
  const auto depth_mm = static_cast<float>(small_geometry.depth_mm());
  expect_at(FlatPicture::b_scan, {1.5F, depth_mm / 4}, {0, 0});
  expect_at(FlatPicture::b_scan, {3, depth_mm / 2}, {300, 100});
  expect_at(FlatPicture::crossed, {0.75F, depth_mm / 2}, {150, 100});
  expect_at(FlatPicture::from_above, {2.25F, 1.5F}, {150, 200});
}

TEST(PicturePlace, follows_the_scans_field_in_the_microscopes_picture) {
  const ui::ScanField field{{{{0.2F, 0.1F}, {0.8F, 0.3F}, {0.7F, 0.9F}, {0.1F, 0.7F}}}};
  const auto place = ui::place_in_field(small_geometry, field, {7, 9, 400, 300});
  const auto expect_at = [&](glm::vec2 at_mm, glm::vec2 pixels) {
    EXPECT_NEAR(place.pixels(at_mm).x, pixels.x, 0.01F);
    EXPECT_NEAR(place.pixels(at_mm).y, pixels.y, 0.01F);
  };
  expect_at({0, 0}, {80, 30});
  expect_at({3, 0}, {320, 90});
  expect_at({3, 3}, {280, 270});
  expect_at({0, 3}, {40, 210});
  expect_at({1.5F, 1.5F}, {180, 150});
}

} // namespace
} // namespace octascope::tests

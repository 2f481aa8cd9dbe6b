#include <gtest/gtest.h>

#include "ui/view/view_state.h"

namespace octascope::ui {
namespace {

TEST(ViewState, clamps_every_value_and_wraps_yaw) {
  ViewState v;
  v.yaw_deg = 370;
  v.tilt_deg = 200;
  v.distance = 0;
  v.window_size_db = 0;
  const ViewState c = v.clamped();
  EXPECT_FLOAT_EQ(c.yaw_deg, 10);
  EXPECT_FLOAT_EQ(c.tilt_deg, 89);
  EXPECT_GT(c.distance, 0);
  EXPECT_GE(c.window_size_db, 1);
}

} // namespace
} // namespace octascope::ui

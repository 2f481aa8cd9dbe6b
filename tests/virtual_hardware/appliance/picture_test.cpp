// What the monitor shows, beside the same picture drawn where no monitor is.
#include <algorithm>

#include <gtest/gtest.h>

#include "hal/linux/kms/kms_display.h"
#include "hal/linux/monotonic_clock.h"
#include "sim/devices/offscreen_display.h"
#include "tests/ui/support/scene.h"
#include "tests/ui/support/synthetic_volume.h"
#include "tests/virtual_hardware/support/scanout_reader.h"
#include "ui/renderer.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::KmsConfig;
using hal::linux_backend::KmsDisplay;

// The scene in the middle of its view, on a display that is open; read back from GL.
ScanoutPicture draw_scene(hal::Display& display) {
  auto renderer = ui::Renderer::create();
  EXPECT_TRUE(renderer) << renderer.error().message;
  EXPECT_TRUE((*renderer)->show_volume(tissue_volume(small_geometry)));
  EXPECT_TRUE((*renderer)->draw({}, live_status(), display.width(), display.height()));
  const pipeline::Image image = (*renderer)->read_back(display.width(), display.height());
  EXPECT_TRUE(display.present());
  return {image.width, image.height, image.pixels};
}

TEST(Monitor, shows_what_an_offscreen_display_shows) {
  hal::linux_backend::MonotonicClock clock;
  KmsConfig config;
  config.seat = KmsConfig::SeatUse::plain;
  KmsDisplay monitor{clock, config};
  const auto opened = monitor.open({});
  if (!opened)
    GTEST_SKIP() << opened.error().message;
  const int width = monitor.width(), height = monitor.height();
  draw_scene(monitor);
  const auto shown = read_scanout();
  ASSERT_TRUE(shown) << shown.error().message;
  monitor.close();

  hal::DisplayConfig size;
  size.width = width;
  size.height = height;
  sim::OffscreenDisplay offscreen{clock};
  ASSERT_TRUE(offscreen.open(size));
  const ScanoutPicture drawn = draw_scene(offscreen);
  EXPECT_EQ(shown->width, width);
  EXPECT_LE(largest_difference(*shown, drawn), 1) << "of 255";
  EXPECT_GT(*std::ranges::max_element(drawn.rgb), 150) << "there is a picture";
}

} // namespace
} // namespace octascope::tests

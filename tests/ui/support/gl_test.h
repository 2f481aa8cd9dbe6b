// A GLES 3 context for tests, where this machine has one.
#pragma once

#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include "sim/clock/virtual_clock.h"
#include "sim/devices/offscreen_display.h"
#include "ui/gl/context_info.h"

namespace octascope::tests {

// How far from a number its 8 bits may be: GPUs round to within 0.6 of a step.
inline double most_rounded_off() {
  return ui::gl::describe_context().software ? 0.51 : 0.6;
}

// Skips, saying why, where no offscreen context can be made.
class GlTest : public ::testing::Test {
protected:
  void SetUp() override { open(640, 360); }

  void open(int width, int height) {
    display_.close();
    hal::DisplayConfig config;
    config.width = width;
    config.height = height;
    const auto opened = display_.open(config);
    if (!opened)
      GTEST_SKIP() << opened.error().message;
  }

  sim::VirtualClock clock_;
  sim::OffscreenDisplay display_{clock_};
};

} // namespace octascope::tests

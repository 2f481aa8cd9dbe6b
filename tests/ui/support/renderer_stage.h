// The whole display, drawn offscreen and read back.
#pragma once

#include <memory>
#include <utility>

#include "tests/support/pictures/picture_counts.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/scene.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/renderer.h"

namespace octascope::tests {

class RendererTest : public GlTest {
protected:
  void SetUp() override { open_renderer(640, 360); }
  void TearDown() override { renderer_.reset(); }

  // Once more, with another size, perhaps, and with nothing to show yet.
  void open_renderer(int width, int height, const ui::Typeface& typeface = ui::inter()) {
    renderer_.reset();
    open(width, height);
    if (IsSkipped())
      return;
    auto made = ui::Renderer::create({}, {}, typeface);
    ASSERT_TRUE(made) << made.error().message;
    renderer_ = std::move(*made);
    width_ = width;
    height_ = height;
  }

  void show_scope(int scope_width = 320) {
    const ScopePicture scope{scope_width, 240};
    ASSERT_TRUE(renderer_->show_scope_picture(scope.frame(live_status().now), scope.field()));
  }
  void show_scene(const pipeline::Volume& volume = tissue_volume(small_geometry)) {
    ASSERT_TRUE(renderer_->show_volume(volume));
    renderer_->show_levels(level_shares(volume));
    show_scope();
  }

  pipeline::Image draw(const ui::ViewState& view, const ui::Status& status) {
    const auto drawn = renderer_->draw(view, status, width_, height_);
    EXPECT_TRUE(drawn) << drawn.error().message;
    return renderer_->read_back(width_, height_);
  }
  static int changed(const pipeline::Image& a, const pipeline::Image& b, const ui::Rect& rect) {
    return count_different(a, b, rect, 0);
  }

  std::unique_ptr<ui::Renderer> renderer_;
  int width_ = 0;
  int height_ = 0;
};

} // namespace octascope::tests

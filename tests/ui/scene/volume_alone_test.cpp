// The renderer's picture of the volume alone, beside its picture of the whole display.
#include "tests/ui/support/renderer_stage.h"

namespace octascope::tests {
namespace {

class VolumeAlone : public RendererTest {};

TEST_F(VolumeAlone, needs_a_volume_and_a_size) {
  const auto drawn = renderer_->draw_volume_alone({}, 640, 360);
  ASSERT_FALSE(drawn);
  EXPECT_EQ(drawn.error().code, hal::ErrorCode::invalid_argument);
  ASSERT_TRUE(renderer_->show_volume(tissue_volume(small_geometry)));
  EXPECT_TRUE(renderer_->draw_volume_alone({}, 640, 360));
  EXPECT_FALSE(renderer_->draw_volume_alone({}, 640, 0));
}

TEST_F(VolumeAlone, leaves_the_display_to_be_drawn_anew_and_as_before) {
  const ui::Status status = live_status();
  ASSERT_TRUE(renderer_->show_volume(tissue_volume(small_geometry)));
  ASSERT_TRUE(renderer_->draw({}, status, 640, 360));
  const pipeline::Image before = renderer_->read_back(640, 360);
  EXPECT_FALSE(renderer_->needs_redraw({}, status, 640, 360));
  ASSERT_TRUE(renderer_->draw_volume_alone({}, 640, 360));
  EXPECT_NE(renderer_->read_back(640, 360), before);
  EXPECT_TRUE(renderer_->needs_redraw({}, status, 640, 360));
  ASSERT_TRUE(renderer_->draw({}, status, 640, 360));
  EXPECT_EQ(renderer_->read_back(640, 360), before);
}

// Nobody waits for a mesh on the display; who asks for one picture does.
TEST_F(VolumeAlone, is_complete_once_prepared) {
  const auto volume = tissue_volume(small_geometry);
  ui::ViewState view;
  view.technique = ui::Technique::surface;
  ASSERT_TRUE(renderer_->show_volume(volume));
  ASSERT_TRUE(renderer_->prepare(volume, view));
  ASSERT_TRUE(renderer_->draw_volume_alone(view, 640, 360));
  const pipeline::Image surface = renderer_->read_back(640, 360);
  view.technique = ui::Technique::maximum;
  view.window_offset_db = 87; // nothing is that bright
  ASSERT_TRUE(renderer_->draw_volume_alone(view, 640, 360));
  EXPECT_NE(renderer_->read_back(640, 360), surface);
}

} // namespace
} // namespace octascope::tests

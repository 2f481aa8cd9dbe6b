// B-scans renewed one after the other give the picture that the whole volume does.
#include <string>
#include <vector>

#include "tests/support/allocation_counter.h"
#include "tests/ui/support/drawing_way.h"
#include "tests/ui/support/mixed_volume.h"
#include "tests/ui/support/renderer_stage.h"
#include "tests/ui/support/vessels/vessel_along.h"
#include "ui/canvas/palette.h"
#include "ui/layout/layout.h"

namespace octascope::tests {
namespace {

using pipeline::BScanRange;
using ui::Technique;

class RenewalTest : public RendererTest {
protected:
  void renew(int from, int to) {
    const std::array changed{mixed_.renew(from, to)};
    const auto renewed = renderer_->renew_volume(mixed_.volume(), changed);
    ASSERT_TRUE(renewed) << renewed.error().message;
  }

  pipeline::Image picture(ui::Renderer& renderer, const ui::ViewState& view,
                          const ui::DrawQuality& quality) const {
    if (&renderer == renderer_.get()) { // the other one has all of every volume
      EXPECT_TRUE(renderer.complete(mixed_.volume(), view, quality));
    }
    const auto drawn = renderer.draw(view, live_status(), width_, height_, quality);
    EXPECT_TRUE(drawn) << drawn.error().message;
    return renderer.read_back(width_, height_);
  }

  // By a renderer that knows nothing of what was there before.
  pipeline::Image fresh_picture(const ui::ViewState& view, const ui::DrawQuality& quality) const {
    auto renderer = ui::Renderer::create();
    EXPECT_TRUE(renderer);
    show_vessels(**renderer);
    (*renderer)->expect(view);
    EXPECT_TRUE((*renderer)->show_volume(mixed_.volume()));
    EXPECT_TRUE(
        (*renderer)->prepare(mixed_.volume(), view, quality)); // on a GPU, for the processor's rays
    return picture(**renderer, view, quality);
  }

  void show_vessels(ui::Renderer& renderer) const {
    EXPECT_TRUE(renderer.show_vessels(
        {vessels_.view(), {0.5, 0.5, 0.5}, pipeline::RigidTransform{}}, clock_));
  }

  ui::Rect whole() const { return {0, 0, width_, height_}; }

  MixedVolume mixed_;
  const pipeline::ClusterArrays vessels_ =
      vessel_along({{0.4F, 0.1F, 0.5F}, {0.5F, 0.9F, 0.7F}}, 0.04F);
};

class RenewedPicture : public RenewalTest, public testing::WithParamInterface<DrawingWay> {};

TEST_P(RenewedPicture, is_that_of_the_whole_volume) {
  const auto& [technique, quality, see_through_db, flow, vessel_opacity] = GetParam();
  if (flow)
    mixed_.add_flow();
  ui::ViewState view;
  view.technique = technique;
  view.see_through_db = see_through_db;
  view.zoom_to_tissue = false; // which remembers what was there
  view.b_scan = 11;
  view.vessels = vessel_opacity > 0 ? ui::VesselsShown::both : ui::VesselsShown::flow;
  view.vessel_opacity = vessel_opacity;
  show_vessels(*renderer_);
  for (const float yaw : {20.0F, 200.0F}) {
    view.yaw_deg = yaw;
    mixed_.become(mixed_.older());
    renderer_->expect(view);
    ASSERT_TRUE(renderer_->show_volume(mixed_.volume()));
    ASSERT_TRUE(renderer_->prepare(mixed_.volume(), view, quality));
    picture(*renderer_, view, quality);
    const int end = mixed_.volume().geometry.b_scans;
    for (const auto& [from, to] :
         {BScanRange{0, 3}, {3, 4}, {4, 17}, {17, end - 1}, {end - 1, end}}) {
      renew(from, to);
      const pipeline::Image renewed = picture(*renderer_, view, quality);
      const pipeline::Image fresh = fresh_picture(view, quality);
      EXPECT_EQ(changed(renewed, fresh, whole()), 0) << "to " << to << ", yaw " << yaw;
    }
  }
}

constexpr auto processor = ui::RayBackend::processor;
constexpr auto shader = ui::RayBackend::shader;
INSTANTIATE_TEST_SUITE_P(
    Ways, RenewedPicture,
    testing::Values(DrawingWay{Technique::rays, {1, 512, processor}, 0},
                    DrawingWay{Technique::rays, {0.6F, 192, processor}, 0}, // softened
                    DrawingWay{Technique::rays, {1, 256, shader}, 0},
                    DrawingWay{Technique::rays, {1, 256, processor}, 12},
                    DrawingWay{Technique::rays, {1, 256, shader}, 12},
                    DrawingWay{Technique::planes, {0.5F, 96}, 12},
                    DrawingWay{Technique::maximum, {1, 256, processor}, 0},
                    DrawingWay{Technique::shaded, {1, 256, processor}, 0},
                    DrawingWay{Technique::planes, {0.5F, 96}, 0},
                    DrawingWay{Technique::slices, {0.5F, 96}, 0},
                    DrawingWay{Technique::rays, {1, 256, processor}, 0, true},
                    DrawingWay{Technique::rays, {0.6F, 192, processor}, 12, true},
                    DrawingWay{Technique::maximum, {1, 256, processor}, 0, true},
                    DrawingWay{Technique::shaded, {1, 256, processor}, 0, true},
                    DrawingWay{Technique::rays, {0.5F, 96, shader}, 0, true},
                    DrawingWay{Technique::planes, {0.5F, 96}, 0, true},
                    DrawingWay{Technique::rays, {0.6F, 192, processor}, 0, false, 1},
                    DrawingWay{Technique::rays, {1, 256, processor}, 12, true, 0.4F},
                    DrawingWay{Technique::maximum, {0.6F, 192, processor}, 0, false, 0.4F}));

TEST_F(RenewalTest, the_seam_is_a_line_of_its_own_colour_where_it_is_said_to_be) {
  ui::ViewState view;
  view.zoom_to_tissue = false;
  view.layout = ui::LayoutKind::quad;
  view.b_scan = 2;
  ASSERT_TRUE(renderer_->show_volume(mixed_.volume()));
  const pipeline::VolumeGeometry& g = mixed_.volume().geometry;
  const ui::Layout places = ui::lay_out(width_, height_,
                                        {.b_scan = g.a_mm() / g.depth_mm(),
                                         .en_face = g.a_mm() / g.b_mm(),
                                         .has_scope = false,
                                         .crossed = g.b_mm() / g.depth_mm()},
                                        view.layout);
  const auto seam_pixels = [&](const pipeline::Image& image, const ui::Rect& rect) {
    return count_colour(image, rect, ui::palette::seam);
  };
  EXPECT_EQ(seam_pixels(draw(view, live_status()), whole()), 0);
  for (const int at : {8, 30}) {
    renew(at == 8 ? 0 : 8, at);
    const pipeline::Image image = draw(view, live_status());
    const ui::Rect& face = places.en_face.picture;
    const int row = face.y + face.height * at / g.b_scans;
    const int next = face.y + face.height * (at + 1) / g.b_scans;
    const ui::Rect line{face.x, row, face.width, next - row};
    EXPECT_GT(seam_pixels(image, line), face.width / 2) << at;
    EXPECT_EQ(seam_pixels(image, {face.x, face.y, face.width, row - 1 - face.y}), 0) << at;
    EXPECT_EQ(seam_pixels(image, {face.x, next + 1, face.width, face.bottom() - next - 1}), 0);
    const ui::Rect& crossed = places.crossed.picture;
    const int column = crossed.x + crossed.width * at / g.b_scans;
    EXPECT_GT(
        seam_pixels(image, {column, crossed.y, crossed.width / g.b_scans + 1, crossed.height}),
        crossed.height / 2);
    EXPECT_GT(seam_pixels(image, places.view), 10) << "its outline in the volume";
    EXPECT_EQ(seam_pixels(image, places.b_scan.picture), 0);
  }
}

TEST_F(RenewalTest, a_frame_allocates_nothing) {
  ui::ViewState view;
  view.zoom_to_tissue = false;
  ASSERT_TRUE(renderer_->show_volume(mixed_.volume()));
  for (int b = 0; b < 3; ++b) {
    renew(b, b + 1);
    draw(view, live_status());
  }
  const std::array changed{BScanRange{3, 5}};
  const auto before = allocations_of_this_thread();
  ASSERT_TRUE(renderer_->renew_volume(mixed_.volume(), changed));
  EXPECT_EQ(allocations_of_this_thread(), before);
}

} // namespace
} // namespace octascope::tests

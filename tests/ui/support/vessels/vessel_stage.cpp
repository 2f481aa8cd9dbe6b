#include "tests/ui/support/vessels/vessel_stage.h"

#include <utility>

#include <gtest/gtest.h>

namespace octascope::tests {

namespace {

template <class T> T must(hal::Result<T> made) {
  EXPECT_TRUE(made) << made.error().message;
  return std::move(made.value());
}

} // namespace

VesselStage::VesselStage(const pipeline::VesselTree& tree)
    : arrays_{pipeline::build_clusters(tree)}, view_{arrays_.view()}, bounds_{ui::vessel_bounds(
                                                                          view_)},
      nodes_{std::make_shared<ui::NodeTexture>()}, picture_{must(ui::VesselPicture::create())} {}

ui::VesselView VesselStage::whole() const {
  return ui::make_benchmark_view(ui::BenchmarkView::whole, view_, width, height);
}

ui::VesselScene VesselStage::scene(const ui::VesselView& view, ui::VesselColouring colouring) {
  camera_ = ui::make_vessel_camera(view, bounds_, width, height);
  ui::VesselScene scene{view_, camera_, glm::mat4{1}, {}, width, height};
  scene.look.colouring = colouring;
  scene.look = ui::with_cue(scene.look, view, bounds_, width, height);
  return scene;
}

DrawnVessels VesselStage::draw(ui::VesselMethod& method, const ui::VesselScene& scene) {
  DrawnVessels drawn;
  const auto account = picture_->draw(method, scene);
  EXPECT_TRUE(account) << account.error().message;
  if (account)
    drawn.account = *account;
  drawn.colour = picture_->read_colour();
  drawn.depth = picture_->read_depth();
  return drawn;
}

ui::VesselMethod& VesselStage::method(ui::VesselMethodKind kind, ui::ClusterChoice choice) {
  auto& made = methods_[{kind, choice}];
  if (!made)
    made = must(ui::make_vessel_method(kind, nodes_, {choice, {sectors}, {}}));
  return *made;
}

} // namespace octascope::tests

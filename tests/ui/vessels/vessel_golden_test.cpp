// Golden pictures of a coronary tree, by method.
#include "pipeline/vessels/clusters/cluster_builder.h"
#include "sim/coronary_tree/coronary_tree.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/golden.h"
#include "ui/gl/framebuffer.h"
#include "ui/scene/vessel_still.h"
#include "ui/vessels/pictures/vessel_methods.h"
#include "ui/vessels/view/vessel_view.h"

namespace octascope::tests {
namespace {

constexpr int width = 640;
constexpr int height = 360;

class GoldenVessels : public GlTest {
protected:
  // As octascope vessels generate --segments 20000 --seed 1.
  static void SetUpTestSuite() {
    const auto grown = sim::generate_coronary_tree({20000, 1, 1});
    ASSERT_TRUE(grown) << grown.error().message;
    arrays_ = pipeline::build_clusters(grown->tree);
  }
  static void TearDownTestSuite() { arrays_ = {}; }

  void SetUp() override { open(width, height); }

  static pipeline::Image draw(ui::VesselMethodKind kind, ui::VesselColouring colouring,
                              float closer) {
    const pipeline::VesselClusters tree = arrays_.view();
    ui::VesselView view = ui::make_benchmark_view(ui::BenchmarkView::whole, tree, width, height);
    view.mm_per_pixel /= closer;
    const ui::VesselBounds bounds = ui::vessel_bounds(tree);
    const ui::Camera camera = ui::make_vessel_camera(view, bounds, width, height);
    ui::VesselScene scene{tree, camera, glm::mat4{1}, {}, width, height};
    scene.look.colouring = colouring;
    scene.look = ui::with_cue(scene.look, view, bounds, width, height);
    auto method = ui::make_vessel_method(kind, std::make_shared<ui::NodeTexture>());
    EXPECT_TRUE(method) << method.error().message;
    auto still = ui::VesselStill::create();
    EXPECT_TRUE(still) << still.error().message;
    const auto account = still->draw(**method, scene, view.mm_per_pixel);
    EXPECT_TRUE(account) << account.error().message;
    return ui::gl::read_framebuffer(width, height);
  }

  static inline pipeline::ClusterArrays arrays_;
};

TEST_F(GoldenVessels, tubes) {
  expect_golden(draw(ui::VesselMethodKind::tubes_gpu, ui::VesselColouring::order, 5),
                "vessels_tubes_640x360");
}

TEST_F(GoldenVessels, quads) {
  expect_golden(draw(ui::VesselMethodKind::quads_gpu, ui::VesselColouring::order, 5),
                "vessels_quads_640x360");
}

TEST_F(GoldenVessels, hybrid) {
  expect_golden(draw(ui::VesselMethodKind::hybrid, ui::VesselColouring::branch, 1),
                "vessels_hybrid_640x360");
}

} // namespace
} // namespace octascope::tests

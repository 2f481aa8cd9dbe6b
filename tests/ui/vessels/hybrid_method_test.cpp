// Vessels drawn by the processor, in GL's picture and depth.
#include <bit>
#include <limits>
#include <vector>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "tests/support/fails_with.h"
#include "tests/support/vessels/random_tree.h"
#include "tests/ui/support/gl_test.h"
#include "ui/gl/picture_pass.h"
#include "ui/gl/picture_texture.h"
#include "ui/vessels/hybrid/hybrid_method.h"
#include "ui/view/segment_counts.h"

namespace octascope::tests {
namespace {

constexpr int width = 320;
constexpr int height = 180;

class HybridMethod : public GlTest {
protected:
  void SetUp() override {
    open(width, height);
    if (IsSkipped())
      return;
    view_.distance = 2;
    camera_ = ui::make_camera(view_, {20, 20, 20}, static_cast<float>(width) / height);
    colour_ = ui::gl::make_picture_texture(GL_RGBA8, width, height);
    depth_ = ui::gl::make_picture_texture(GL_DEPTH_COMPONENT24, width, height);
    target_ = ui::gl::Framebuffer::make();
    glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.name(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
    glViewport(0, 0, width, height);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  }
  ui::VesselScene scene() const {
    ui::VesselScene scene{.tree = tree_, .camera = camera_, .look = {}};
    scene.width = width;
    scene.height = height;
    scene.look.cue_near_mm = camera_.near_mm;
    scene.look.cue_far_mm = camera_.far_mm;
    return scene;
  }
  // Rows from the top.
  static std::vector<std::uint32_t> picture() {
    std::vector<std::uint32_t> pixels(width * height);
    for (int y = 0; y < height; ++y)
      glReadPixels(0, height - 1 - y, width, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                   pixels.data() + y * width);
    return pixels;
  }

  ui::gl::Texture colour_;
  ui::gl::Texture depth_;
  ui::gl::Framebuffer target_;
  ui::ViewState view_;
  ui::Camera camera_;
  pipeline::ClusterArrays arrays_ = pipeline::build_clusters(tests::random_tree(4000, 21));
  pipeline::VesselClusters tree_ = arrays_.view();
};

TEST_F(HybridMethod, shows_the_splats_with_the_cameras_depth) {
  auto method = ui::HybridMethod::create(1, {}, {});
  ASSERT_TRUE(method) << method.error().message;
  const auto account = method->draw(scene());
  ASSERT_TRUE(account) << account.error().message;
  EXPECT_EQ(account->total(), tree_.segments);
  const ui::DepthImage& splats = method->splats();
  const auto drawn = picture();
  for (std::size_t i = 0; i < drawn.size(); ++i)
    ASSERT_EQ(drawn[i] & 0xFFFFFF, splats.pixels[i] & 0xFFFFFF) << i;

  // A wall across the view: what is behind it is hidden, what is before it stays.
  const float wall_mm = camera_.depth_of({0, 0, 0});
  const glm::vec4 clip =
      camera_.view_projection * glm::vec4{camera_.eye + wall_mm * camera_.forward, 1};
  auto wall = ui::gl::PicturePass::create("wall", R"(precision highp float;
uniform float u_depth;
out vec4 o_colour;
void main() { o_colour = vec4(0.0, 0.0, 1.0, 1.0); gl_FragDepth = u_depth; }
)");
  ASSERT_TRUE(wall) << wall.error().message;
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  wall->use();
  glUniform1f(wall->uniform("u_depth"), 0.5F + 0.5F * clip.z / clip.w);
  wall->fill({0, 0, width, height}, height);
  glDisable(GL_DEPTH_TEST);
  const auto walled = picture();
  std::size_t before = 0;
  std::size_t behind = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float distance = splats.distance_mm(x, y);
      if (std::abs(distance - wall_mm) < 0.01F)
        continue;
      const bool is_wall = (walled[static_cast<std::size_t>(y * width + x)] & 0xFFFFFF) == 0xFF0000;
      ASSERT_EQ(is_wall, distance > wall_mm) << x << ' ' << y << ' ' << distance;
      before += distance < wall_mm;
      behind += distance > wall_mm && distance < camera_.far_mm;
    }
  EXPECT_GT(before, 200U);
  EXPECT_GT(behind, 200U);
}

// Draws nothing and counts what it was given.
// Its texture would have 2 GiB, which drivers do not count.
TEST_F(HybridMethod, refuses_the_largest_picture_in_words) {
  auto splats = ui::SplatPicture::create();
  ASSERT_TRUE(splats) << splats.error().message;
  ui::DepthImage image;
  image.width = image.height = 16384;
  EXPECT_THAT(splats->draw(image, camera_),
              FailsWith(hal::ErrorCode::unsupported, "16384x16384", "choose a smaller size"));
}

class CountingShare final : public ui::GlShare {
  hal::Result<ui::SegmentCounts> do_draw(const ui::VesselScene& scene,
                                         const ui::VesselSplit& split) override {
    ui::SegmentCounts account;
    for (std::size_t i = 0; i < split.size(); ++i)
      account.drawn += static_cast<std::uint64_t>(split[i] - scene.tree.clusters[i].references);
    return account;
  }
};

TEST_F(HybridMethod, accounts_for_every_segment_whoever_has_it) {
  for (const float radius_px : {0.0F, 0.5F, 2.0F, std::numeric_limits<float>::infinity()}) {
    auto method = ui::HybridMethod::create(1, {}, {std::make_unique<CountingShare>(), radius_px});
    ASSERT_TRUE(method) << method.error().message;
    method->set_detail_px(0.2F);
    const auto account = method->draw(scene());
    ASSERT_TRUE(account) << account.error().message;
    EXPECT_EQ(account->total(), tree_.segments) << radius_px;
    if (radius_px <= 0) {
      EXPECT_EQ(account->drawn, tree_.segments);
    } else if (std::isinf(radius_px)) {
      EXPECT_EQ(account->drawn, 0U);
    } else {
      EXPECT_GT(account->drawn, 0U);
      EXPECT_GT(account->splatted, 0U);
    }
  }
}

} // namespace
} // namespace octascope::tests

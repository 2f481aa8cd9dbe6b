// Pictures of iso-surfaces against closed forms.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "pipeline/volume/cover.h"
#include "pipeline/volume/level_scale.h"
#include "pipeline/volume/occupancy.h"
#include "tests/ui/support/gl_test.h"
#include "ui/gl/picture_texture.h"
#include "ui/ray_caster/ray_frame.h"
#include "ui/volume/surface_technique.h"

namespace octascope::tests {
namespace {

constexpr int size = 240;
constexpr pipeline::VolumeGeometry cube{64, 64, 64, 50, 50, 50};
constexpr float radius_mm = 1.1F;

// Levels fall by 20 dB a millimetre from a ball's surface, where they are 20 dB.
pipeline::Volume ball() {
  pipeline::Volume volume{cube};
  std::ranges::fill(volume.b_scan_states, pipeline::BScanState::good);
  std::size_t i = 0;
  for (int b = 0; b < 64; ++b)
    for (int a = 0; a < 64; ++a)
      for (int z = 0; z < 64; ++z) {
        const glm::vec3 place = glm::vec3{glm::ivec3{a, z, b}} - 31.5F;
        const float outside_mm = glm::length(place) * 0.05F - radius_mm;
        volume.levels[i++] = pipeline::quantise_level(20 - 20 * outside_mm);
      }
  return volume;
}

class SurfaceTechniqueTest : public GlTest {
protected:
  void SetUp() override {
    open(size, size);
    if (IsSkipped())
      return;
    auto made = ui::SurfaceTechnique::create();
    ASSERT_TRUE(made) << made.error().message;
    technique_ = std::move(*made);
    transfer_.emplace();
    colour_ = ui::gl::make_picture_texture(GL_RGBA8, size, size);
    depth_ = ui::gl::make_picture_texture(GL_DEPTH_COMPONENT16, size, size);
    framebuffer_ = ui::gl::Framebuffer::make();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.name(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
    ASSERT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_COMPLETE});
    view_.yaw_deg = 0;
    view_.tilt_deg = 0;
    view_.distance = 4;
    view_.window_offset_db = 10;
    view_.window_size_db = 40; // the surface at 20 dB, a quarter up
  }
  void TearDown() override {
    technique_.reset();
    transfer_.reset();
    colour_ = {};
    depth_ = {};
    texture_ = ui::VolumeTexture{};
    framebuffer_ = {};
  }

  ui::Camera camera() const { return make_camera(view_, ui::box_extents_mm(cube), 1); }

  void draw() {
    glViewport(0, 0, size, size);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    const ui::Camera eye = camera();
    technique_->draw({texture_, *transfer_, eye, view_, 0.05F});
    pixels_.resize(std::size_t{size} * size);
    glReadPixels(0, 0, size, size, GL_RGBA, GL_UNSIGNED_BYTE, pixels_.data());
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  }
  void draw_finished() {
    technique_->finish(view_);
    draw();
  }

  using Pixel = std::array<std::uint8_t, 4>;
  // x to the right and y down, from the picture's middle.
  Pixel pixel(int x, int y) const {
    return pixels_[static_cast<std::size_t>((size / 2 - 1 - y) * size + size / 2 + x)];
  }
  std::ptrdiff_t opaque_pixels() const {
    return std::ranges::count_if(pixels_, [](const Pixel& p) { return p[3] == 255; });
  }
  // Pixels from the middle to where a ball seen from the eye ends: at the tangent.
  float silhouette(float radius) const {
    const ui::Camera eye = camera();
    const float distance = glm::length(eye.eye);
    const float tangent = radius / std::sqrt(distance * distance - radius * radius);
    return tangent / eye.tan_half_height * size / 2;
  }

  std::unique_ptr<ui::SurfaceTechnique> technique_;
  ui::gl::Texture colour_, depth_;
  ui::gl::Framebuffer framebuffer_;
  ui::VolumeTexture texture_; // empty: no volume is looked at but that of the mesh
  std::optional<ui::TransferTexture> transfer_; // wants a context, as all of GL
  ui::ViewState view_;
  std::vector<Pixel> pixels_;
};

TEST_F(SurfaceTechniqueTest, a_ball_has_its_silhouette_from_everywhere) {
  technique_->show(ball());
  for (const auto& [yaw, tilt] : {std::pair{0.0F, 0.0F}, {40.0F, 35.0F}, {180.0F, -60.0F}}) {
    view_.yaw_deg = yaw;
    view_.tilt_deg = tilt;
    draw_finished();
    const double expected = std::acos(-1) * std::pow(static_cast<double>(silhouette(radius_mm)), 2);
    EXPECT_NEAR(static_cast<double>(opaque_pixels()), expected, 0.02 * expected);
  }
  EXPECT_GT(technique_->triangles(), 1000U);
}

// On the line through the ball's middle the surface faces the eye; at the silhouette it is edge-on.
TEST_F(SurfaceTechniqueTest, is_lit_by_a_lamp_at_the_eye_with_depth_cue) {
  technique_->show(ball());
  draw_finished();
  const ui::Camera eye = camera();
  const float half = 1.6F; // of the cube
  const float cue = 1 - ui::depth_cue * (half - radius_mm) / (2 * half);
  EXPECT_NEAR(pixel(0, 0)[0], 255 * ui::surface_tissue * cue, 2);
  EXPECT_EQ(pixel(0, 0)[3], 255);
  // Where the ray from the eye meets the ball, and how steeply.
  const int x = static_cast<int>(silhouette(radius_mm) * 0.85F);
  const float slope = (static_cast<float>(x) + 0.5F) / (size / 2) * eye.tan_half_height;
  const glm::vec3 ray = glm::normalize(glm::vec3{slope, 0, -1});
  const float along = glm::dot(-eye.eye, ray);
  const float closest = std::sqrt(glm::dot(eye.eye, eye.eye) - along * along);
  const float facing = std::sqrt(1 - closest * closest / (radius_mm * radius_mm));
  const float depth = (along - radius_mm * facing) * -ray.z;
  const float light = (ui::surface_ambient + (1 - ui::surface_ambient) * facing) *
                      (1 - ui::depth_cue * (depth - (glm::length(eye.eye) - half)) / (2 * half));
  EXPECT_NEAR(pixel(x, 0)[0], 255 * ui::surface_tissue * light, 5);
}

// Two plates across the view.
pipeline::Volume plates(std::uint8_t far, std::uint8_t near) {
  pipeline::Volume volume{cube};
  std::ranges::fill(volume.b_scan_states, pipeline::BScanState::good);
  for (int a = 16; a < 48; ++a)
    for (int z = 16; z < 48; ++z)
      for (const int b : {8, 9, 10, 53, 54, 55})
        volume.b_scan(b)[static_cast<std::size_t>(a * 64 + z)] = b < 32 ? far : near;
  return volume;
}

TEST_F(SurfaceTechniqueTest, near_parts_hide_far_ones) {
  technique_->show(plates(200, 200)); // drawn from both sides
  std::array<int, 2> brightness{};
  for (const int side : {0, 1}) {
    view_.yaw_deg = side == 0 ? 0.0F : 180.0F;
    draw_finished();
    brightness[static_cast<std::size_t>(side)] = pixel(0, 0)[0];
  }
  EXPECT_NEAR(brightness[0], brightness[1], 3) << "the depth cue tells near from far";
  EXPECT_GT(brightness[0], 0.9 * static_cast<double>(ui::surface_tissue) * 255 * (1 - 0.4 * 0.25));
}

TEST_F(SurfaceTechniqueTest, follows_the_window_and_has_the_colours_of_its_map) {
  technique_->show(ball());
  draw_finished();
  const auto at_first = static_cast<double>(opaque_pixels());
  view_.window_offset_db = 16; // 6 dB more: 0.3 mm further in
  draw_finished();
  const double smaller =
      std::pow(static_cast<double>(silhouette(radius_mm - 0.3F) / silhouette(radius_mm)), 2);
  EXPECT_NEAR(static_cast<double>(opaque_pixels()) / at_first, smaller, 0.03);
  const ui::TransferSet set;
  view_.colour_map = *set.colour_map_named("amber");
  draw_finished();
  const auto amber = set.colours(view_).at(ui::surface_tissue);
  const Pixel middle = pixel(0, 0);
  EXPECT_NEAR(static_cast<float>(middle[1]) / static_cast<float>(middle[0]),
              amber.green / amber.red, 0.02);
  EXPECT_NEAR(static_cast<float>(middle[2]) / static_cast<float>(middle[0]), amber.blue / amber.red,
              0.02);
}

// Of a plate that faces the eye, a share of the box away from its near side.
double facing_light(double share) {
  return 255 * (1 - static_cast<double>(ui::depth_cue) * share);
}

TEST_F(SurfaceTechniqueTest, what_is_brighter_than_the_window_is_white) {
  view_.yaw_deg = 0;
  for (const int level : {140, 190}) { // 30 and 55 dB: half up the window, and above it
    technique_->show(plates(100, static_cast<std::uint8_t>(level)));
    draw_finished();
    const auto place = static_cast<double>(level < 180 ? ui::surface_tissue : ui::surface_metal);
    EXPECT_NEAR(pixel(0, 0)[0], facing_light(0.13) * place, 5);
  }
}

// A sheet across the middle of the box, under which so many A-scans have tissue.
struct Sheet {
  explicit Sheet(int tissue_a_scans) {
    std::ranges::fill(volume.b_scan_states, pipeline::BScanState::good);
    for (std::size_t i = 0; i < volume.levels.size(); ++i) {
      const std::size_t z = i % 64;
      const bool tissue = z >= 50 && i / 64 % 64 < static_cast<std::size_t>(tissue_a_scans);
      volume.levels[i] =
          (z >= 24 && z < 32) || tissue ? 150 : static_cast<std::uint8_t>(45 + i * 7 % 11);
    }
    pipeline::Occupancy occupancy{cube, 0};
    occupancy.update(volume);
    cover.find(occupancy);
  }
  float share() const { return cover.share_at({1.4F, 1.6F, 1.6F}); }

  pipeline::Volume volume{cube};
  pipeline::Cover cover;
};

TEST_F(SurfaceTechniqueTest, what_covers_is_glass) {
  const Sheet sheet{64};
  ASSERT_EQ(sheet.share(), 1);
  view_.tilt_deg = 89;
  view_.see_through_db = 12;
  technique_->show(sheet.volume);
  draw_finished();
  const auto tissue = static_cast<double>(ui::surface_tissue);
  EXPECT_NEAR(pixel(0, 0)[0], facing_light(0.37) * tissue, 5);
  technique_->show(sheet.volume, sheet.cover);
  draw_finished();
  // Each of its two sides hides a share.
  const double clear = std::pow(1 - std::exp2(-12 / 4.8), 2);
  EXPECT_NEAR(pixel(0, 0)[0],
              clear * facing_light(0.78) * tissue + (1 - clear) * facing_light(0.43) * tissue, 5);
  EXPECT_EQ(pixel(0, 0)[3], 255);
  view_.see_through_db = 0; // at once, of the same mesh
  draw();
  EXPECT_NEAR(pixel(0, 0)[0], facing_light(0.37) * tissue, 5);
}

TEST_F(SurfaceTechniqueTest, what_may_cover_is_seen_through_in_part) {
  const Sheet sheet{20};
  ASSERT_NEAR(sheet.share(), 0.5F, 0.1F);
  view_.see_through_db = 12;
  technique_->show(sheet.volume, sheet.cover);
  view_.tilt_deg = 89;
  draw_finished();
  const auto alpha_of = [](float opacity) { return 255 * (1 - (1 - opacity) * (1 - opacity)); };
  EXPECT_NEAR(pixel(0, 0)[3], alpha_of(std::exp2(-12 * sheet.share() / 4.8F)), 3);
}

TEST_F(SurfaceTechniqueTest, glass_is_never_clearer_where_it_is_seen_edge_on) {
  const Sheet sheet{64};
  pipeline::Volume alone = sheet.volume;
  for (std::size_t i = 0; i < alone.levels.size(); ++i)
    alone.levels[i] = i % 64 < 40 ? alone.levels[i] : 45;
  technique_->show(alone, sheet.cover);
  for (const float see_through_db : {1.0F, 4.0F, 12.0F}) {
    view_.see_through_db = see_through_db;
    int last = 0;
    for (const float tilt : {89.0F, 60.0F, 40.0F, 20.0F}) {
      view_.tilt_deg = tilt;
      draw_finished();
      EXPECT_GE(pixel(0, 0)[3], last - 1) << see_through_db << " dB, from " << tilt;
      EXPECT_LT(pixel(0, 0)[3], 255);
      last = pixel(0, 0)[3];
    }
  }
}

TEST_F(SurfaceTechniqueTest, has_the_hue_of_its_depth) {
  auto table = std::make_unique<ui::TransferTable>();
  ui::make_window_table(view_, *table);
  table->window.reset();
  table->depths = ui::DepthColours{};
  transfer_->update(*table);
  technique_->show(plates(150, 150));
  draw_finished();
  const ui::Camera eye = camera();
  for (const float depth_mm : {1.0F, 1.6F, 2.2F}) { // of 3.2
    const int y = static_cast<int>(size * eye.project({0, 1.6F - depth_mm, 1.1F}).y);
    const auto tint = ui::depth_tint(depth_mm / 3.2F);
    const Pixel found = pixel(0, y);
    for (const std::size_t channel : {0U, 2U})
      EXPECT_NEAR(static_cast<float>(found[channel]) / static_cast<float>(found[1]),
                  tint[channel] / tint[1], 0.04F)
          << depth_mm;
  }
}

TEST_F(SurfaceTechniqueTest, draws_the_last_mesh_until_there_is_a_newer_one) {
  draw();
  EXPECT_EQ(opaque_pixels(), 0) << "no volume, no surface";
  technique_->show(ball());
  draw_finished();
  const std::ptrdiff_t whole = opaque_pixels();
  EXPECT_GT(whole, 1000);
  EXPECT_FALSE(technique_->has_newer());
  const std::uint64_t mesh = technique_->prepare(view_);
  draw();
  EXPECT_EQ(opaque_pixels(), whole);
  EXPECT_EQ(technique_->prepare(view_), mesh) << "the same view needs no new one";
  view_.window_offset_db = 80; // nothing is so bright
  draw_finished();
  EXPECT_EQ(opaque_pixels(), 0);
  EXPECT_EQ(technique_->triangles(), 0U);
  EXPECT_EQ(technique_->prepare(view_), mesh + 1);
}

// The first depth bins hold what the background left behind: never a lid over the picture.
TEST_F(SurfaceTechniqueTest, has_no_lid_at_zero_delay) {
  pipeline::Volume lid{cube};
  std::ranges::fill(lid.b_scan_states, pipeline::BScanState::good);
  for (std::size_t i = 0; i < lid.levels.size(); ++i)
    lid.levels[i] = i % 64 < 2 ? 255 : 0;
  technique_->show(lid);
  draw_finished();
  EXPECT_EQ(technique_->triangles(), 0U);
}

} // namespace
} // namespace octascope::tests

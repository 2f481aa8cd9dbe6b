#include "tests/ui/support/volume_stage.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include "pipeline/volume/volume_geometry.h"
#include "ui/dither/soften.h"
#include "ui/transfer/flow_look.h"

namespace octascope::tests {

namespace {

template <class T> T must(hal::Result<T> made) {
  EXPECT_TRUE(made) << made.error().message;
  return std::move(made.value());
}

// GL's rows run from the bottom.
template <class T> std::vector<T> flipped(const std::vector<T>& rows, int width) {
  std::vector<T> result;
  const auto length = static_cast<std::ptrdiff_t>(width);
  for (auto row = rows.end(); row != rows.begin(); row -= length)
    result.insert(result.end(), row - length, row);
  return result;
}

} // namespace

double mean_difference(const StagePicture& a, const StagePicture& b) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const auto& p = a.pixels[i];
    const auto& q = b.pixels[i];
    sum += static_cast<double>(std::abs(p.red - q.red) + std::abs(p.green - q.green) +
                               std::abs(p.blue - q.blue) + std::abs(p.opacity - q.opacity));
  }
  return 255 * sum / (4 * static_cast<double>(a.pixels.size()));
}

double mean_opacity(const StagePicture& picture) {
  double sum = 0;
  for (const auto& pixel : picture.pixels)
    sum += static_cast<double>(pixel.opacity);
  return 255 * sum / static_cast<double>(picture.pixels.size());
}

VolumeStage::VolumeStage()
    : table_{std::make_unique<ui::TransferTable>()}, picture_{must(ui::VolumePicture::create())},
      caster_{
          must(ui::RayCaster::create(std::make_shared<ui::WorkTeam>(1, pipeline::ThreadSetup{})))} {
}

void VolumeStage::show(const pipeline::Volume& volume) {
  occupancy_ = pipeline::Occupancy{volume.geometry, pipeline::blank_depth_bins};
  occupancy_.update(volume);
  EXPECT_TRUE(texture_.upload(volume));
  const ui::FlowVoxels flow{volume.flow, &flow_marks_};
  if (volume.has_flow()) {
    flow_marks_ = pipeline::FlowMarks{volume.geometry, pipeline::blank_depth_bins};
    for (int b = 0; b < volume.geometry.b_scans; ++b)
      flow_marks_.update(b, volume.b_scan_flow(b));
    EXPECT_TRUE(flow_texture_.upload(volume));
  }
  EXPECT_TRUE(caster_.show(volume, occupancy_, {}, volume.has_flow() ? &flow : nullptr));
  light_.show(volume);
  ++uploads_;
}

ui::Camera VolumeStage::camera(const ui::ViewState& view, const StageSettings& settings) const {
  return ui::make_camera(view, ui::box_extents_mm(texture_.geometry()),
                         static_cast<float>(settings.width) / static_cast<float>(settings.height));
}

StagePicture VolumeStage::draw(const ui::ViewState& view, const StageSettings& settings) {
  const auto table = std::make_unique<ui::TransferTable>();
  ui::make_window_table(view, *table);
  if (settings.as_table)
    table->window.reset();
  return draw(view, *table, settings);
}

StagePicture VolumeStage::draw(const ui::ViewState& view, const ui::TransferTable& table,
                               const StageSettings& settings) {
  transfer_.update(table);
  // A key of its own for every picture, so that each is drawn.
  const ui::Camera camera = this->camera(view, settings);
  ui::VolumeScene scene{texture_,  transfer_,        camera,
                        view,      settings.step_mm, settings.leap_empty ? &occupancy_ : nullptr,
                        uploads_++};
  scene.light = light_for(view);
  const ui::FlowScene flow{flow_texture_, flow_marks_, ui::flow_opacity(view.opacity)};
  scene.flow = settings.flow ? &flow : nullptr;
  const auto updated =
      picture_.update(techniques_, scene, {}, {0, 0, settings.width, settings.height});
  EXPECT_TRUE(updated) << updated.error().message;
  return read();
}

const ui::LightVolume* VolumeStage::light_for(const ui::ViewState& view) {
  light_.prepare(ui::window_ramp(view));
  return &light_;
}

StagePicture VolumeStage::read() const {
  StagePicture picture;
  picture.width = picture_.width();
  picture.height = picture_.height();
  const auto count =
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  picture.pixels.resize(count);
  GLint bound = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &bound);
  const auto framebuffer = ui::gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  const auto attach = [](GLuint texture) {
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  };
  attach(picture_.colour_texture());
  glReadPixels(0, 0, picture.width, picture.height, GL_RGBA, GL_FLOAT, picture.pixels.data());
  if (picture_.depth_texture() != 0) {
    std::vector<float> depth(4 * count);
    attach(picture_.depth_texture());
    glReadPixels(0, 0, picture.width, picture.height, GL_RGBA, GL_FLOAT, depth.data());
    for (std::size_t i = 0; i < count; ++i)
      picture.depth_mm.push_back(depth[4 * i]);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  picture.pixels = flipped(picture.pixels, picture.width);
  picture.depth_mm = flipped(picture.depth_mm, picture.width);
  return picture;
}

StagePicture VolumeStage::cast(const ui::ViewState& view, ui::RayMode mode,
                               const StageSettings& settings) {
  ui::make_window_table(view, *table_);
  if (settings.as_table)
    table_->window.reset();
  return cast(view, *table_, mode, settings);
}

StagePicture VolumeStage::cast(const ui::ViewState& view, const ui::TransferTable& table,
                               ui::RayMode mode, const StageSettings& settings) {
  caster_.set_transfer(table);
  ui::RayImage image;
  image.resize(settings.width, settings.height);
  ui::RaySettings cast_settings{mode, settings.step_mm, settings.leap_empty};
  cast_settings.soften = ui::is_grained(settings.step_mm, caster_.geometry()); // as what GL draws
  cast_settings.light = light_for(view);
  if (settings.flow)
    cast_settings.flow_opacity = ui::flow_opacity(view.opacity);
  const auto drawn = caster_.draw(camera(view, settings), cast_settings, image);
  EXPECT_TRUE(drawn) << drawn.error().message;
  StagePicture picture{settings.width, settings.height, {}, image.depth_mm};
  const auto share = [](std::uint32_t rgba, int channel) {
    return static_cast<float>((rgba >> (8 * channel)) & 0xFFU) / 255;
  };
  for (const std::uint32_t rgba : image.rgba)
    picture.pixels.push_back({share(rgba, 0), share(rgba, 1), share(rgba, 2), share(rgba, 3)});
  return picture;
}

} // namespace octascope::tests

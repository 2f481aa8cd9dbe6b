// The volume as one eye sees it, drawn by GL and kept until something that it depends on changes.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/result.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/volume/picture_key.h"
#include "ui/volume/volume_techniques.h"

namespace octascope::ui {

// Drawn into its own texture, in floating point if the GPU supports it, so that hundreds of faint
// planes add up without rounding errors; then composited at any resolution.
//
// Threads: as gl/objects.h.
class VolumePicture {
public:
  static hal::Result<VolumePicture> create();

  // Draws into the texture if the key has changed; the framebuffer binding is kept. `techniques`
  // may be shared with other pictures. `alone` is the same picture without vessels; it may be null
  // if they are opaque. ErrorCode::system: this GL cannot render to a texture of that size.
  hal::Result<> update(VolumeTechniques& techniques, const VolumeScene& scene,
                       const DrawQuality& quality, const Rect& rect,
                       const VolumePicture* alone = nullptr);
  // Blends the picture over the bound framebuffer.
  void composite(const Rect& rect, int target_height) const;

  std::uint64_t drawings() const { return drawings_; } // counts the pictures made

  // Of the last update(), rows from the bottom; owned by the picture.
  GLuint colour_texture() const { return colour_.name(); } // premultiplied
  // R32F: distance in mm along the view at which half of the opacity is reached. Infinity where
  // there is nothing, and everywhere for techniques that write none (slices, planes). Vessels do
  // not count. 0 (no texture) if GL cannot render to this format.
  GLuint depth_texture() const { return depth_.name(); }
  int width() const { return width_; }
  int height() const { return height_; }

private:
  VolumePicture(gl::PicturePass pass, gl::PicturePass soften, gl::PicturePass vessel_mix);
  hal::Result<> resize(int width, int height);
  void clear() const;
  GLuint grained_texture();
  void soften(const DepthMask* vessels) const;
  void add_vessels(const DepthMask& vessels, const VolumePicture* alone) const;

  gl::PicturePass pass_;
  gl::PicturePass soften_;
  gl::PicturePass vessel_mix_;
  gl::Texture colour_;
  gl::Texture grained_; // what is to be softened; made when first needed
  gl::Texture depth_;
  gl::Texture nearest_; // depth attachment for techniques that use GL's depth test
  gl::Framebuffer framebuffer_;
  GLenum format_;
  bool depth_possible_;
  int width_ = 0;
  int height_ = 0;
  std::optional<VolumePictureKey> drawn_;
  std::uint64_t drawings_ = 0;
};

} // namespace octascope::ui

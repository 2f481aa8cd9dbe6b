// The volume as one eye sees it, drawn by GL, kept until something that it depends on changes.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/result.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/volume/picture_key.h"
#include "ui/volume/volume_techniques.h"

namespace octascope::ui {

// Drawn into a texture of its own, in floating point if the GPU can, so that hundreds of faint
// planes add up without rounding; composited from there, at any resolution.
//
// Threads: as gl/objects.h.
class VolumePicture {
public:
  static hal::Result<VolumePicture> create();

  // Draws into the texture if the key has changed; the bound framebuffer stays bound.
  // `techniques` may be shared with other pictures. `alone` is the same picture without vessels,
  // and may be null where they are opaque. ErrorCode::system: this GL cannot render to a texture of
  // that size.
  hal::Result<> update(VolumeTechniques& techniques, const VolumeScene& scene,
                       const DrawQuality& quality, const Rect& rect,
                       const VolumePicture* alone = nullptr);
  // Blends the picture over the bound framebuffer.
  void composite(const Rect& rect, int target_height) const;

  std::uint64_t drawings() const { return drawings_; } // counts the pictures made

  // Of the last update(), rows from the bottom; ours.
  GLuint colour_texture() const { return colour_.name(); } // premultiplied
  // R32F: mm along the view at which half is hidden. Infinity where nothing is, and everywhere for
  // techniques that write no depth (slices, planes). Ignores vessels. 0, no texture, if GL cannot
  // render this format.
  GLuint depth_texture() const { return depth_.name(); }
  int width() const { return width_; }
  int height() const { return height_; }

private:
  VolumePicture(gl::PicturePass pass, gl::PicturePass vessel_mix);
  hal::Result<> resize(int width, int height);
  void clear() const;
  void add_vessels(const DepthMask& vessels, const VolumePicture* alone) const;

  gl::PicturePass pass_;
  gl::PicturePass vessel_mix_;
  gl::Texture colour_;
  gl::Texture depth_;
  gl::Texture nearest_; // for techniques that use GL's depth test
  gl::Framebuffer framebuffer_;
  GLenum format_;
  bool depth_possible_;
  int width_ = 0;
  int height_ = 0;
  std::optional<VolumePictureKey> drawn_;
  std::uint64_t drawings_ = 0;
};

} // namespace octascope::ui

// The volume as the eye sees it, kept until something that it depends on changes.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/result.h"
#include "ui/draw_quality.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/layout.h"
#include "ui/view_state.h"
#include "ui/volume/plane_stack.h"
#include "ui/volume/volume_texture.h"

namespace octascope::ui {

// Which eye's picture, and how large: of a display without stereo, the rectangle that it fills.
struct EyePicture {
  EyePicture(const Rect& rect) // a place on the screen is what most pictures are for
      : width{rect.width}, height{rect.height}, aspect{static_cast<float>(rect.width) /
                                                       static_cast<float>(rect.height)} {}
  EyePicture(const Rect& rect, float seen_aspect, Eye whose)
      : width{rect.width}, height{rect.height}, aspect{seen_aspect}, eye{whose} {}

  int width; // display pixels
  int height;
  float aspect; // width / height as it is seen: stereo displays stretch their pictures
  Eye eye = Eye::centre;
};

// Everything that the volume's picture depends on.
struct VolumePictureKey {
  std::uint64_t upload = 0; // counts volumes
  float yaw_deg = 0;
  float tilt_deg = 0;
  float distance = 0;
  float window_offset_db = 0;
  float window_size_db = 0;
  float opacity = 0;
  Technique technique = Technique::rays;
  int transfer = 0;
  int colour_map = 0;
  int steps = 0;
  int width = 0;
  int height = 0;
  float aspect = 1;
  Eye eye = Eye::centre;
  float parallax_deg = 0; // 0 for Eye::centre
  bool operator==(const VolumePictureKey&) const = default;
};

VolumePictureKey volume_picture_key(const ViewState& view, const DrawQuality& quality,
                                    std::uint64_t upload, const EyePicture& picture);

// Drawn into a texture of its own, in floating point where the GPU can, so that hundreds of faint
// planes add up without rounding; composited from there, at any resolution.
//
// Threads: as gl/objects.h.
class VolumePicture {
public:
  static hal::Result<VolumePicture> create();

  // Draws into the texture if the key has changed; the bound framebuffer stays bound.
  // Fault::system: this GL cannot render to a texture of that size.
  hal::Result<> update(const VolumeTexture& volume, std::uint64_t upload, const ViewState& view,
                       const DrawQuality& quality, const EyePicture& picture);
  // Blends the picture over the bound framebuffer.
  void composite(const Rect& rect, int target_height) const;

private:
  VolumePicture(PlaneStack stack, gl::PicturePass pass);
  hal::Result<> resize(int width, int height);

  PlaneStack stack_;
  gl::PicturePass pass_;
  gl::Texture colour_;
  gl::Framebuffer framebuffer_;
  GLenum format_;
  int width_ = 0;
  int height_ = 0;
  std::optional<VolumePictureKey> drawn_;
};

} // namespace octascope::ui

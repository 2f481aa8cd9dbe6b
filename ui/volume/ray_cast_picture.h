// The volume drawn by the processor's ray caster, in a texture that GL composites: the counterpart
// of ui/volume/volume_picture.h.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/result.h"
#include "ui/damage/damage.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/ray_caster/ray_caster.h"
#include "ui/volume/picture_key.h"

namespace octascope::ui {

// Threads: as gl/objects.h. Allocates when `rect` grows and when vessels are first shown; GL does when the
// picture's size changes.
class RayCastPicture {
public:
  static hal::Result<RayCastPicture> create();

  // Casts and uploads if anything that the picture depends on has changed. `caster` must show the
  // scene's volume with its transfer function, and may be shared with other pictures.
  hal::Result<> update(RayCaster& caster, const VolumeScene& scene, RayMode mode,
                       const DrawQuality& quality, const Rect& rect);
  // Blends the picture over the bound framebuffer.
  void composite(const Rect& rect, int target_height) const;

  // Adds what composite() draws in another way since the last update(), within `rect`.
  void add_changed(const Rect& rect, Damage& damage) const;

  std::uint64_t drawings() const { return drawings_; } // counts the pictures made

private:
  explicit RayCastPicture(gl::PicturePass pass) : pass_{std::move(pass)} {}
  void fit(RayImage& image, int width, int height) const;
  hal::Result<> resize(int width, int height, const Rect& rect);
  hal::Result<> cast(RayCaster& caster, const VolumeScene& scene, RayMode mode,
                     const DrawQuality& quality, const VolumePictureKey& key);
  void merge(const DepthMask& vessels);
  void note_changes(const RayCaster& caster, bool renewed);
  void find_filled();
  Rect shown_at(const Rect& texels, const Rect& rect) const;
  void upload_image();
  const RayImage& shown() const { return has_vessels_ ? merged_ : image_; }
  Rect visible_in(const Rect& rect) const;

  gl::PicturePass pass_;
  gl::Texture texture_;
  RayImage image_;    // the volume, up to the vessels
  RayImage merged_;   // with them; of use if has_vessels_
  RayImage alone_;    // the volume without vessels, if these are not opaque
  int most_wide_ = 0; // of the images, at full quality
  int most_high_ = 0;
  bool has_vessels_ = false;
  bool renews_ = false; // of the last update(): only what changed was cast
  std::optional<VolumePictureKey> alone_drawn_;
  RayMode alone_mode_ = RayMode::composite;
  std::optional<VolumePictureKey> drawn_;
  std::optional<VolumePictureKey> cast_; // of update(): what the image held before
  std::vector<Rect> changed_;            // of the image, by the last update()
  std::vector<std::uint8_t> filled_;     // by tile of the image: whether anything is in it
  std::vector<std::uint8_t> was_filled_;
  std::uint64_t drawings_ = 0;
  RayMode drawn_mode_ = RayMode::composite;
};

} // namespace octascope::ui

// The volume as the processor's ray caster sees it, in a texture that GL composites: the twin of
// ui/volume/volume_picture.h.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/result.h"
#include "pipeline/volume.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/gl/pixel_uploader.h"
#include "ui/layout.h"
#include "ui/ray_caster/ray_caster.h"
#include "ui/transfer/transfer_set.h"
#include "ui/view_state.h"
#include "ui/volume/volume_picture.h"

namespace octascope::ui {

// Threads: as gl/objects.h, but for the ray caster's own helpers. Allocates when the size or the
// geometry changes.
class RayCastPicture {
public:
  // Fault::unsupported: this processor has no instruction set that the ray caster is compiled for.
  static hal::Result<RayCastPicture> create(std::size_t helpers, const pipeline::ThreadSetup& setup,
                                            TransferSet transfers = {});

  // Copies the volume. On an error (RayCaster::show() lists them) the last one stays.
  hal::Result<> show(const pipeline::Volume& volume) { return caster_.show(volume); }

  // Casts and uploads if anything that the picture depends on has changed; `upload` counts the
  // volumes shown.
  hal::Result<> update(std::uint64_t upload, const ViewState& view, RayMode mode,
                       const DrawQuality& quality, const Rect& rect);
  // Blends the picture over the bound framebuffer.
  void composite(const Rect& rect, int target_height) const;

  const RayImage& image() const { return image_; } // the last one, with its depths

private:
  RayCastPicture(RayCaster caster, gl::PicturePass pass, TransferSet transfers);
  void resize(int width, int height);
  hal::Result<> upload_image();

  RayCaster caster_;
  gl::PicturePass pass_;
  gl::PixelUploader uploader_;
  gl::Texture texture_;
  TransferSet transfers_;
  std::unique_ptr<TransferTable> transfer_;
  RayImage image_;
  std::optional<VolumePictureKey> drawn_;
  RayMode drawn_mode_ = RayMode::composite;
};

} // namespace octascope::ui

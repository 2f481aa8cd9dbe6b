// The shown volume as a 3D texture.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/volume/volume.h"
#include "ui/gl/objects.h"
#include "ui/gl/pixel_uploader.h"

namespace octascope::ui {

// R8 texels in the volume's own order: s is depth, t the fast axis, r the slow axis; sample i of n
// lies at (i + 0.5) / n. Alternates between two textures, so that it never writes one that the GPU
// may still read.
//
// Threads: as gl/objects.h. Allocates only when the geometry changes.
class VolumeTexture {
public:
  // Whether the GL that is current here has textures for it. ErrorCode::unsupported: it has not.
  static hal::Result<> check_size(const pipeline::VolumeGeometry& geometry);

  // Copies the levels before it returns. Errors: check_size()'s;
  // ErrorCode::bad_data: fewer voxels than the geometry says. The previous volume stays.
  hal::Result<> upload(const pipeline::Volume& volume);

  // The same where the volume differs from the one that was uploaded last in these B-scans alone.
  hal::Result<> renew(const pipeline::Volume& volume,
                      std::span<const pipeline::BScanRange> changed);

  bool empty() const { return !textures_[front_]; }
  GLuint name() const { return textures_[front_].name(); }
  const pipeline::VolumeGeometry& geometry() const { return geometry_; }

private:
  void allocate(const pipeline::VolumeGeometry& geometry);
  hal::Result<> write(const pipeline::Volume& volume, const pipeline::BScanRange& range);

  std::array<gl::Texture, 2> textures_;
  gl::PixelUploader uploader_;
  pipeline::VolumeGeometry geometry_;
  std::size_t front_ = 0;
  std::vector<std::uint8_t> old_; // by B-scan: bits of the textures that lack its newest levels
};

} // namespace octascope::ui

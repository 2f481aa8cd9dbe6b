// The shown volume as a 3D texture, or what flows in it.
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

// What of a volume is going to be read from its texture: all of it, or no more than two sections, those
// at a B-scan and at an A-scan, as a software GL needs whose volume the processor draws.
struct TextureParts {
  bool all = true;
  int b_scan = 0; // limited to those there are
  int a_scan = 0;
};

// What a texture has of a volume.
enum class Voxels : std::uint8_t { levels, flow };

// R8 texels in the volume's own order: s is depth, t the fast axis, r the slow axis; sample i of n
// lies at (i + 0.5) / n. Alternates between two textures, so that it never writes one that the GPU
// may still read.
//
// Threads: as gl/objects.h. Allocates only when the geometry changes.
class VolumeTexture {
public:
  explicit VolumeTexture(Voxels of = Voxels::levels) : of_{of} {}

  // Whether the GL that is current here has textures for it. ErrorCode::unsupported: it has not.
  static hal::Result<> check_size(const pipeline::VolumeGeometry& geometry);

  // Copies the voxels of those parts before it returns. Errors: check_size()'s;
  // ErrorCode::bad_data: fewer of them than the geometry says; a driver's that has no memory. Of the
  // same geometry the previous volume stays.
  hal::Result<> upload(const pipeline::Volume& volume, const TextureParts& parts = {});

  // The same where the volume differs from the one that was uploaded last in these B-scans alone;
  // none: in nothing, and what of the parts was left out then is copied.
  hal::Result<> renew(const pipeline::Volume& volume, std::span<const pipeline::BScanRange> changed,
                      const TextureParts& parts = {});

  // Whether it has them of the volume that was uploaded or renewed last.
  bool holds(const TextureParts& parts) const;

  bool empty() const { return !textures_[front_]; }
  GLuint name() const { return textures_[front_].name(); }
  const pipeline::VolumeGeometry& geometry() const { return geometry_; }

private:
  std::span<const std::uint8_t> voxels(const pipeline::Volume& volume) const;
  hal::Result<> check(const pipeline::Volume& volume) const;
  void allocate(const pipeline::VolumeGeometry& geometry);
  hal::Result<> write(const pipeline::Volume& volume, const pipeline::BScanRange& range);
  hal::Result<> write_lacking(const pipeline::Volume& volume, const pipeline::BScanRange& range);
  hal::Result<> write_a_scans(const pipeline::Volume& volume, const pipeline::BScanRange& a_scans);
  hal::Result<> fill_back(const pipeline::Volume& volume, const TextureParts& parts);
  void make_old(std::size_t texture, std::span<const pipeline::BScanRange> changed);
  pipeline::BScanRange b_scans_of(const TextureParts& parts) const;
  bool lacks_none(std::size_t texture, const pipeline::BScanRange& b_scans) const;

  Voxels of_;
  std::array<gl::Texture, 2> textures_;
  gl::PixelUploader uploader_;
  pipeline::VolumeGeometry geometry_;
  std::size_t front_ = 0;
  std::vector<std::uint8_t> old_;     // by B-scan: bits of the textures that lack its newest levels
  std::array<int, 2> a_scan_{-1, -1}; // of the section that a texture has the newest levels of
  std::vector<std::uint8_t> a_scans_; // what is copied of that one
};

} // namespace octascope::ui

// The vessels as one eye sees them, kept until something that they depend on changes.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/result.h"
#include "ui/depth_mask/depth_mask.h"
#include "ui/gl/objects.h"
#include "ui/vessels/scene/vessel_scene.h"
#include "ui/vessels/splatter/splat_picture.h"
#include "ui/vessels/splatter/splatter.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// What draws the volume and therefore reads the depth mask.
enum class MaskReader : std::uint8_t { gl, processor };

// Threads: as gl/objects.h. Allocates when the size changes, or on the first use by GL.
class VesselLayer {
public:
  // `tree` is a counter of the trees shown. The framebuffer binding is kept. ErrorCode::system:
  // this GL cannot render to a picture of that size; other errors as Splatter::draw().
  hal::Result<> update(Splatter& splatter, const VesselScene& scene, std::uint64_t tree,
                       float detail_px, MaskReader target);

  // The mask of the last update(), with that `opacity`.
  DepthMask stops(MaskReader target, float opacity) const;

  const SegmentCounts& account() const { return account_; }
  std::uint64_t drawings() const { return drawings_; } // counts the pictures made

private:
  struct Key {
    std::uint64_t tree = 0;
    glm::mat4 world_from_tree{0};
    glm::mat4 view_projection{0};
    VesselLook look;
    float detail_px = 0;
    int width = 0;
    int height = 0;
    bool operator==(const Key&) const = default;
  };

  hal::Result<> lay_into_gl(const VesselScene& scene);
  hal::Result<> resize(int width, int height);

  DepthImage image_;
  SegmentCounts account_;
  std::optional<Key> drawn_;
  std::uint64_t drawings_ = 0;
  // The GL side.
  std::optional<SplatPicture> picture_;
  gl::Framebuffer framebuffer_;
  gl::Texture colour_;
  gl::Texture depth_;
  int width_ = 0;
  int height_ = 0;
  std::uint64_t laid_ = 0; // the drawing that GL has
};

} // namespace octascope::ui

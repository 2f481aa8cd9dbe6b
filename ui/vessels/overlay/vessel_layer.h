// The vessels as seen by one eye, kept until something that they depend on changes.
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

// Who draws the volume, and so reads the mask.
enum class MaskReader : std::uint8_t { gl, processor };

// Threads: as gl/objects.h. Allocates when the size changes, or GL is first served.
class VesselLayer {
public:
  // `tree` counts the trees shown. ErrorCode::system: this GL cannot render to a picture of that
  // size; other errors as Splatter::draw(). The bound framebuffer stays bound.
  hal::Result<> update(Splatter& splatter, const VesselScene& scene, std::uint64_t tree,
                       float detail_px, MaskReader target);

  // From the last update(); `opacity` is passed on.
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
  // In GL.
  std::optional<SplatPicture> picture_;
  gl::Framebuffer framebuffer_;
  gl::Texture colour_;
  gl::Texture depth_;
  int width_ = 0;
  int height_ = 0;
  std::uint64_t laid_ = 0; // the drawing uploaded to GL
};

} // namespace octascope::ui

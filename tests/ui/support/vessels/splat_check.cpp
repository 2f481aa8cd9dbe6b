#include "tests/ui/support/vessels/splat_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/ui/support/vessels/reference_segments.h"

namespace octascope::tests {
namespace {

constexpr double edge_px = 0.01;
constexpr double distance_tolerance = 2e-4;

// Could the segment give a pixel that colour?
bool may_be(const ui::VesselScene& scene, const ReferenceSegment& s, const ReferencePlace& h,
            std::uint32_t rgba) {
  constexpr double rounding = 1.5;
  const auto brightness = [&](const ReferencePlace::Light& light, double moved_px) {
    return 255 *
           reference_light((light.off_px + moved_px) / h.radius_px, h.radius_px, light.stretch) *
           double{ui::vessel_fading(scene.look, static_cast<float>(h.distance_mm))};
  };
  const auto& [one, other] = h.lights;
  const double darkest = std::min(brightness(one, edge_px), brightness(other, edge_px));
  const double lightest = std::max(brightness(one, -edge_px), brightness(other, -edge_px));
  for (std::size_t i = 0; i < 3; ++i) {
    const double shown = rgba >> (8 * i) & 255U;
    const double base = s.colour[i];
    if (shown < base * darkest - rounding || shown > base * lightest + rounding)
      return false;
  }
  return true;
}

class Checker {
public:
  Checker(const ui::VesselScene& scene, const ui::DepthImage& image)
      : scene_{scene}, image_{image}, explained_(pixels(), 0), missed_(pixels(), 0) {}

  void add(const ReferenceSegment& s) {
    result_.sub_pixel += s.widest_px() < 0.5;
    const PixelRange range = pixels_around(s, edge_px, scene_);
    for (int y = range.top; y < range.bottom; ++y)
      for (int x = range.left; x < range.right; ++x)
        look_at(s, x, y);
  }

  SplatCheck result() {
    for (std::size_t i = 0; i < pixels(); ++i) {
      const bool covered = image_.pixels[i] != ui::empty_depth_pixel;
      result_.covered += covered;
      result_.unexplained += covered && !explained_[i];
      result_.missed += missed_[i];
    }
    return result_;
  }

private:
  std::size_t pixels() const {
    return static_cast<std::size_t>(scene_.width) * static_cast<std::size_t>(scene_.height);
  }
  void look_at(const ReferenceSegment& s, int x, int y) {
    const ReferencePlace place = place_in(s, {x + 0.5, y + 0.5}, scene_);
    if (place.outside_px() > edge_px || place.axis_mm > double{scene_.camera.far_mm})
      return;
    const double nearest = place.nearest_mm * (1 - distance_tolerance);
    const double farthest = place.farthest_mm * (1 + distance_tolerance);
    const auto i = static_cast<std::size_t>(y * scene_.width + x);
    const double shown = image_.distance_mm(x, y);
    if (place.outside_px() < -edge_px && shown > farthest)
      missed_[i] = 1;
    if (shown >= nearest && shown <= farthest && may_be(scene_, s, place, image_.rgba(x, y)))
      explained_[i] = 1;
  }

  const ui::VesselScene& scene_;
  const ui::DepthImage& image_;
  std::vector<std::uint8_t> explained_;
  std::vector<std::uint8_t> missed_;
  SplatCheck result_;
};

} // namespace

SplatCheck check_splats(const ui::VesselScene& scene, const ui::DepthImage& image) {
  Checker checker{scene, image};
  for (const ReferenceSegment& segment : reference_segments(scene))
    checker.add(segment);
  return checker.result();
}

} // namespace octascope::tests

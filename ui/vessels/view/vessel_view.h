// Views of a vessel tree.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <glm/vec3.hpp>

#include "ui/vessels/scene/vessel_scene.h"
#include "ui/view/camera.h"
#include "ui/view/vessel_look.h"

namespace octascope::ui {

// The box, along the tree's axes, that contains its clusters with their whole thickness.
struct VesselBounds {
  glm::vec3 lower_mm{0};
  glm::vec3 upper_mm{0};

  glm::vec3 middle_mm() const { return 0.5F * (lower_mm + upper_mm); }
  glm::vec3 extents_mm() const { return upper_mm - lower_mm; }
};
VesselBounds vessel_bounds(const pipeline::VesselClusters& tree);

// Yaw and tilt as in ViewState, about the target; the tree's y points up.
struct VesselView {
  glm::vec3 target_mm{0};
  float yaw_deg = 35;
  float tilt_deg = 15;
  float mm_per_pixel = 0.1F; // at the target

  bool operator==(const VesselView&) const = default;
};

// Keeps yaw and tilt and sets target and scale so that the box of every cluster is in the picture,
// with one touching its margin. For an empty tree: looks at the origin.
VesselView fit_whole_tree(VesselView view, const pipeline::VesselClusters& tree, int width,
                          int height);

// Faces the target. Near and far plane enclose the visible part of the bounds; anything nearer to
// the eye than half the target's distance is cut away, or a close view would end at the next trunk.
Camera make_vessel_camera(const VesselView& view, const VesselBounds& bounds, int width,
                          int height);

// Sets the look's depth cue for the visible part of the bounds: at most two heights of the picture
// before and behind the target, so that a close view has depth, too.
VesselLook with_cue(VesselLook look, const VesselView& view, const VesselBounds& bounds, int width,
                    int height);

// The views in which methods are measured; they depend only on the tree and the picture's size.
enum class BenchmarkView : std::uint8_t {
  whole,  // the tree fills the picture
  middle, // 20 µm a pixel, where most segments are to be seen: the hardest
  close,  // 2 µm a pixel, among the capillaries, where they are densest
};
inline constexpr std::array all_benchmark_views{BenchmarkView::whole, BenchmarkView::middle,
                                                BenchmarkView::close};
std::string_view to_string(BenchmarkView view);

// For an empty tree: looks at the origin.
VesselView make_benchmark_view(BenchmarkView view, const pipeline::VesselClusters& tree, int width,
                               int height);

} // namespace octascope::ui

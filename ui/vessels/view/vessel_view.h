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

// The box, along the tree's axes, of its clusters with their full thickness.
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

// Keeps yaw and tilt and chooses target and scale so that all vessels are in the picture, in its
// middle, and touch its margin at two opposite sides. For an empty tree: looks at the origin.
VesselView fit_whole_tree(VesselView view, const pipeline::VesselClusters& tree, int width,
                          int height);

// Faces the target. Near and far plane enclose the visible part of the bounds. What is nearer to
// the eye than half the target's distance is cut away; otherwise a close look would end at the next
// trunk.
Camera make_vessel_camera(const VesselView& view, const VesselBounds& bounds, int width,
                          int height);

// The eye turned, so that the picture of so many rows moves by so many pixels in its middle; moved
// aside, it would shift what is far by less. For what lies within a pixel.
Camera turned(Camera camera, float right_px, float up_px, int height);

// Sets the look's depth cue to what the camera shows of the bounds, but at most to two picture
// heights in front of and behind the target, so that a close look has depth too.
VesselLook with_cue(VesselLook look, const VesselView& view, const VesselBounds& bounds, int width,
                    int height);

// The views for benchmarks; they depend only on the tree and the picture's size.
enum class BenchmarkView : std::uint8_t {
  whole,  // the tree fills the picture
  middle, // 20 µm per pixel, where most segments are visible: the hardest
  close,  // 2 µm per pixel, among the capillaries, where they are densest
};
inline constexpr std::array all_benchmark_views{BenchmarkView::whole, BenchmarkView::middle,
                                                BenchmarkView::close};
std::string_view to_string(BenchmarkView view);

// For an empty tree: looks at the origin.
VesselView make_benchmark_view(BenchmarkView view, const pipeline::VesselClusters& tree, int width,
                               int height);

} // namespace octascope::ui

// Where the eye is, and how millimetres become pixels.
//
// World axes, in mm, right-handed, origin at the centre of the volume's box: x along the fast axis
// (A-scan 0 at −x), y against the depth (depth 0, the surface side, at +y: depth points down on
// the screen), z along the slow axis (B-scan 0 at −z). At yaw 0 the eye is on the side of the last
// B-scan and A-scans run from left to right; seen from straight above, B-scans run from top to
// bottom, as in the en-face panel.
#pragma once

#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/volume/volume.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

inline constexpr float field_of_view_deg = 36; // along the shorter side of the picture

// Which eye a picture is for; `centre` on a display without stereo.
enum class StereoEye : std::uint8_t { centre, left, right };

// The two eyes of a stereo picture look in the same direction, side by side, and their pictures are
// shifted so that the volume's centre is in the middle of both: off-axis projection, which, unlike
// converging eyes, gives no vertical parallax. Source: P. Bourke, "Calculating stereo pairs"
// (1999).
struct Camera {
  glm::vec3 eye;
  glm::vec3 forward; // unit vectors
  glm::vec3 right;
  glm::vec3 up;
  float near_mm = 0;
  float far_mm = 0;
  float tan_half_height = 0; // of the picture, at distance 1
  float aspect = 1;          // width / height of the picture as the eye sees it
  // How far the picture's middle lies to the right of `forward`, at distance 1: 0 for
  // StereoEye::centre. The ray through the point of the picture that is x right and y up of its
  // middle, in units of distance 1, is forward + (x + centre_shift) · right + y · up. Distances
  // along the view are along `forward` for either eye. view_projection contains it.
  float centre_shift = 0;
  glm::mat4 view_projection;

  // Distance from the eye along the view direction.
  float depth_of(const glm::vec3& point) const;
  // On the screen: x right and y down, in units of the picture's height from its centre.
  glm::vec2 project(const glm::vec3& point) const;
};

// (fast, depth, slow) extents of the volume's box.
glm::vec3 box_extents_mm(const pipeline::VolumeGeometry& geometry);

// `aspect` is width / height of the picture as the eye sees it, whatever the shape of its pixels.
// The eyes are ViewState::parallax_deg apart, seen from the volume's centre.
Camera make_camera(const ViewState& view, const glm::vec3& extents_mm, float aspect,
                   StereoEye eye = StereoEye::centre);

} // namespace octascope::ui

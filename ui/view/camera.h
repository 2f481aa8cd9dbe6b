// The position of the eye and the projection from millimetres to pixels.
//
// World axes, in mm, right-handed, origin at the centre of the volume's box: x along the fast axis
// (A-scan 0 at −x), y against the depth (depth 0, the surface side, at +y: depth points down on
// the screen), z along the slow axis (B-scan 0 at −z). At yaw 0 the eye is on the side of the last
// B-scan and A-scans run from left to right. Seen from straight above, B-scans run from top to
// bottom, as in the en-face panel.
#pragma once

#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/volume/volume.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

inline constexpr float field_of_view_deg = 36; // from top to bottom; more in a narrow picture

// Which eye a picture is for; `centre` on a display without stereo.
enum class StereoEye : std::uint8_t { centre, left, right };

// The two eyes of a stereo picture look in the same direction, side by side, with their pictures
// shifted so that the volume's centre is in the middle of both. Unlike turning the eyes towards
// each other, this off-axis projection gives no vertical parallax. Source: P. Bourke, "Calculating
// stereo pairs" (1999).
struct Camera {
  glm::vec3 eye;
  glm::vec3 forward; // unit vectors
  glm::vec3 right;
  glm::vec3 up;
  float near_mm = 0;
  float far_mm = 0;
  float tan_half_height = 0; // of the picture, at distance 1
  float aspect = 1;          // width / height of the picture as the eye sees it
  // Offset of the picture's middle to the right of `forward`, at distance 1; 0 for
  // StereoEye::centre. The ray through the point x right and y up of the picture's middle, at
  // distance 1, is forward + (x + centre_shift) · right + y · up. Distances along the view are
  // along `forward` for either eye. view_projection includes it.
  float centre_shift = 0;
  glm::mat4 view_projection;

  // Distance from the eye along the view direction.
  float depth_of(const glm::vec3& point) const;
  // Screen position: x right and y down from the picture's centre, in units of its height.
  glm::vec2 project(const glm::vec3& point) const;
};

// (fast, depth, slow) extents of the volume's box.
glm::vec3 box_extents_mm(const pipeline::VolumeGeometry& geometry);

// `aspect` is width / height of the picture as the eye sees it, whatever the shape of its pixels.
// Seen from the volume's centre, the eyes are ViewState::parallax_deg apart.
Camera make_camera(const ViewState& view, const glm::vec3& extents_mm, float aspect,
                   StereoEye eye = StereoEye::centre);

} // namespace octascope::ui

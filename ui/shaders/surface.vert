// A corner of an iso-surface (pipeline/surface/iso_surface.h), in mm along depth, fast and slow axis.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;

uniform mat4 u_view_projection;
uniform vec3 u_eye;
uniform vec3 u_forward;
uniform vec3 u_extents; // of the box, mm: fast, depth, slow

out vec3 v_normal;
out vec3 v_from_eye;
out float v_slow;  // 0…1 along the slow axis
out float v_depth; // mm from the eye, along the view

// ui/view/camera.h has the axes of the world.
vec3 to_world(vec3 axes) { return vec3(axes.y, -axes.x, axes.z); }

void main() {
  vec3 world = to_world(a_position) + vec3(-0.5, 0.5, -0.5) * u_extents;
  gl_Position = u_view_projection * vec4(world, 1.0);
  v_slow = a_position.z / u_extents.z;
  v_normal = to_world(a_normal);
  v_from_eye = world - u_eye;
  v_depth = dot(v_from_eye, u_forward);
}

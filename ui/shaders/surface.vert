// A corner of an iso-surface (pipeline/surface/iso_surface.h), in mm along depth, fast and slow axis.

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in float a_brightest; // level at hand
layout(location = 3) in float a_cover;     // 1: surely covers other tissue

uniform mat4 u_view_projection;
uniform vec3 u_eye;
uniform vec3 u_forward;
uniform vec3 u_extents;   // of the box, mm: fast, depth, slow
uniform vec2 u_window;    // scale and offset of the ramp
uniform vec2 u_metallic;  // from where to where in the window tissue becomes metal
uniform float u_halvings; // of the opacity of what covers; 0: it is not seen through

out vec3 v_normal;
out vec3 v_from_eye;
out vec3 v_texture; // depth, fast axis, slow axis: shares of the box
out float v_depth;  // mm from the eye, along the view
out float v_cover;  // share of glass
out float v_place;  // in the window, of the brightest at hand; more than 1 above it

// ui/view/camera.h has the axes of the world.
vec3 to_world(vec3 axes) { return vec3(axes.y, -axes.x, axes.z); }

void main() {
  vec3 world = to_world(a_position) + vec3(-0.5, 0.5, -0.5) * u_extents;
  gl_Position = u_view_projection * vec4(world, 1.0);
  v_normal = to_world(a_normal);
  v_from_eye = world - u_eye;
  v_depth = dot(v_from_eye, u_forward);
  v_texture = a_position / u_extents.yxz;
  v_place = a_brightest * u_window.x + u_window.y;
  // Metal's side lobes may lie in the cover's depths.
  v_cover = u_halvings > 0.0 ? a_cover * (1.0 - smoothstep(u_metallic.x, u_metallic.y, v_place)) : 0.0;
}

// A corner of an iso-surface (pipeline/surface/iso_surface.h), in mm along depth, fast and slow axis.
precision highp sampler3D;

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;

uniform mat4 u_view_projection;
uniform vec3 u_eye;
uniform vec3 u_forward;
uniform vec3 u_extents; // of the box, mm: fast, depth, slow
uniform sampler3D u_levels;
uniform sampler3D u_weakened; // the same with what covers drawn weaker …
uniform float u_weakened_by;  // … by so much, as a share of the texture's range; 0: nothing is
uniform vec2 u_window;        // scale and offset of the ramp
uniform vec2 u_metallic;      // from where to where in the window tissue becomes metal

out vec3 v_normal;
out vec3 v_from_eye;
out vec3 v_texture; // depth, fast axis, slow axis: shares of the box
out float v_depth;  // mm from the eye, along the view
out float v_cover;  // 1: what covers other tissue
out float v_place;  // in the window, of the brightest at hand; more than 1 above it

// Metal is a thin line in a surface that its side lobes make, most of it above where they end: it is looked
// for along the depth, a little inside.
const int probes = 16;
const float first_probe_mm = -0.4;
const float probe_mm = 0.04; // from one to the next
const float inside_mm = 0.06;

// ui/view/camera.h has the axes of the world.
vec3 to_world(vec3 axes) { return vec3(axes.y, -axes.x, axes.z); }

void main() {
  vec3 world = to_world(a_position) + vec3(-0.5, 0.5, -0.5) * u_extents;
  gl_Position = u_view_projection * vec4(world, 1.0);
  v_normal = to_world(a_normal);
  v_from_eye = world - u_eye;
  v_depth = dot(v_from_eye, u_forward);
  vec3 to_texture = 1.0 / u_extents.yxz;
  v_texture = a_position * to_texture;
  float level = 0.0;
  for (int i = 0; i < probes; ++i) {
    vec3 place = a_position - inside_mm * a_normal;
    place.x += first_probe_mm + float(i) * probe_mm;
    level = max(level, textureLod(u_levels, place * to_texture, 0.0).r);
  }
  v_place = level * u_window.x + u_window.y;
  v_cover = 0.0;
  if (u_weakened_by > 0.0) {
    float lost = textureLod(u_levels, v_texture, 0.0).r - textureLod(u_weakened, v_texture, 0.0).r;
    // Metal's side lobes may lie in the cover's depths.
    v_cover = lost / u_weakened_by * (1.0 - smoothstep(u_metallic.x, u_metallic.y, v_place));
  }
}

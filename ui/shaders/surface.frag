// An opaque surface, lit by a lamp at the eye, from whichever side it is seen. Before this stands
// stops.glsl.
in vec3 v_normal;
in vec3 v_from_eye;
in float v_slow;
in float v_depth;

uniform vec2 u_kept; // by a cut, of the slow axis
uniform vec3 u_colour;
uniform float u_ambient;
uniform vec2 u_cue;       // where the depth cue begins, and 1 / the length over which it falls
uniform float u_cue_loss; // what the far end of the box loses

layout(location = 0) out vec4 o_colour;
layout(location = 1) out float o_depth; // mm along the view

void main() {
  if (v_depth >= stop_mm() || v_slow < u_kept.x || v_slow > u_kept.y)
    discard;
  float slant = max(length(v_normal) * length(v_from_eye), 1e-6);
  float facing = abs(dot(v_normal, v_from_eye)) / slant;
  float light = mix(u_ambient, 1.0, facing);
  light *= 1.0 - u_cue_loss * clamp((v_depth - u_cue.x) * u_cue.y, 0.0, 1.0);
  o_colour = vec4(u_colour * light, 1.0);
  o_depth = v_depth;
}

// A cross-section of the volume, depth downwards, windowed by formula 1 of the OCT paper: along a
// B-scan, or across all of them. With ALL_GOOD, of B-scans that are all good; with FLOW, of a volume
// with what flows.
precision highp sampler3D;
precision highp usampler2D;

in vec2 v_unit;

uniform sampler3D u_levels;
uniform usampler2D u_states; // one texel a B-scan (ui/panels/state_texture.h)
uniform vec2 u_window;       // scale and offset of the ramp
// Texture coordinates (depth, fast axis, slow axis) of the upper left corner, and from there to the
// right and downwards.
uniform vec3 u_corner;
uniform vec3 u_across;
uniform vec3 u_down;
uniform vec3 u_hatch;
uniform float u_mark_height; // of the mark over a saturated B-scan, as a share of the height
uniform vec3 u_mark;
uniform vec3 u_seam;
#ifdef FLOW
uniform sampler2D u_flow;       // depth, and what lies across the picture
uniform float u_untold_height; // of the mark under a B-scan whose flow could not be told, as u_mark_height
#endif

out vec4 o_colour;

#ifndef ALL_GOOD
uint state_of(int b_scan, int count) {
  return texelFetch(u_states, ivec2(clamp(b_scan, 0, count - 1), 0), 0).r;
}
uint of_levels(uint state) { return state & 15u; }
#endif

void main() {
  vec3 place = u_corner + v_unit.x * u_across + v_unit.y * u_down;
#ifndef ALL_GOOD
  int count = textureSize(u_states, 0).x;
  float slow = place.z * float(count);
  int here = clamp(int(slow), 0, count - 1);
  uint states = state_of(here, count);
  uint state = of_levels(states);
  // A missing B-scan has no levels that a neighbour could be mixed with, nor has the seam.
  uint beside = of_levels(state_of(slow - float(here) < 0.5 ? here - 1 : here + 1, count));
  if (beside == 0u || beside == 3u)
    place.z = (float(here) + 0.5) / float(count);
#endif
  float level = texture(u_levels, place).r;
  vec3 colour = vec3(clamp(level * u_window.x + u_window.y, 0.0, 1.0));
#ifdef FLOW
  vec2 section = vec2(place.x, u_across.z > 0.0 ? place.z : place.y);
  colour = with_flow(colour, flow_weight(texture(u_flow, section).r));
#endif
#ifndef ALL_GOOD
#ifdef FLOW
  if ((states & 16u) != 0u && v_unit.y > 1.0 - u_untold_height)
    colour = untold_hatch(gl_FragCoord.xy, u_hatch);
#endif
  if (state == 2u && v_unit.y < u_mark_height)
    colour = u_mark;
  if (state == 0u)
    colour = hatch(gl_FragCoord.xy, u_hatch);
  if (state == 3u && u_across.z > 0.0)
    colour = u_seam;
#endif
  o_colour = vec4(colour, 1.0);
}

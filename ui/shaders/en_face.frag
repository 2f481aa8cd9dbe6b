// The projection along depth: the fast axis to the right, B-scans downwards.
// With ALL_GOOD, of B-scans that are all good; with FLOW, under what flows.
precision highp usampler2D;

in vec2 v_unit;

uniform sampler2D u_projection;
uniform usampler2D u_states; // one texel a B-scan (ui/panels/state_texture.h)
uniform vec2 u_corner; // of what is shown, and its extent, as shares of the projection
uniform vec2 u_extent;
uniform vec3 u_hatch;
uniform float u_mark_width; // of the saturation mark, as a share of the width
uniform vec3 u_mark;
uniform vec3 u_seam;
#ifdef FLOW
uniform sampler2D u_flow; // ui/panels/flow_projection.h
uniform float u_dimmed;   // what is left of the grey under it
#endif

out vec4 o_colour;

void main() {
  vec2 place = u_corner + v_unit * u_extent;
  vec3 colour = vec3(texture(u_projection, place).r);
#ifdef FLOW
  vec4 flow = flow_from_above(texture(u_flow, place).rg);
  colour = flow.rgb + (1.0 - flow.a) * u_dimmed * colour;
#endif
#ifndef ALL_GOOD
  int count = textureSize(u_states, 0).x;
  int b_scan = clamp(int(place.y * float(count)), 0, count - 1);
  uint states = texelFetch(u_states, ivec2(b_scan, 0), 0).r;
  uint state = states & 15u;
#ifdef FLOW
  if ((states & 16u) != 0u && v_unit.x < u_mark_width)
    colour = untold_hatch(gl_FragCoord.xy, u_hatch);
#endif
  if (state == 2u && v_unit.x > 1.0 - u_mark_width)
    colour = u_mark;
  if (state == 0u)
    colour = hatch(gl_FragCoord.xy, u_hatch);
  if (state == 3u)
    colour = u_seam;
#endif
  o_colour = vec4(colour, 1.0);
}

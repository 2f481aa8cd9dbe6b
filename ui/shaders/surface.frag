// A surface, lit by a lamp at the eye, from whichever side it is seen: opaque, but for what covers other
// tissue, which is glass if it is to be seen through. Before this stand depth_tint.glsl and stops.glsl, and
// with flow its #defines and flow_look.glsl.
in vec3 v_normal;
in vec3 v_from_eye;
in vec3 v_texture;
in float v_depth;
in float v_cover;
in float v_place;

uniform vec4 u_cut_away; // from, to, on the fast and the slow axis
uniform vec3 u_colour;   // of tissue
uniform vec3 u_metal;    // of what is well above the window
uniform vec2 u_metallic; // from where to where in the window the one becomes the other
uniform bool u_by_depth;
uniform float u_ambient;
uniform vec2 u_cue;       // where the depth cue begins, and 1 / the length over which it falls
uniform float u_cue_loss; // what the far end of the box loses
uniform bool u_glass;     // only what covers is drawn, else only what does not
uniform float u_halvings; // of its opacity, face on

#ifdef WITH_FLOW
uniform sampler3D u_flow;
uniform float u_flow_reach; // share of the volume's depth

// The most that flows below a place, as far as the reach.
float flow_below(vec3 place) {
  float most = 0.0;
  for (int i = 0; i < FLOW_SAMPLES; ++i) {
    float below = u_flow_reach * float(i) / float(FLOW_SAMPLES - 1);
    most = max(most, textureLod(u_flow, place + vec3(below, 0.0, 0.0), 0.0).r);
  }
  return flow_weight(most);
}
#endif

layout(location = 0) out vec4 o_colour; // premultiplied
layout(location = 1) out float o_depth; // mm along the view

const float least_cover = 0.05;
const float glass_edge = 0.65; // opacity that stays, edge on

float glass_opacity(float facing) {
  float face = exp2(-u_halvings * v_cover);
  float edge = 1.0 - facing;
  return mix(face, mix(1.0, max(glass_edge, face), v_cover), edge * edge * edge);
}

void main() {
  bvec4 cut = bvec4(greaterThan(v_texture.yz, u_cut_away.xy), lessThan(v_texture.yz, u_cut_away.zw));
  if (v_depth >= stop_mm() || all(cut) || (v_cover > least_cover) != u_glass)
    discard;
  float slant = max(length(v_normal) * length(v_from_eye), 1e-6);
  float facing = abs(dot(v_normal, v_from_eye)) / slant;
  float light = mix(u_ambient, 1.0, facing);
  light *= 1.0 - u_cue_loss * clamp((v_depth - u_cue.x) * u_cue.y, 0.0, 1.0);
  vec3 colour = mix(u_colour, u_metal, smoothstep(u_metallic.x, u_metallic.y, v_place));
  if (u_by_depth)
    colour *= depth_tint(v_texture.x);
#ifdef WITH_FLOW
  if (!u_glass)
    colour = with_flow(colour, flow_below(v_texture));
#endif
  float opacity = u_glass ? glass_opacity(facing) : 1.0;
  o_colour = vec4(colour * light * opacity, opacity);
  o_depth = v_depth;
}

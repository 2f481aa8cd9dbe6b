// What every way of drawing the volume begins with: how a level looks. Before this stand the
// #defines of TransferProgram and, where it
// colours by depth, depth_tint.glsl, where it shows flow, flow_look.glsl.
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
precision highp usampler3D;

// From a sample of the volume, 0…1, to colour and the opacity of one reference step.
#ifdef TRANSFER_IS_WINDOW
uniform vec3 u_window; // scale and offset of the ramp, opacity at its top

vec4 look_up(float level) {
  float grey = clamp(level * u_window.x + u_window.y, 0.0, 1.0);
  return vec4(vec3(grey), grey * u_window.z);
}
#else
uniform sampler2D u_transfer;

vec4 transfer_entry(int i) {
  return texelFetch(u_transfer, ivec2(i & ((1 << TRANSFER_ROW_BITS) - 1), i >> TRANSFER_ROW_BITS), 0);
}

vec4 look_up(float level) {
  float entry = level * float(TRANSFER_LAST);
  int below = int(entry);
  return mix(transfer_entry(below), transfer_entry(min(below + 1, TRANSFER_LAST)),
             entry - float(below));
}
#endif

// By which a colour is multiplied at a share of the volume's depth.
#ifdef TRANSFER_BY_DEPTH
vec3 tint_at(float depth) { return depth_tint(depth); }
#else
vec3 tint_at(float depth) { return vec3(1.0); }
#endif

#ifdef WITH_FLOW
uniform sampler3D u_flow;
uniform float u_flow_opacity;

float flow_at(vec3 place) { return textureLod(u_flow, place, 0.0).r; }

// What flows in tissue.
vec4 add_flow(vec4 tissue, float flow) {
  float weight = flow_weight(flow);
  return vec4(with_flow(tissue.rgb, weight), max(tissue.a, weight * u_flow_opacity));
}
#endif

// Of so many reference steps; exactly 0 for nothing, which exp2 and log2 do not promise.
float opacity_over(float opacity, float steps) {
  // log2(0) is undefined: what is fully opaque keeps a transparency that no display can show.
  float alpha = 1.0 - exp2(steps * log2(max(1.0 - opacity, 1e-5)));
  return opacity > 0.0 ? alpha : 0.0;
}

uniform sampler2D u_dither_mask; // ui/dither/dither_mask.h

// 0…1, evenly spread over any small neighbourhood.
float dither(vec2 pixel) { return texelFetch(u_dither_mask, ivec2(pixel) & (DITHER_SIZE - 1), 0).r; }

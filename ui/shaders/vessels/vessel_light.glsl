// Colour, light from the eye, and depth cue of a vessel: ui/view/vessel_look.h. For fragment
// shaders.
precision highp float;
precision highp int;

uniform vec3 u_palette[PALETTE_SIZE];
uniform float u_ambient;
uniform vec3 u_cue; // where the fading begins (mm along the view), 1 / its length, its depth

// `facing` is 1 where the surface faces the eye and 0 at its outline.
vec4 lit_vessel(int colour, float facing, float distance_mm) {
  float share = clamp((distance_mm - u_cue.x) * u_cue.y, 0.0, 1.0);
  float light = (u_ambient + (1.0 - u_ambient) * facing) * (1.0 - u_cue.z * share);
  return vec4(u_palette[colour] * light, 1.0);
}

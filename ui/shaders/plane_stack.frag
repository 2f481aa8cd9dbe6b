// One sample of the volume, windowed where it is sampled; grey equals opacity (formula 1 of the OCT
// paper), and the opacity is corrected for the length of ray between two planes.
precision highp float;
precision highp sampler3D;

in vec3 v_texture;
in vec3 v_ray;
in vec3 v_step;

uniform sampler3D u_levels;
uniform vec2 u_window; // scale and offset of the ramp
uniform float u_opacity;
uniform float u_steps; // spacing of the planes in reference steps
uniform float u_first_depth; // above it lies what the background left behind, not tissue

out vec4 o_colour; // premultiplied

// −0.5…0.5, evenly spread over any small neighbourhood (interleaved gradient noise, J. Jimenez,
// "Next generation post processing in Call of Duty", SIGGRAPH 2014).
float dither(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))) - 0.5; }

void main() {
  // Each pixel's ray meets the planes a little earlier or later, all of them by the same length:
  // the contour lines that evenly cut steep surfaces show dissolve into fine grain.
  vec3 position = v_texture + v_step * dither(gl_FragCoord.xy);
  float grey = clamp(texture(u_levels, position).r * u_window.x + u_window.y, 0.0, 1.0);
  grey *= step(u_first_depth, position.x);
  // log2(0) is undefined: a fully opaque voxel keeps a transparency that no display can show.
  float transparency = max(1.0 - grey * u_opacity, 1e-5);
  float alpha = 1.0 - exp2(u_steps * length(v_ray) * log2(transparency));
  o_colour = vec4(vec3(grey * alpha), alpha);
}

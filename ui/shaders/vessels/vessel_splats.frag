// What the processor has drawn of a vessel tree, with its depth. Rows run from the top.
precision highp float;
precision highp int;
precision highp usampler2D;

in vec2 v_unit;

uniform usampler2D u_splats; // colour in red, the bits of the distance in green
uniform vec2 u_size; // of what is drawn
uniform int u_first_column;
uniform vec2 u_depth; // window depth = x + y / distance

out vec4 o_colour;

void main() {
  uvec2 splat = texelFetch(u_splats, ivec2(v_unit * u_size) + ivec2(u_first_column, 0), 0).rg;
  // No discard: without a vessel the distance is infinite, and only what is empty lets it pass.
  o_colour = vec4(uvec4(splat.r, splat.r >> 8, splat.r >> 16, splat.r >> 24) & 255u) / 255.0;
  gl_FragDepth = clamp(u_depth.x + u_depth.y / uintBitsToFloat(splat.g), 0.0, 1.0);
}

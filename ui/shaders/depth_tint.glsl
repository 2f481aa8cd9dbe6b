// Colour by depth (ui/transfer/depth_colours.h).
precision highp float;

uniform vec4 u_tint_red; // a cubic in the place each, lowest power first
uniform vec4 u_tint_green;
uniform vec4 u_tint_blue;
uniform vec2 u_tint_place; // scale and offset, from a share of the volume's depth

// What a grey is multiplied with.
vec3 depth_tint(float depth) {
  float place = clamp(depth * u_tint_place.x + u_tint_place.y, 0.0, 1.0);
  float square = place * place;
  vec4 powers = vec4(1.0, place, square, square * place);
  return vec3(dot(u_tint_red, powers), dot(u_tint_green, powers), dot(u_tint_blue, powers));
}

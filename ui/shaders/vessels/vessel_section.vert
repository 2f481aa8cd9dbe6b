// Vessels in a flat picture: one rectangle a segment, around all that it may cover. In pixels from
// the picture's top left corner; the third coordinate is the distance from the picture's plane.
layout(location = 0) in vec3 a_from;
layout(location = 1) in vec3 a_to;
layout(location = 2) in vec2 a_radii;
layout(location = 3) in vec2 a_shares;
layout(location = 4) in vec4 a_colour;

uniform vec2 u_size; // of the picture
uniform float u_half_line;

out vec2 v_place;
flat out vec3 v_from;
flat out vec3 v_ahead;
flat out vec2 v_radii;
flat out vec2 v_shares;
flat out vec3 v_colour;

void main() {
  vec2 ahead = a_to.xy - a_from.xy;
  float length_px = length(ahead);
  vec2 along = length_px > 1e-3 ? ahead / length_px : vec2(1.0, 0.0);
  float reach = max(a_radii.x, a_radii.y) + u_half_line + 1.0;
  vec2 corner = vec2((gl_VertexID & 1) == 0 ? -reach : length_px + reach,
                     (gl_VertexID & 2) == 0 ? -reach : reach);
  v_place = a_from.xy + corner.x * along + corner.y * vec2(-along.y, along.x);
  v_from = a_from;
  v_ahead = a_to - a_from;
  v_radii = a_radii;
  v_shares = a_shares;
  v_colour = a_colour.rgb;
  vec2 unit = v_place / u_size;
  gl_Position = vec4(unit.x * 2.0 - 1.0, 1.0 - unit.y * 2.0, 0.0, 1.0);
}

// The surface of a tube: rings of sectors around a segment's ends, and half balls. For vertex shaders.
// Places are in the eye's frame, mm: right, up, and along the view.
uniform vec3 u_middle; // of the view in pixels, and pixels for 1 mm at 1 mm along the view
uniform vec2 u_size;   // of the picture, in pixels
uniform vec2 u_depth;  // normalised device depth is x + y / distance

out vec3 v_normal;
out vec3 v_place;
flat out int v_colour; // in the palette

const float quarter_turn = 1.5707963268;

// What of a tube's surface is before the near plane, where its axis is not, is moved into it: no
// holes.
vec4 to_clip(vec3 place) {
  vec2 pixels = place.xy * u_middle.z + u_middle.xy * place.z;
  float depth = max(u_depth.x * place.z + u_depth.y, -0.999999 * place.z);
  return vec4(pixels / u_size * 2.0 - place.z, depth, place.z);
}

// Across the axis and the line of sight, so that sectors begin at the outline; any side where the
// axis points at the eye.
vec3 side_of(vec3 axis, vec3 place) {
  vec3 side = cross(axis, place);
  float size = length(side);
  return size > 1e-4 * length(place) ? side / size : normalize(cross(axis, vec3(0.0, 1.0, 0.1)));
}

// Out from the axis, at an angle from the side.
vec3 around(vec3 axis, vec3 side, float angle) { return cos(angle) * side + sin(angle) * cross(axis, side); }

// The quad around a segment on the screen, and what its pixels are computed from. For vertex shaders.
uniform vec2 u_size;  // of the picture, in pixels
uniform vec2 u_depth; // normalised device depth is x + y / distance

flat out vec4 v_axis;  // the start, and the end less the start, in pixels
flat out vec4 v_shape; // radius, its change to the end, 1 / distance, its change
flat out int v_colour; // in the palette

// Pixel centres on the outline must not be lost to the rounding of the rasteriser's corners.
const float padding = 1.0 / 64.0;

const vec4 nowhere = vec4(2.0, 2.0, 2.0, 1.0); // outside: GL clips it away

// Whether no pixel's centre lies in the box around the outline: most segments of a whole tree are so
// small, and GL is spared their triangles.
bool between_pixels(vec4 axis, vec4 shape) {
  vec2 finish = axis.xy + axis.zw;
  float end_radius = shape.x + shape.y;
  vec2 lower = min(axis.xy - shape.x, finish - end_radius) - (0.5 + padding);
  vec2 upper = max(axis.xy + shape.x, finish + end_radius) - (0.5 - padding);
  return any(lessThan(floor(upper), ceil(lower)));
}

// Corners are numbered in pairs, to either side of the axis, from the start to the end. The depth
// changes evenly between the round ends, in which it should not change at all: thin vessels are drawn
// so, and wider ones have their depth computed in each pixel.
vec4 quad_corner(vec4 axis, vec4 shape, int corner) {
  float length_px = length(axis.zw);
  vec2 forward = length_px > 0.0 ? axis.zw / length_px : vec2(1.0, 0.0);
  float reach = max(shape.x, shape.x + shape.y) + padding;
  bool at_end = corner >= 2;
  float ahead = at_end ? shape.x + shape.y + padding : -(shape.x + padding);
  vec2 side = vec2(-forward.y, forward.x) * ((corner & 1) == 0 ? -reach : reach);
  vec2 place = axis.xy + (at_end ? axis.zw : vec2(0.0)) + forward * ahead + side;
  float inverse = at_end ? shape.z + shape.w : shape.z;
  return vec4(place / u_size * 2.0 - 1.0, u_depth.x + u_depth.y * inverse, 1.0);
}

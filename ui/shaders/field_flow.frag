// What flows, over the microscope's picture, in the field of the scan.
in vec2 v_unit;

uniform sampler2D u_flow;
uniform vec2 u_corners[4]; // of the field, as v_unit (ui/layout/scan_field.h)

out vec4 o_colour;

float crossed(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// Where it lies in the field, whose corners bilinear interpolation joins: the inverse.
vec2 place_in_field(vec2 at) {
  vec2 e = u_corners[1] - u_corners[0];
  vec2 f = u_corners[3] - u_corners[0];
  vec2 g = u_corners[0] - u_corners[1] + u_corners[2] - u_corners[3];
  vec2 h = at - u_corners[0];
  float k2 = crossed(g, f);
  float k1 = crossed(e, f) + crossed(h, g);
  float k0 = crossed(h, e);
  float down = -k0 / k1; // of a parallelogram
  if (abs(k2) > 1e-4 * abs(k1)) {
    float root = sqrt(max(k1 * k1 - 4.0 * k0 * k2, 0.0));
    // The solution that is the parallelogram's where k2 vanishes, without cancellation.
    down = -2.0 * k0 / (k1 + (k1 < 0.0 ? -root : root));
  }
  vec2 along = e + down * g;
  vec2 from = h - down * f;
  float across = abs(along.x) > abs(along.y) ? from.x / along.x : from.y / along.y;
  return vec2(across, down);
}

void main() {
  vec2 place = place_in_field(v_unit);
  o_colour = vec4(0.0);
  if (all(greaterThanEqual(place, vec2(0.0))) && all(lessThanEqual(place, vec2(1.0))))
    o_colour = flow_from_above(texture(u_flow, place).rg);
}

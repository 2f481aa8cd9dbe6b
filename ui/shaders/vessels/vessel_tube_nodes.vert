// Tubes expanded by GL. After vessel_nodes.glsl, vessel_segment.glsl
// and vessel_tube.glsl.
//
// A ring is at right angles to the segment that ends in it. A segment that goes on with its parent's
// radius, nearly straight, begins with its parent's last ring, vertex by vertex; every other has a
// ring and a half ball of its own. It ends in a half ball unless another of its cluster goes on.
uniform float u_straight_px; // how much of a bend may show, in pixels
uniform highp usampler2D u_ends;

vec3 eye_place(vec4 placed) {
  return vec3((placed.xy - u_middle.xy * placed.z) / u_middle.z, placed.z);
}

struct Tube {
  vec3 start, end, axis, side;
  float start_radius, end_radius;
  // Of the first ring: the parent's, or the tube's own.
  vec3 start_axis, start_side;
  bool joined;
  bool cut; // at the end, by the near plane
};

// Whether no pixel's centre lies in the box around a tube between two places.
bool between_pixels(vec4 a, vec4 b) {
  vec2 start = a.xy / a.z;
  vec2 finish = b.xy / b.z;
  float reach = 1.1 * max(a.w, b.w) / min(a.z, b.z) + 0.05;
  return any(lessThan(floor(max(start, finish) + (reach - 0.5)), ceil(min(start, finish) - (reach + 0.5))));
}

// False where nothing is to be seen of it.
bool tube_of(uvec2 node, out Tube t) {
  uvec2 parent = packed_node(parent_of(node));
  vec4 a = place_of(parent);
  vec4 b = place_of(node);
  bool goes_on = a.w <= u_widest_start * b.w && a.z >= u_near;
  t.cut = b.z < u_near;
  a.w = min(a.w, u_widest_start * b.w);
  if (!cut_near(a, b))
    return false;
  a.w = max(a.w, least_radius(node) * a.z);
  b.w = max(b.w, least_radius(node) * b.z);
  if (between_pixels(a, b))
    return false;
  t.start = eye_place(a);
  t.end = eye_place(b);
  t.end_radius = b.w / u_middle.z;
  t.start_radius = a.w / u_middle.z;
  vec3 along = t.end - t.start;
  float size = length(along);
  t.axis = size > 0.0 ? along / size : vec3(1.0, 0.0, 0.0);
  t.side = side_of(t.axis, t.end);
  t.start_axis = t.axis;
  t.start_side = side_of(t.axis, t.start);
  t.joined = false;
  uvec2 before = packed_node(parent_of(parent));
  vec3 into = t.start - eye_place(place_of(before));
  float into_size = length(into);
  if (before != parent && into_size > 0.0 && goes_on) {
    into /= into_size;
    float bend_px = (1.0 - dot(into, t.axis)) * a.w / t.start.z;
    if (bend_px < u_straight_px && dot(into, t.axis) > 0.5) {
      t.joined = true;
      t.start_axis = into;
      t.start_side = side_of(into, t.start);
    }
  }
  return true;
}

void put(vec3 place, vec3 normal) {
  v_normal = normal;
  v_place = place;
  gl_Position = to_clip(place);
}

// The two rings of a segment: SECTORS vertices at the start, then as many at the end.
void put_body(Tube t, int vertex) {
  int sector = vertex % SECTORS;
  float step = 4.0 * quarter_turn / float(SECTORS);
  if (vertex < SECTORS) {
    // The ring's own first sector may be turned against that of the end: begin with the nearest one.
    vec3 other = cross(t.start_axis, t.start_side);
    float turn = atan(dot(t.side, other), dot(t.side, t.start_side));
    float first = floor(turn / step + 0.5);
    vec3 out_of = around(t.start_axis, t.start_side, step * (float(sector) + first));
    put(t.start + t.start_radius * out_of, out_of);
  } else {
    vec3 out_of = around(t.axis, t.side, step * float(sector));
    put(t.end + t.end_radius * out_of, out_of);
  }
}

// A half ball: rings from the equator to the pole, at the start (0) or the end.
void put_cap(Tube t, int at_end, int vertex) {
  float angle = 4.0 * quarter_turn / float(SECTORS) * float(vertex % SECTORS);
  float rise = quarter_turn * float(vertex / SECTORS) / float(CAP_RINGS);
  vec3 side = at_end == 1 ? t.side : t.start_side;
  float direction = at_end == 1 ? 1.0 : -1.0;
  vec3 out_of = cos(rise) * around(t.axis, side, direction * angle) + direction * sin(rise) * t.axis;
  put((at_end == 1 ? t.end : t.start) + (at_end == 1 ? t.end_radius : t.start_radius) * out_of, out_of);
}

bool is_passed(uint node) {
  uint word = texelFetch(u_ends, ivec2(int(node >> 5 & 2047u), int(node >> 16)), 0).x;
  return (word >> (node & 31u) & 1u) == 1u;
}

void main() {
  v_normal = vec3(0.0, 0.0, -1.0);
  v_place = vec3(0.0, 0.0, 1.0);
  v_colour = 0;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside: GL clips it away
  int segment = gl_VertexID / SEGMENT_VERTICES;
  int vertex = gl_VertexID % SEGMENT_VERTICES;
  if (uint(segment) >= i_nodes.z)
    return;
  uint local = i_nodes.y + uint(segment);
  uvec2 node = packed_node(local);
  v_colour = colour_of(node, COLOUR_BY_ORDER, PALETTE_OF_ORDERS);
  Tube t;
  if (!tube_of(node, t))
    return;
#ifdef CAPS
  int at_end = vertex / (SEGMENT_VERTICES / 2);
  if (at_end == 0 ? !t.joined : t.cut || !is_passed(i_nodes.x + local))
    put_cap(t, at_end, vertex % (SEGMENT_VERTICES / 2));
#else
  put_body(t, vertex);
#endif
}

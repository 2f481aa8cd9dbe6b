// Where a ray meets the round cone of a segment. For fragment shaders, after vessel_light.glsl and
// before vessel_quad.frag.
uniform vec3 u_middle; // of the view, in pixels, and pixels for 1 mm at 1 mm along the view
uniform vec2 u_depth;  // as vessel_quad.glsl
uniform float u_near;  // mm along the view

flat in vec4 v_axis;
flat in vec4 v_shape;

// Millimetres from a point of the ray (its distance, its pixel) to that at another.
vec3 to_place(vec2 pixel, float distance_mm, vec2 to_pixel, float to_distance_mm) {
  return vec3(((to_pixel - u_middle.xy) * to_distance_mm - (pixel - u_middle.xy) * distance_mm) /
                  u_middle.z,
              to_distance_mm - distance_mm);
}

// How far along the ray (from its origin, in units of its direction) it enters a ball; 0 where it
// misses, or only does so later.
float enter_ball(vec3 ray, vec3 middle, float radius) {
  float along = dot(ray, middle);
  float square = dot(ray, ray);
  float rest = along * along - square * (dot(middle, middle) - radius * radius);
  return rest < 0.0 ? 0.0 : min((along - sqrt(rest)) / square, 0.0);
}

// The cone is swept by balls at a + u e with radius r + u g, u in 0...1. The point s ray meets the
// ball that touches it where f(s, u) = |s ray - a - u e|^2 - (r + u g)^2 and its derivative by u are 0:
// u = (s ray.e + m) / k with m = g r - a.e, k = |e|^2 - g^2, which leaves a quadratic equation for s.
// What is met first, of the sides and the balls at the ends, is seen.
float enter_cone(vec3 ray, vec3 a, float r, vec3 e, float g, out bool on_sides) {
  on_sides = false;
  float first = min(enter_ball(ray, a, r), enter_ball(ray, a + e, r + g));
  float k = dot(e, e) - g * g;
  if (k <= 0.0) // one end lies within the ball of the other
    return first;
  float along = dot(ray, e);
  float m = g * r - dot(a, e);
  float square = dot(ray, ray) - along * along / k;
  float half_linear = -dot(ray, a) - along * m / k;
  float rest = half_linear * half_linear - square * (dot(a, a) - r * r - m * m / k);
  if (rest < 0.0 || abs(square) < 1e-9) // along the sides
    return first;
  vec2 s = (-half_linear + vec2(-1.0, 1.0) * sqrt(rest)) / square;
  vec2 u = (s * along + m) / k;
  float sides = 0.0;
  if (u.x >= 0.0 && u.x <= 1.0)
    sides = min(sides, s.x);
  if (u.y >= 0.0 && u.y <= 1.0)
    sides = min(sides, s.y);
  on_sides = sides < first;
  return min(first, sides);
}

// 1 + slope^2: see ui/vessels/scene/vessel_scene.h.
float stretch() {
  float slope =
      min(abs(v_shape.w) / v_shape.z * u_middle.z / max(length(v_axis.zw), 1e-6), STEEPEST_RISE);
  return 1.0 + slope * slope;
}

// Of a segment too thin for that: see ui/vessels/scene/vessel_scene.h. `height2`: the square of the
// round side's height in pixels; in_body: not in a round end.
float raised_distance(float distance_mm, float radius, float height2, bool in_body, float share) {
  if (radius < LEAST_RAISED)
    return distance_mm;
  float rise = share * sqrt(height2 * (in_body ? stretch() : 1.0));
  return distance_mm / (1.0 + rise / u_middle.z);
}

// Distance of the surface along the view; `distance_mm` is the axis's. Where the outline on the screen
// is a little wider than the cone, it is as good as the axis's. `height2` becomes that of its light.
float rounded_distance(float distance_mm, float radius, inout float height2, float along) {
  bool in_body = along >= 0.0 && along <= 1.0;
  if (max(v_shape.x, v_shape.x + v_shape.y) < LEAST_RELIEF)
    return raised_distance(distance_mm, radius, height2, in_body, 1.0);
  vec2 pixel = gl_FragCoord.xy;
  float distance_a = 1.0 / v_shape.z;
  float distance_b = 1.0 / (v_shape.z + v_shape.w);
  vec3 a = to_place(pixel, distance_mm, v_axis.xy, distance_a);
  vec3 b = to_place(pixel, distance_mm, v_axis.xy + v_axis.zw, distance_b);
  float radius_a = v_shape.x * distance_a / u_middle.z;
  float radius_b = (v_shape.x + v_shape.y) * distance_b / u_middle.z;
  vec3 ray = vec3((pixel - u_middle.xy) / u_middle.z, 1.0);
  bool on_sides;
  float nearer = enter_cone(ray, a, radius_a, b - a, radius_b - radius_a, on_sides);
  // Before the near plane there is a cut, in the order of the axes.
  float seen_mm = max(distance_mm + nearer, u_near + CUT_RELIEF * (distance_mm - u_near));
  float nearest = min(seen_mm, raised_distance(distance_mm, radius, height2, in_body, RELIEF_RISE));
  if (in_body)
    return nearest;
  if (on_sides) {
    vec2 across = gl_FragCoord.xy - v_axis.xy - along * v_axis.zw;
    height2 = max(radius * radius - dot(across, across), 0.0);
    return nearest;
  }
  bool at_far_end = along * v_shape.w < 0.0;
  if (at_far_end)
    height2 = min(height2 * stretch(), radius * radius);
  return nearest * (1.0 + (at_far_end ? 2.0 : 1.0) * END_SET_BACK);
}

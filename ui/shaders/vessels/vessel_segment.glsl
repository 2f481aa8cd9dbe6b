// From a segment's ends (place_of) to its outline on the screen: ui/vessels/scene/vessel_scene.h. Step by
// step what ui/vessels/scene/segment_projection.h does, so that both come to the same numbers.
uniform float u_near; // mm along the view
uniform float u_widest_start;

// What of the axis is before the near plane is cut off. False where nothing is left.
bool cut_near(inout vec4 a, inout vec4 b) {
  if (a.z < u_near && b.z < u_near)
    return false;
  if (a.z < u_near)
    a = a + (b - a) * ((u_near - a.z) * (1.0 / (b.z - a.z)));
  else if (b.z < u_near)
    b = b + (a - b) * ((u_near - b.z) * (1.0 / (a.z - b.z)));
  return true;
}

// The parent's and the node's place_of, and the node's least_radius. Axis and shape as in
// vessel_quad.glsl.
bool project_segment(vec4 a, vec4 b, float least_px, out vec4 axis, out vec4 shape) {
  a.w = min(a.w, u_widest_start * b.w);
  if (!cut_near(a, b))
    return false;
  float inverse_a = 1.0 / a.z;
  float inverse_b = 1.0 / b.z;
  vec2 start = a.xy * inverse_a;
  vec2 ahead = b.xy * inverse_b - start;
  float radius_a = max(a.w * inverse_a, least_px);
  float radius_b = max(b.w * inverse_b, least_px);
  shape = vec4(radius_a, radius_b - radius_a, inverse_a, inverse_b - inverse_a);
  if (ahead.x * ahead.x + ahead.y * ahead.y < 1e-8) { // seen from its end
    ahead = vec2(0.0);
    shape.x = max(radius_a, radius_b);
    shape.y = 0.0;
  }
  axis = vec4(start, ahead);
  return true;
}

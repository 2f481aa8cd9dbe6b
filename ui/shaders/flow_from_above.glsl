// What flows, seen from above (ui/panels/flow_projection.h): premultiplied. `flow`: its strength, and
// that times the depth.
vec4 flow_from_above(vec2 flow) {
  float weight = flow_weight(flow.r);
  return vec4(depth_tint(flow.g / max(flow.r, 0.004)), 1.0) * weight;
}

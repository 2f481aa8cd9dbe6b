// The nodes of a cluster (pipeline/vessels/clusters.h) and its place in the frame
// (ui/vessels/scene/vessel_frame.h). For vertex shaders that draw one cluster an instance.
precision highp usampler2DArray;

layout(location = 0) in vec4 i_across;
layout(location = 1) in vec4 i_up;
layout(location = 2) in vec4 i_along;
layout(location = 3) in vec2 i_radius; // smallest, and the step of its logarithm
layout(location = 4) in uvec4 i_nodes; // first node, references, segments, colour

uniform usampler2DArray u_nodes;

// As ui/vessels/scene/node_texture.h lays them out.
uvec2 packed_node(uint local) {
  uint i = i_nodes.x + local;
  return texelFetch(u_nodes, ivec3(int(i & 2047u), int(i >> 11 & 255u), int(i >> 19)), 0).xy;
}

uint parent_of(uvec2 node) { return node.y >> 20 & 255u; }

// Not GLSL's own, whose accuracy is the driver's choice: ui/vessels/scene/segment_projection.h has the
// same steps.
float power_of_two(float x) {
  float whole = floor(x + 0.5);
  float f = x - whole;
  float p = 0.0013333558;
  p = p * f + 0.0096181291;
  p = p * f + 0.0555041087;
  p = p * f + 0.2402265070;
  p = p * f + 0.6931471806;
  p = p * f + 1.0;
  return p * intBitsToFloat((int(whole) + 127) << 23);
}

// x and y: pixels times the distance along the view; z: that distance; w: the radius in pixels times
// the distance.
vec4 place_of(uvec2 node) {
  float x = float(node.x & 0x3FFFu);
  float y = float(node.x >> 14 & 0x3FFFu);
  float z = float(node.x >> 28 | (node.y & 0x3FFu) << 4);
  float radius = float(node.y >> 10 & 0x3FFu);
  return vec4(i_across.x + i_across.y * x + i_across.z * y + i_across.w * z,
              i_up.x + i_up.y * x + i_up.z * y + i_up.w * z,
              i_along.x + i_along.y * x + i_along.z * y + i_along.w * z,
              i_radius.x * power_of_two(i_radius.y * radius));
}

// In pixels, of the segment that ends at the node: least_radius_px of ui/vessels/scene/vessel_scene.h.
float least_radius(uvec2 node) { return node.y >> 28 >= LEAST_ORDER_KEPT_VISIBLE ? LEAST_RADIUS : 0.0; }

// In the palette.
int colour_of(uvec2 node, uint by_order, uint orders) {
  return int(i_nodes.w == by_order ? orders + (node.y >> 28) : i_nodes.w);
}

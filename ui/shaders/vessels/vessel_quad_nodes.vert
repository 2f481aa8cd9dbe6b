// Quads expanded by GL. After vessel_nodes.glsl, vessel_segment.glsl, vessel_quad.glsl.
void main() {
  int corner = gl_VertexID & 3;
  uint segment = uint(gl_VertexID / 4);
  v_axis = vec4(0.0);
  v_shape = vec4(1.0);
  v_colour = 0;
  gl_Position = nowhere;
  if (segment >= i_nodes.z)
    return;
  uvec2 node = packed_node(i_nodes.y + segment);
  vec4 parent = place_of(packed_node(parent_of(node)));
  if (!project_segment(parent, place_of(node), least_radius(node), v_axis, v_shape) ||
      between_pixels(v_axis, v_shape))
    return;
  v_colour = colour_of(node, COLOUR_BY_ORDER, PALETTE_OF_ORDERS);
  gl_Position = quad_corner(v_axis, v_shape, corner);
}

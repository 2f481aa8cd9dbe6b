// Quads expanded by the processor (ui/vessels/quads/quad_expander.h). After vessel_quad.glsl.
layout(location = 0) in vec4 a_axis;
layout(location = 1) in vec4 a_shape;
layout(location = 2) in uint a_colour;

void main() {
  v_axis = a_axis;
  v_shape = a_shape;
  v_colour = int(a_colour);
  gl_Position = quad_corner(a_axis, a_shape, gl_VertexID & 3);
}

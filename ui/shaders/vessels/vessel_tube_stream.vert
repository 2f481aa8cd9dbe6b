// Tubes expanded by the processor (ui/vessels/tubes/tube_expander.h). After vessel_tube.glsl.
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec4 a_normal; // and the colour's number

void main() {
  v_place = a_place;
  v_normal = a_normal.xyz;
  v_colour = int(a_normal.w);
  gl_Position = to_clip(a_place);
}

// One B-scan: the fast axis to the right, depth downwards, windowed by formula 1 of the OCT paper.
precision highp sampler3D;

in vec2 v_unit;

uniform sampler3D u_levels;
uniform vec2 u_window; // scale and offset of the ramp
uniform float u_slow;  // the B-scan's place on the slow axis, 0…1
uniform bool u_missing;
uniform vec3 u_hatch;

out vec4 o_colour;

void main() {
  float level = texture(u_levels, vec3(v_unit.y, v_unit.x, u_slow)).r;
  float grey = clamp(level * u_window.x + u_window.y, 0.0, 1.0);
  vec3 colour = u_missing ? hatch(gl_FragCoord.xy, u_hatch) : vec3(grey);
  o_colour = vec4(colour, 1.0);
}

// One sample of the volume; its opacity is corrected for the length of ray between two polygons.
in vec3 v_texture;
in vec3 v_ray;
in vec3 v_step;
in vec2 v_depth;

uniform sampler3D u_levels;
uniform float u_steps; // spacing of the polygons in reference steps
uniform float u_dither; // 1, or 0 for samples on the polygons themselves
uniform vec4 u_cut_away; // from, to, on the fast and the slow axis
uniform float u_first_depth; // above it lies what the background left behind, not tissue

out vec4 o_colour; // premultiplied

void main() {
  // Each pixel's ray meets the stack a little earlier or later, all of it by the same length: the
  // contour lines that evenly cut steep surfaces show dissolve into fine grain.
  float moved = u_dither * (dither(gl_FragCoord.xy) - 0.5);
  vec3 position = v_texture + v_step * moved;
  vec4 substance = look_up(textureLod(u_levels, position, 0.0).r);
  substance.rgb *= tint_at(position.x);
#ifdef WITH_FLOW
  substance = add_flow(substance, flow_at(position));
#endif
  substance.a *= step(u_first_depth, position.x);
  bvec4 cut = bvec4(greaterThan(position.yz, u_cut_away.xy), lessThan(position.yz, u_cut_away.zw));
  substance.a *= all(cut) ? 0.0 : 1.0;
  if (v_depth.x + v_depth.y * moved >= stop_mm())
    substance.a = 0.0;
  float alpha = opacity_over(substance.a, u_steps * length(v_ray));
  o_colour = vec4(substance.rgb * alpha, alpha);
}

// The B-scan on the face of a cut: opaque wherever there is tissue, clear where there is none, so
// that one sees into what is hollow. transfer.glsl precedes it.
in vec3 v_texture;

uniform sampler3D u_levels;

out vec4 o_colour; // premultiplied

const float opaque_from = 0.15; // in brightness

void main() {
  vec4 substance = look_up(textureLod(u_levels, v_texture, 0.0).r);
  float brightness = max(substance.r, max(substance.g, substance.b));
  float alpha = substance.a > 0.0 ? min(brightness / opaque_from, 1.0) : 0.0;
  vec3 colour = substance.rgb * tint_at(v_texture.x);
#ifdef WITH_FLOW
  float weight = flow_weight(flow_at(v_texture));
  colour = with_flow(colour, weight);
  alpha = max(alpha, weight);
#endif
  o_colour = vec4(colour * alpha, alpha);
}

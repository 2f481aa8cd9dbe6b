// A tube's surface, lit from the eye. After vessel_light.glsl.
in vec3 v_normal;
in vec3 v_place;
flat in int v_colour;

layout(location = 0) out vec4 o_colour;

void main() {
  float slant = length(v_normal) * length(v_place);
  o_colour = lit_vessel(v_colour, clamp(-dot(v_normal, v_place) / max(slant, 1e-12), 0.0, 1.0), v_place.z);
}

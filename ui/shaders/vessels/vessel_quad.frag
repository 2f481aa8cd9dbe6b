// A pixel of a segment's quad: ui/vessels/scene/vessel_scene.h. After vessel_light.glsl
// and, where ROUNDED, vessel_relief.glsl.
#ifndef ROUNDED
flat in vec4 v_axis;
flat in vec4 v_shape;
#endif
flat in int v_colour;

layout(location = 0) out vec4 o_colour;

void main() {
  vec2 from_start = gl_FragCoord.xy - v_axis.xy;
  float along = dot(from_start, v_axis.zw) / max(dot(v_axis.zw, v_axis.zw), 1e-12);
  float t = clamp(along, 0.0, 1.0);
  vec2 from_axis = from_start - t * v_axis.zw;
  float radius = v_shape.x + t * v_shape.y;
  float rest = radius * radius - dot(from_axis, from_axis);
  if (rest < 0.0)
    discard;
  float distance_mm = 1.0 / (v_shape.z + t * v_shape.w);
#ifdef ROUNDED
  distance_mm = rounded_distance(distance_mm, radius, rest, along);
  gl_FragDepth = 0.5 + 0.5 * (u_depth.x + u_depth.y / distance_mm);
#endif
  float off_axis =
      mix(MEAN_OFF_AXIS, 1.0 - rest / (radius * radius), clamp(radius - LEAST_SHADED, 0.0, 1.0));
  o_colour = lit_vessel(v_colour, sqrt(1.0 - off_axis), distance_mm);
}

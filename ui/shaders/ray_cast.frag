// One ray through the volume, front to back; the same samples as the processor's ray caster
// (ui/ray_caster/ray_packet_inl.h), whose comments hold here, too. Compiled with RAY_SHADED or
// RAY_MAXIMUM defined, or neither.
//
// Positions are cells along depth, fast and slow axis.
uniform sampler3D u_levels;
uniform usampler3D u_bricks; // DistancesAround's numbers
uniform bool u_leap;         // over empty bricks
uniform ivec3 u_brick_shift; // log2 of a brick's cells
uniform vec3 u_to_texture_scale;
uniform vec3 u_to_texture_offset;

uniform vec3 u_lower; // the box that is shown
uniform vec3 u_upper;
uniform bool u_is_cut;
uniform vec2 u_cut; // where its faces lie, fast and slow axis
uniform vec3 u_eye;
uniform vec3 u_forward; // cells per mm
uniform vec3 u_right;
uniform vec3 u_up;
uniform vec4 u_viewport;   // x, y, width, height
uniform vec2 u_pixel_size; // at distance 1
uniform float u_centre_shift; // of the picture's middle, likewise
uniform float u_near_mm;
uniform float u_step_mm;
uniform float u_steps; // of the step, in reference steps
uniform float u_opaque_transparency;
uniform float u_no_depth;

layout(location = 0) out vec4 o_colour; // premultiplied
layout(location = 1) out float o_depth; // mm along the view

const int samples_per_check = 4; // between two looks at the bricks

struct Ray {
  vec3 start;     // sample 0
  vec3 step;      // from one to the next
  float first_mm;
  float cosine; // between ray and view
  int end;      // behind the last sample
};

Ray make_ray() {
  vec2 pixel = gl_FragCoord.xy - u_viewport.xy;
  vec2 side = (pixel - 0.5 * u_viewport.zw) * u_pixel_size + vec2(u_centre_shift, 0.0);
  float reach = sqrt(dot(side, side) + 1.0);
  Ray ray;
  ray.cosine = 1.0 / reach;
  vec3 along = (side.x * u_right + side.y * u_up + u_forward) * ray.cosine;

  vec3 safe = mix(along, vec3(1e-12), lessThan(abs(along), vec3(1e-12)));
  vec3 at_lower = (u_lower - u_eye) / safe;
  vec3 at_upper = (u_upper - u_eye) / safe;
  vec3 enter = min(at_lower, at_upper);
  vec3 leave = max(at_lower, at_upper);
  float from = max(max(u_near_mm * reach, enter.x), max(enter.y, enter.z));
  if (u_is_cut) { // rays begin where they leave what is cut away
    vec2 reach_face = (u_cut - u_eye.yz) / safe.yz;
    reach_face = mix(vec2(1e9), reach_face, greaterThanEqual(reach_face, vec2(0.0)));
    from = max(from, min(reach_face.x, reach_face.y));
  }
  float to = min(min(stop_mm() * reach, leave.x), min(leave.y, leave.z));

  // Samples of all rays lie on the same shells around the eye, moved by each pixel's dither.
  float shift = dither(pixel);
  ray.first_mm = (ceil(from / u_step_mm - shift) + shift) * u_step_mm;
  ray.end = int(clamp(ceil((to - ray.first_mm) / u_step_mm), 0.0, 65536.0));
  ray.start = u_eye + along * ray.first_mm;
  ray.step = along * u_step_mm;
  return ray;
}

// A sample's number alone decides where it lies: leaping changes no picture.
vec3 position_of(Ray ray, int number) { return ray.start + float(number) * ray.step; }

float depth_of(Ray ray, int number) {
  return (ray.first_mm + float(number) * u_step_mm) * ray.cosine;
}

float level_at(vec3 position) {
  return textureLod(u_levels, position * u_to_texture_scale + u_to_texture_offset, 0.0).r;
}

#ifdef WITH_FLOW
float flow_in(vec3 position) { return flow_at(position * u_to_texture_scale + u_to_texture_offset); }
#endif

vec3 tint_in(vec3 position) {
  return tint_at(position.x * u_to_texture_scale.x + u_to_texture_offset.x);
}

// Distance to the nearest brick that is not empty in bits 0–7, highest level in 8–15.
int brick_at(vec3 position) {
  if (!u_leap)
    return 0xFF00;
  return int(texelFetch(u_bricks, ivec3(position) >> u_brick_shift, 0).r);
}

// Samples until the first outside of this brick and of `more` around it; at least one. What is left
// to rounding makes sure that no sample behind the side is missed.
int samples_to_leap(Ray ray, vec3 position, int more) {
  ivec3 brick = ivec3(position) >> u_brick_shift;
  vec3 lower_side = vec3((brick - more) << u_brick_shift);
  vec3 upper_side = vec3((brick + (more + 1)) << u_brick_shift);
  vec3 away = mix(position - lower_side, upper_side - position, greaterThan(ray.step, vec3(0.0)));
  vec3 samples = away / max(abs(ray.step), vec3(1e-9));
  return max(int(min(min(samples.x, min(samples.y, samples.z)), 65536.0) + 0.99), 1);
}

#ifdef RAY_SHADED
uniform bool u_lit;
uniform sampler3D u_light; // the texels of ui/ray_caster/light_volume.h
uniform vec3 u_to_light_scale;
uniform vec3 u_to_light_offset;
uniform vec3 u_lamp; // the direction to it
uniform vec3 u_mm;   // of one cell
uniform float u_least_power;
uniform float u_ambient;
uniform float u_level_light;
uniform float u_weak_slope;
uniform float u_open_light;
uniform float u_least_open;
uniform vec2 u_gleam;
uniform float u_cue_near_mm;
uniform float u_cue_per_mm;
uniform float u_depth_cue;

// By which what a ray shows, of that brightness, is weakened, if most of it lies at a sample and that
// share of it shines by itself.
float light_on(Ray ray, float number, float brightness, float unlit) {
  float depth = (ray.first_mm + number * u_step_mm) * ray.cosine;
  float fade = 1.0 - u_depth_cue * clamp((depth - u_cue_near_mm) * u_cue_per_mm, 0.0, 1.0);
  if (!u_lit)
    return fade;
  vec3 position = ray.start + number * ray.step;
  vec4 texel = textureLod(u_light, position * u_to_light_scale + u_to_light_offset, 0.0);
  vec3 slope = (texel.rgb * 255.0 - 128.0) / 127.0;
  float squared = dot(slope, slope);
  // Whichever of its sides is seen: the slope runs away from the eye, the lamp is on its side.
  float side = dot(slope, ray.step * u_mm) < 0.0 ? -1.0 : 1.0;
  float half_lit = 0.5 - 0.5 * side * dot(slope, u_lamp) * inversesqrt(max(squared, 1e-12));
  float lit = mix(u_ambient, 1.0, half_lit * half_lit);
  float strength = squared / (squared + u_weak_slope * u_weak_slope);
  float open = clamp(u_open_light - texel.a, u_least_open, 1.0);
  float shade = mix(u_level_light, lit, strength) * open;
  return mix(shade, 1.0, max(smoothstep(u_gleam.x, u_gleam.y, brightness), unlit)) * fade;
}
#endif

#ifdef RAY_MAXIMUM
// What two samples of the same level may differ by, a sixteenth of a level.
const float level_margin = 1.0 / 4080.0;

#ifdef WITH_FLOW
// How opaque all is that flows along the ray, and where half of that was reached.
float gather_flow(Ray ray, out int half_at) {
  float transparency = 1.0;
  half_at = 0;
  for (int next = 0; next < ray.end; ++next) {
    float weight = flow_weight(flow_in(position_of(ray, next)));
    float opacity = opacity_over(weight * u_flow_opacity, u_steps);
    half_at = opacity > 0.0 && transparency >= 0.5 ? next : half_at;
    transparency -= transparency * opacity;
  }
  return 1.0 - transparency;
}
#endif

// The highest level along the ray, as opaque as it is bright.
void trace(Ray ray) {
  float highest = 0.0;
  int highest_at = 0;
  int next = 0;
  while (next < ray.end) {
    vec3 position = position_of(ray, next);
    int brick = brick_at(position);
    int distance = brick & 0xFF;
    if (distance > 0 || float(brick >> 8) / 255.0 + level_margin < highest) {
      next += samples_to_leap(ray, position, max(distance - 1, 0));
      continue;
    }
    for (int stop = min(next + samples_per_check, ray.end); next < stop; ++next) {
      float level = level_at(position_of(ray, next));
      highest_at = level > highest ? next : highest_at;
      highest = max(highest, level);
    }
  }
  vec4 substance = look_up(highest);
#ifdef WITH_FLOW
  if (substance.a <= 0.0)
    substance.rgb = vec3(0.0);
  substance.rgb *= tint_in(position_of(ray, highest_at));
  int flow_half_at = 0;
  float weight = gather_flow(ray, flow_half_at);
  if (substance.a <= 0.0 && weight <= 0.0)
    return;
  if (weight > 0.5 || substance.a <= 0.0)
    highest_at = flow_half_at;
  substance.rgb = with_flow(substance.rgb, weight);
#else
  if (substance.a <= 0.0)
    return;
  substance.rgb *= tint_in(position_of(ray, highest_at));
#endif
  o_colour = vec4(substance.rgb, max(substance.r, max(substance.g, substance.b)));
  o_depth = depth_of(ray, highest_at);
}
#else
void trace(Ray ray) {
  vec3 light = vec3(0.0);
  float transparency = 1.0;
  int half_opaque = 0; // the sample that made it so
#ifdef RAY_SHADED
  // Where most of the light comes from; of two layers, the stronger has it.
  float powers = 0.0;
  float numbers = 0.0;
  float flow = 0.0; // the share of the opacity that flows
#endif
  int next = 0;
  while (next < ray.end && transparency >= u_opaque_transparency) {
    vec3 position = position_of(ray, next);
    int distance = brick_at(position) & 0xFF;
    if (distance > 0) {
      next += samples_to_leap(ray, position, distance - 1);
      continue;
    }
    for (int stop = min(next + samples_per_check, ray.end);
         next < stop && transparency >= u_opaque_transparency; ++next) {
      position = position_of(ray, next);
      vec4 substance = look_up(level_at(position));
#ifdef WITH_FLOW
      substance.rgb *= tint_in(position);
      float flow_here = flow_in(position);
      substance = add_flow(substance, flow_here);
#endif
      half_opaque = transparency >= 0.5 ? next : half_opaque;
      float weight = transparency * opacity_over(substance.a, u_steps);
      transparency -= weight;
#ifdef RAY_SHADED
      float power = weight * weight * weight * weight;
      powers += power;
      numbers += power * float(next);
#ifdef WITH_FLOW
      flow += weight * flow_weight(flow_here);
#endif
#endif
#ifdef WITH_FLOW
      light += weight * substance.rgb;
#else
      light += weight * substance.rgb * tint_in(position);
#endif
    }
  }
  if (transparency < 0.5)
    o_depth = depth_of(ray, half_opaque);
#ifdef RAY_SHADED
  float strongest = max(light.r, max(light.g, light.b));
  float brightness = min(strongest / max(1.0 - transparency, 1e-6), 1.0);
  light *= light_on(ray, numbers / max(powers, u_least_power), brightness,
                    flow / max(1.0 - transparency, 1e-6));
#endif
  // What an ended ray would have met counts as of the same colour.
  if (transparency < u_opaque_transparency) {
    light /= 1.0 - transparency;
    transparency = 0.0;
  }
  o_colour = vec4(light, 1.0 - transparency);
}
#endif

void main() {
  o_colour = vec4(0.0);
  o_depth = u_no_depth;
  Ray ray = make_ray();
  if (ray.end > 0)
    trace(ray);
}

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
uniform vec3 u_eye;
uniform vec3 u_forward; // cells per mm
uniform vec3 u_right;
uniform vec3 u_up;
uniform vec3 u_mm;         // of one cell
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
  vec3 direction; // mm per mm
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
  ray.direction = along * u_mm;

  vec3 safe = mix(along, vec3(1e-12), lessThan(abs(along), vec3(1e-12)));
  vec3 at_lower = (u_lower - u_eye) / safe;
  vec3 at_upper = (u_upper - u_eye) / safe;
  vec3 enter = min(at_lower, at_upper);
  vec3 leave = max(at_lower, at_upper);
  float from = max(max(u_near_mm * reach, enter.x), max(enter.y, enter.z));
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
uniform vec3 u_gradient_cells;
uniform float u_ambient;
uniform float u_weak_gradient; // sum of four differences of samples
uniform float u_cue_near_mm;
uniform float u_cue_per_mm;
uniform float u_depth_cue;

// Light from the eye; the gradient comes from four samples at the corners of a tetrahedron.
float shade(Ray ray, vec3 position) {
  vec3 more = min(position + u_gradient_cells, u_upper);
  vec3 less = max(position - u_gradient_cells, u_lower);
  float v0 = level_at(vec3(more.x, less.yz));
  float v1 = level_at(vec3(less.x, more.y, less.z));
  float v2 = level_at(vec3(less.xy, more.z));
  float v3 = level_at(more);
  vec3 gradient = vec3(v0 + v3 - v1 - v2, v1 + v3 - v0 - v2, v2 + v3 - v0 - v1);
  float squared = dot(gradient, gradient);
  float strength = squared / (squared + u_weak_gradient * u_weak_gradient);
  float facing = abs(dot(gradient, ray.direction)) * inversesqrt(max(squared, 1e-12));
  return 1.0 + strength * (u_ambient + (1.0 - u_ambient) * facing - 1.0);
}

float fade_with_depth(Ray ray, int number) {
  return 1.0 - u_depth_cue * clamp((depth_of(ray, number) - u_cue_near_mm) * u_cue_per_mm, 0.0, 1.0);
}
#endif

#ifdef RAY_MAXIMUM
// What two samples of the same level may differ by, a sixteenth of a level.
const float level_margin = 1.0 / 4080.0;

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
  if (substance.a <= 0.0)
    return;
  o_colour = vec4(substance.rgb, max(substance.r, max(substance.g, substance.b)));
  o_depth = depth_of(ray, highest_at);
}
#else
void trace(Ray ray) {
  vec3 light = vec3(0.0);
  float transparency = 1.0;
  int half_opaque = 0; // the sample that made it so
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
      half_opaque = transparency >= 0.5 ? next : half_opaque;
      float weight = transparency * opacity_over(substance.a, u_steps);
      transparency -= weight;
#ifdef RAY_SHADED
      if (weight > 0.0)
        weight *= shade(ray, position) * fade_with_depth(ray, next);
#endif
      light += weight * substance.rgb;
    }
  }
  if (transparency < 0.5)
    o_depth = depth_of(ray, half_opaque);
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

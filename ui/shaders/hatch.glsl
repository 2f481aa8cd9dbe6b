// What stands where no data came: never black, never tissue. `place` has the picture's lower left
// corner, from which the stripes count, so that both eyes of a stereo display see the same ones, and
// the pixels between two of them.
vec3 hatch(vec2 pixel, vec3 place) {
  vec2 from = pixel - place.xy;
  float stripe = step(0.5, fract((from.x + from.y) / place.z));
  return mix(vec3(0.055, 0.067, 0.082), vec3(0.29, 0.22, 0.10), stripe);
}

// What stands at the border where flow could not be told: the other way round, and of no colour.
vec3 untold_hatch(vec2 pixel, vec3 place) {
  vec2 from = pixel - place.xy;
  float stripe = step(0.5, fract((from.x - from.y) / place.z));
  return mix(vec3(0.055, 0.067, 0.082), vec3(0.52, 0.56, 0.60), stripe);
}

// What stands where no data came: never black, never tissue.
vec3 hatch(vec2 pixel, float pitch) {
  float stripe = step(0.5, fract((pixel.x + pixel.y) / pitch));
  return mix(vec3(0.055, 0.067, 0.082), vec3(0.29, 0.22, 0.10), stripe);
}

// A vessel in a flat picture: a line where the picture's plane cuts its wall, and a tint over all
// of it that fades with the distance from the plane. The depth test joins the segments: of what the
// plane cuts, the one in whose inside a pixel lies deepest stays, so that no line runs through a
// vessel; before it come stronger ones, and after all of that what is not cut, the nearest first.
precision highp float;

in vec2 v_place;
flat in vec3 v_from;
flat in vec3 v_ahead;
flat in vec2 v_radii;
flat in vec2 v_shares;
flat in vec3 v_colour;

uniform float u_half_line;
uniform float u_reach; // pixels from the wall to where nothing is left
uniform float u_line_opacity;
uniform float u_opacity;

out vec4 o_colour; // premultiplied

const float tint_opacity = 0.22;
const float thinnest = 0.4;  // of the strength, however thin the vessel
const float sideways = 0.1;  // weight of distances from the plane where a vessel is seen at a slant
const float steepest = 0.15; // of the plane to the wall: where they touch, a line gets no wider
const float deepest = 512.0; // pixels inside that still count

// Where along its axis the segment is nearest to the pixel, 0 to 1; `weight` of the third axis.
float nearest(float weight) {
  vec3 scale = vec3(1.0, 1.0, weight);
  vec3 ahead = v_ahead * scale;
  vec3 to_pixel = (vec3(v_place, 0.0) - v_from) * scale;
  return clamp(dot(to_pixel, ahead) / max(dot(ahead, ahead), 1e-9), 0.0, 1.0);
}

void main() {
  // The wall, in space; how far it is along the plane.
  float t = nearest(1.0);
  vec3 from_axis = vec3(v_place, 0.0) - (v_from + t * v_ahead);
  float distance_px = max(length(from_axis), 1e-4);
  float slope = max(length(from_axis.xy) / distance_px, steepest);
  float beyond = (distance_px - mix(v_radii.x, v_radii.y, t)) / slope;
  float line = clamp(u_half_line + 0.5 - abs(beyond), 0.0, 1.0);

  // What lies over or under the pixel.
  float s = nearest(sideways);
  vec3 centre = v_from + s * v_ahead;
  float radius = mix(v_radii.x, v_radii.y, s);
  float aside = length(v_place - centre.xy);
  float gap = max(abs(centre.z) - sqrt(max(radius * radius - aside * aside, 0.0)), 0.0);
  float off = clamp(gap / max(u_reach, 1e-3), 0.0, 1.0);
  float tint = clamp(radius + 0.5 - aside, 0.0, 1.0) * (1.0 - off);

  float strength = u_opacity * mix(v_shares.x, v_shares.y, s) *
                   clamp(radius / u_half_line, thinnest, 1.0);
  float drawn = u_line_opacity * line;
  float alpha = strength * (drawn + (1.0 - drawn) * tint_opacity * tint);
  if (alpha < 0.002)
    discard;
  bool cut = line > 0.0 || beyond < 0.0;
  float tier = floor(3.99 * (1.0 - max(v_shares.x, v_shares.y))); // by vessel, not by pixel
  gl_FragDepth = cut ? 0.1 * (tier + clamp(0.5 + beyond / (2.0 * deepest), 0.0, 0.99))
                     : 0.5 + 0.49 * off;
  o_colour = vec4(v_colour * alpha, alpha);
}

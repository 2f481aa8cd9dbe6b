// The average of 3 × 3 pixels, by 1, 2, 1 each way (ui/dither/soften.h), stored from the bottom as they are. A pixel
// with a vessel is averaged only with such, one without only with such.
precision highp float;
precision highp sampler2D;

uniform sampler2D u_picture;
uniform bool u_stopped;
uniform sampler2D u_vessels; // the vessels' own picture: transparent where there is none

out vec4 o_colour;

bool has_vessel(ivec2 pixel) { return u_stopped && texelFetch(u_vessels, pixel, 0).a > 0.0; }

void main() {
  ivec2 last = textureSize(u_picture, 0) - 1;
  ivec2 here = ivec2(gl_FragCoord.xy);
  bool stopped = has_vessel(here);
  vec4 sum = vec4(0.0);
  float count = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      ivec2 pixel = clamp(here + ivec2(x, y), ivec2(0), last);
      if (has_vessel(pixel) != stopped)
        continue;
      float weight = float((2 - abs(x)) * (2 - abs(y)));
      sum += weight * texelFetch(u_picture, pixel, 0);
      count += weight;
    }
  o_colour = sum / count;
}

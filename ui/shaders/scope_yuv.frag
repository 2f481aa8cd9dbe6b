// Luma and chroma as cameras send them to RGB, one fragment a pixel, rows from the top: BT.601 in
// its limited range (ITU-R BT.601-7, section 2.5), black at 16, white at 235.
precision highp float;

uniform highp sampler2D u_luma;   // NV12: one texel a pixel. YUYV: one a pair, Y U Y V
uniform highp sampler2D u_chroma; // NV12: one texel for four pixels
uniform bool u_packed;            // YUYV

out vec4 o_colour;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float luma;
  vec2 chroma;
  if (u_packed) {
    vec4 pair = texelFetch(u_luma, ivec2(at.x / 2, at.y), 0);
    luma = at.x % 2 == 0 ? pair.r : pair.b;
    chroma = pair.ga;
  } else {
    luma = texelFetch(u_luma, at, 0).r;
    chroma = texelFetch(u_chroma, at / 2, 0).rg;
  }
  float y = (luma * 255.0 - 16.0) / 219.0;
  vec2 c = (chroma * 255.0 - 128.0) / 224.0;
  o_colour = vec4(y + 1.402 * c.y, y - 0.344136 * c.x - 0.714136 * c.y, y + 1.772 * c.x, 1.0);
}

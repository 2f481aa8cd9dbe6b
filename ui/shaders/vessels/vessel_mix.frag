// The volume alone, where there is a vessel: to be mixed with the one that ends there. Both are
// stored from the bottom, in one size.
precision highp float;
precision highp sampler2D;

uniform sampler2D u_picture;
uniform sampler2D u_vessels;

out vec4 o_colour;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(u_vessels, pixel, 0).a == 0.0)
    discard; // the same in both, to the bit
  o_colour = texelFetch(u_picture, pixel, 0);
}

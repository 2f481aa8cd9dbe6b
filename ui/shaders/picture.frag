// A picture as it is; its rows run from the top.
precision highp float;

in vec2 v_unit;

uniform sampler2D u_picture;
uniform float u_brightness;

out vec4 o_colour;

void main() { o_colour = vec4(texture(u_picture, v_unit).rgb * u_brightness, 1.0); }

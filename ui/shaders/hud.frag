precision mediump float;

in highp vec2 v_texture;
in vec4 v_colour;

uniform sampler2D u_glyphs; // coverage

out vec4 o_colour;

void main() { o_colour = vec4(v_colour.rgb, v_colour.a * texture(u_glyphs, v_texture).r); }

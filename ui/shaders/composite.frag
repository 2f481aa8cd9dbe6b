// Premultiplied volume picture, drawn by GL and so stored from the bottom.
precision highp float;

in vec2 v_unit;

uniform sampler2D u_picture;

out vec4 o_colour;

void main() { o_colour = texture(u_picture, vec2(v_unit.x, 1.0 - v_unit.y)); }

// Premultiplied volume picture from the processor; its rows run from the top.
precision highp float;

in vec2 v_unit;

uniform sampler2D u_picture;

out vec4 o_colour;

void main() { o_colour = texture(u_picture, v_unit); }

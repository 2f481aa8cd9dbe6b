// The bits of a depth texture's numbers, which GLES lets nobody read otherwise.
precision highp float;
precision highp int;
precision highp sampler2D;

uniform sampler2D u_depth;

layout(location = 0) out uint o_bits;

void main() { o_bits = floatBitsToUint(texelFetch(u_depth, ivec2(gl_FragCoord.xy), 0).x); }

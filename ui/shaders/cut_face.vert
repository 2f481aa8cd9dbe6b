// A corner of a face that a cut leaves (ui/scene/cut_face.h).
uniform mat4 u_view_projection;
uniform vec3 u_extents;  // of the box, mm
uniform vec4 u_face;     // where it begins and ends, fast and slow axis each, as shares of their lengths
uniform float u_highest; // likewise along the depth: above it lies what the background left behind

out vec3 v_texture; // depth, fast axis, slow axis

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  v_texture = vec3(mix(u_highest, 1.0, corner.y), mix(u_face.xy, u_face.zw, corner.x));
  vec3 unit = vec3(v_texture.y - 0.5, 0.5 - v_texture.x, v_texture.z - 0.5);
  gl_Position = u_view_projection * vec4(unit * u_extents, 1.0);
}

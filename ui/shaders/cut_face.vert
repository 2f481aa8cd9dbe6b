// A corner of the face that a cut leaves (ui/scene/cut_face.h).
uniform mat4 u_view_projection;
uniform vec3 u_extents;  // of the box, mm
uniform float u_face;    // on the slow axis, as a share of its length
uniform float u_highest; // likewise along the depth: above it lies what the background left behind

out vec3 v_texture; // depth, fast axis, slow axis

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  v_texture = vec3(mix(u_highest, 1.0, corner.y), corner.x, u_face);
  vec3 unit = vec3(v_texture.y - 0.5, 0.5 - v_texture.x, u_face - 0.5);
  gl_Position = u_view_projection * vec4(unit * u_extents, 1.0);
}

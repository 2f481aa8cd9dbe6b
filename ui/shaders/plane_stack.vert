// One vertex of a plane's polygon, in mm around the centre of the box (ui/camera.h has the axes).
layout(location = 0) in vec3 a_position;

uniform mat4 u_view_projection;
uniform vec3 u_eye;
uniform vec3 u_forward;
uniform vec3 u_extents; // of the box, mm
uniform float u_spacing; // of the planes, mm

out vec3 v_texture; // depth, fast axis, slow axis
out vec3 v_ray;     // from the eye to the plane, per unit of distance along the view
out vec3 v_step;    // of v_texture, from this plane to the next along the ray

void main() {
  gl_Position = u_view_projection * vec4(a_position, 1.0);
  vec3 unit = a_position / u_extents;
  v_texture = vec3(0.5 - unit.y, 0.5 + unit.x, 0.5 + unit.z);
  vec3 ray = a_position - u_eye;
  v_ray = ray / dot(ray, u_forward);
  v_step = vec3(-v_ray.y, v_ray.xz) * u_spacing / u_extents.yxz;
}

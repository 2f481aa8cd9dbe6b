// One vertex of a polygon of a stack, in mm around the centre of the box (ui/view/camera.h has the axes).
layout(location = 0) in vec3 a_position;

uniform mat4 u_view_projection;
uniform vec3 u_eye;
uniform vec3 u_forward; // of the view
uniform vec3 u_normal; // of the polygons, away from the eye
uniform vec3 u_extents; // of the box, mm
uniform float u_spacing; // of the polygons, mm

out vec3 v_texture; // depth, fast axis, slow axis
out vec3 v_ray;     // from the eye to the polygon, per unit of distance along the normal
out vec3 v_step;    // of v_texture, from this polygon to the next along the ray
out vec2 v_depth;   // along the view, mm: of the polygon, and on to the next along the ray

void main() {
  gl_Position = u_view_projection * vec4(a_position, 1.0);
  vec3 unit = a_position / u_extents;
  v_texture = vec3(0.5 - unit.y, 0.5 + unit.x, 0.5 + unit.z);
  vec3 ray = a_position - u_eye;
  v_ray = ray / dot(ray, u_normal);
  v_depth = vec2(dot(ray, u_forward), dot(v_ray, u_forward) * u_spacing);
  v_step = vec3(-v_ray.y, v_ray.xz) * u_spacing / u_extents.yxz;
}

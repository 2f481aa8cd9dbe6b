// Where vessels end the rays of the volume (ui/depth_mask/depth_mask.h). The picture of the
// vessels is as large as the target.
precision highp float;
precision highp sampler2D;

uniform bool u_stopped;
uniform sampler2D u_stops; // window depths
uniform vec2 u_stop_depth; // distance = x / (y − depth)

// Along the view, in mm.
float stop_mm() {
  const float never = 1e30;
  if (!u_stopped)
    return never;
  float depth = texelFetch(u_stops, ivec2(gl_FragCoord.xy), 0).r;
  return depth < 1.0 ? u_stop_depth.x / (u_stop_depth.y - depth) : never;
}

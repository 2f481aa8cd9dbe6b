// How flow looks: ui/transfer/flow_look.h.
precision highp float;

uniform vec2 u_flow_seen; // from where on, and from where on in full
uniform vec3 u_flow_wall;
uniform vec3 u_flow_middle;

float flow_weight(float flow) { return smoothstep(u_flow_seen.x, u_flow_seen.y, flow); }

vec3 with_flow(vec3 tissue, float weight) {
  return mix(tissue, mix(u_flow_wall, u_flow_middle, weight), weight);
}

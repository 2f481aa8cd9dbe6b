// Volumes as they come from the pipeline with flow.
#pragma once

#include "pipeline/volume/flow_scale.h"
#include "pipeline/volume/volume.h"
#include "tests/support/vessels/flow_scene.h"

namespace octascope::tests {

// 3 × 3 × 1.8 mm.
inline constexpr pipeline::VolumeGeometry live_flow_geometry{128, 100, 40, 14, 30, 75, 1.38};

// With three vessels of 120 µm radius, apart from each other, 5.2 mm long together; levels as they are.
inline void add_live_flow(pipeline::Volume& volume) {
  pipeline::VesselTree tree;
  add_tube(tree, {0, 900, 800}, {3000, 1100, 900}, 120);
  add_tube(tree, {1500, 2000, 400}, {1500, 2900, 1200}, 120);
  add_tube(tree, {300, 2300, 1300}, {1290, 2300, 1300}, 120);
  volume.add_flow();
  const std::vector<float> flow = flow_of(tree, volume.geometry);
  std::ranges::transform(flow, volume.flow.begin(), pipeline::quantise_flow);
  std::ranges::fill(volume.flow_states, pipeline::FlowState::told);
}

inline pipeline::Volume live_flow() {
  pipeline::Volume volume{live_flow_geometry};
  add_live_flow(volume);
  return volume;
}

// As of a patient who moves: everything flows.
inline pipeline::Volume moved_flow() {
  pipeline::Volume volume{live_flow_geometry};
  volume.add_flow();
  std::ranges::fill(volume.flow, std::uint8_t{200});
  std::ranges::fill(volume.flow_states, pipeline::FlowState::told);
  return volume;
}

} // namespace octascope::tests

// How flow looks (pipeline/volume/flow_scale.h), the same in every picture of it. Pure.
//
// A sample's flow, interpolated between voxels' counts, has a weight: the share in which it is seen as
// flowing. Its colour goes from the tissue's to that of flow by the weight, and its opacity, over one
// reference step, is at least the weight's share of flow's own:
//
//   weight  = smoothstep(flow_seen_from, flow_seen_full, count / 255)
//   colour  = mix(tissue, flow_colour(weight), weight)
//   opacity = max(tissue's, weight · flow_opacity(view's))
//
// So what flows is seen in dim tissue, too, and is veiled by what lies before it. The maximum along a ray
// has no before: all that flows along it adds up to the opacity that is its weight. A vessel's wall, where
// the weight falls, is deep red, and its middle a warm orange, which is lighter and yellower: who is blind
// to red or green sees it, too.
#pragma once

#include <algorithm>
#include <cstdint>

#include "ui/transfer/transfer_table.h"

namespace octascope::ui {

// Of a count of 255.
inline constexpr float flow_seen_from = 0.5F; // where the classification calls it flowing
inline constexpr float flow_seen_full = 0.8F;

// Voxels with fewer counts show nothing, nor does what is interpolated between them alone.
inline constexpr std::uint8_t first_seen_flow = 128;
static_assert((first_seen_flow - 1) / 255.0F < flow_seen_from);

inline constexpr TransferTable::Colour flow_wall{0.50F, 0.05F, 0.04F};
inline constexpr TransferTable::Colour flow_middle{0.98F, 0.50F, 0.16F};

// `flow`: counts / 255.
constexpr float flow_weight(float flow) {
  const float share =
      std::clamp((flow - flow_seen_from) / (flow_seen_full - flow_seen_from), 0.0F, 1.0F);
  return share * share * (3 - 2 * share);
}

constexpr TransferTable::Colour mixed(const TransferTable::Colour& a,
                                      const TransferTable::Colour& b, float share) {
  return {a.red + share * (b.red - a.red), a.green + share * (b.green - a.green),
          a.blue + share * (b.blue - a.blue)};
}

// Of what flows with that weight, nothing of the tissue in it.
constexpr TransferTable::Colour flow_colour(float weight) {
  return mixed(flow_wall, flow_middle, weight);
}

constexpr TransferTable::Colour with_flow(const TransferTable::Colour& tissue, float weight) {
  return mixed(tissue, flow_colour(weight), weight);
}

// Over one reference step, of what flows for certain: that of a voxel at the top of the window.
constexpr float flow_opacity(float view_opacity) {
  return view_opacity;
}

// While flow is drawn, tissue is only that share as opaque as the view says, so that vessels below its
// surface are seen. They are as opaque as the view says.
inline constexpr float tissue_beside_flow = 0.15F;

} // namespace octascope::ui

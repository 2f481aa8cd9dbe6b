// Trees to flow volumes as an angiogram shows them, the truth being known.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/vessels/tree.h"
#include "pipeline/volume/volume_geometry.h"

namespace octascope::tests {

// The voxels of a usual scan: 3.5 µm, 10 µm, 37.5 µm.
inline pipeline::VolumeGeometry oct_geometry(int depths, int a_scans, int b_scans) {
  return {.depths = depths,
          .a_scans = a_scans,
          .b_scans = b_scans,
          .depth_spacing_um = 3.5,
          .a_spacing_um = 10,
          .b_spacing_um = 37.5};
}

inline std::uint32_t add_node(pipeline::VesselTree& tree, const pipeline::Point& at_um,
                              double radius_um, std::uint32_t parent) {
  tree.positions_mm.push_back({static_cast<float>(at_um[0] * 1e-3),
                               static_cast<float>(at_um[1] * 1e-3),
                               static_cast<float>(at_um[2] * 1e-3)});
  tree.radii_mm.push_back(static_cast<float>(radius_um * 1e-3));
  tree.parents.push_back(parent);
  tree.orders.push_back(0);
  tree.branches.push_back(pipeline::VesselBranch::unknown);
  return static_cast<std::uint32_t>(tree.nodes() - 1);
}

// Appends the line of curve(0) to curve(1); `parent` is what its first point is joined to. Returns its
// last node.
template <class Curve>
std::uint32_t add_line(pipeline::VesselTree& tree, const Curve& curve, double radius_um,
                       std::uint32_t parent = pipeline::no_parent, int pieces = 60) {
  for (int i = parent == pipeline::no_parent ? 0 : 1; i <= pieces; ++i)
    parent = add_node(tree, curve(static_cast<double>(i) / pieces), radius_um, parent);
  return parent;
}

inline std::uint32_t add_tube(pipeline::VesselTree& tree, const pipeline::Point& from_um,
                              const pipeline::Point& to_um, double radius_um,
                              std::uint32_t parent = pipeline::no_parent) {
  return add_line(
      tree,
      [&](double t) {
        return pipeline::Point{from_um[0] + t * (to_um[0] - from_um[0]),
                               from_um[1] + t * (to_um[1] - from_um[1]),
                               from_um[2] + t * (to_um[2] - from_um[2])};
      },
      radius_um, parent, 8);
}

// Which of 24 places in a voxel (2 in depth, 2 across A-scans, 6 across B-scans) are within a vessel,
// as a bit each, [b][a][z].
inline std::vector<std::uint32_t> places_within(const pipeline::VesselTree& tree,
                                                const pipeline::VolumeGeometry& g) {
  std::vector<std::uint32_t> within(g.voxels());
  const std::array<double, 3> spacing{g.a_spacing_um * 1e-3, g.b_spacing_um * 1e-3,
                                      g.depth_spacing_um * 1e-3};
  const std::array<int, 3> counts{g.a_scans, g.b_scans, g.depths};
  constexpr std::array<int, 3> parts{2, 6, 2};
  for (std::size_t node = 0; node < tree.nodes(); ++node) {
    if (tree.parents[node] == pipeline::no_parent)
      continue;
    const auto& a = tree.positions_mm[tree.parents[node]];
    const auto& b = tree.positions_mm[node];
    const double r1 = static_cast<double>(tree.radii_mm[node]);
    const double r0 = static_cast<double>(
        pipeline::segment_start_radius(tree.radii_mm[tree.parents[node]], tree.radii_mm[node]));
    const double reach = std::max(r0, r1);
    std::array<int, 3> from{};
    std::array<int, 3> to{};
    std::array<double, 3> axis{};
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto low = static_cast<double>(std::min(a[k], b[k])) - reach;
      const auto high = static_cast<double>(std::max(a[k], b[k])) + reach;
      from[k] = std::max(0, static_cast<int>(std::floor(low / spacing[k])));
      to[k] = std::min(counts[k] - 1, static_cast<int>(std::floor(high / spacing[k])));
      axis[k] = static_cast<double>(b[k]) - static_cast<double>(a[k]);
      square += axis[k] * axis[k];
    }
    for (int y = from[1]; y <= to[1]; ++y)
      for (int x = from[0]; x <= to[0]; ++x)
        for (int z = from[2]; z <= to[2]; ++z) {
          std::uint32_t& bits =
              within[(static_cast<std::size_t>(y) * static_cast<std::size_t>(g.a_scans) +
                      static_cast<std::size_t>(x)) *
                         static_cast<std::size_t>(g.depths) +
                     static_cast<std::size_t>(z)];
          for (int part = 0; part < 24; ++part) {
            const std::array<int, 3> at{x, y, z};
            const std::array<int, 3> place{part % 2, part / 4, part / 2 % 2};
            std::array<double, 3> d{};
            double along = 0;
            for (std::size_t k = 0; k < 3; ++k) {
              d[k] = (at[k] + (place[k] + 0.5) / parts[k]) * spacing[k] - static_cast<double>(a[k]);
              along += d[k] * axis[k];
            }
            const double t = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
            const double r = r0 + t * (r1 - r0);
            double apart = 0;
            for (std::size_t k = 0; k < 3; ++k)
              apart += (d[k] - t * axis[k]) * (d[k] - t * axis[k]);
            if (apart <= r * r)
              bits |= std::uint32_t{1} << part;
          }
        }
  }
  return within;
}

struct FlowFlaws {
  float flow = 0.85F;    // of what flows
  float spread = 0;      // standard deviation of it
  double salt = 0;       // share of static voxels that are called flowing
  int clusters = 0;      // of them, false balls of 2 to 4 A-scans of radius
  double holes = 0;      // share of flowing voxels that are called static
  double unknown = 0;    // share of all voxels that are NaN
  int missing_every = 0; // each so many-th B-scan is NaN; 0: none
  float tail = 0;        // flow right below a vessel
  double tail_um = 100;  // depth over which it falls to a third
  std::uint64_t seed = 1;
};

inline std::vector<float> flow_of(const pipeline::VesselTree& tree,
                                  const pipeline::VolumeGeometry& g, const FlowFlaws& flaws = {}) {
  const std::vector<std::uint32_t> within = places_within(tree, g);
  std::mt19937_64 random{flaws.seed};
  std::uniform_real_distribution<double> share{0, 1};
  std::normal_distribution<float> normal;
  std::vector<float> flow(within.size());
  const auto depths = static_cast<std::size_t>(g.depths);
  const auto fall = static_cast<float>(std::exp(-g.depth_spacing_um / flaws.tail_um));
  for (std::size_t i = 0; i < flow.size(); ++i) {
    const float cover = static_cast<float>(std::popcount(within[i])) / 24;
    flow[i] = cover * flaws.flow;
    if (flaws.spread > 0 && cover > 0)
      flow[i] += cover * flaws.spread * normal(random);
    if (cover > 0 ? share(random) < flaws.holes : false)
      flow[i] = 0;
  }
  if (flaws.tail > 0)
    for (std::size_t line = 0; line < flow.size(); line += depths) {
      float tail = 0;
      for (std::size_t z = 0; z < depths; ++z) {
        const float cover = static_cast<float>(std::popcount(within[line + z])) / 24;
        tail = std::max(tail * fall, cover * flaws.tail);
        flow[line + z] = std::max(flow[line + z], tail);
      }
    }
  for (int i = 0; i < flaws.clusters; ++i) {
    const double radius = (2 + 2 * share(random)) * g.a_spacing_um;
    const pipeline::Point at{share(random) * g.a_mm() * 1e3, share(random) * g.b_mm() * 1e3,
                             share(random) * g.depth_mm() * 1e3};
    for (int z = 0; z < g.depths; ++z)
      for (int y = 0; y < g.b_scans; ++y) {
        const double dz = (z + 0.5) * g.depth_spacing_um - at[2];
        const double dy = (y + 0.5) * g.b_spacing_um - at[1];
        if (dz * dz + dy * dy > radius * radius)
          continue;
        for (int x = 0; x < g.a_scans; ++x)
          if (const double dx = (x + 0.5) * g.a_spacing_um - at[0];
              dx * dx + dy * dy + dz * dz <= radius * radius)
            flow[(static_cast<std::size_t>(y) * static_cast<std::size_t>(g.a_scans) +
                  static_cast<std::size_t>(x)) *
                     depths +
                 static_cast<std::size_t>(z)] = flaws.flow;
      }
  }
  for (std::size_t i = 0; i < flow.size(); ++i) {
    if (flaws.salt > 0 && within[i] == 0 && share(random) < flaws.salt)
      flow[i] = static_cast<float>(0.5 + 0.5 * share(random));
    if (flaws.unknown > 0 && share(random) < flaws.unknown)
      flow[i] = std::numeric_limits<float>::quiet_NaN();
    const auto b = static_cast<int>(i / g.b_scan_voxels());
    if (flaws.missing_every > 0 && b % flaws.missing_every == flaws.missing_every / 2)
      flow[i] = std::numeric_limits<float>::quiet_NaN();
    flow[i] = std::isnan(flow[i]) ? flow[i] : std::clamp(flow[i], 0.0F, 1.0F);
  }
  return flow;
}

} // namespace octascope::tests

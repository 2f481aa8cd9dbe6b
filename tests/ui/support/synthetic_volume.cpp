#include "tests/ui/support/synthetic_volume.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/volume/flow_scale.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::tests {

namespace {

// A hash of the position, so that neither order nor library changes the speckle.
double uniform_noise(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t h = x * 0x9E3779B1U ^ y * 0x85EBCA77U ^ z * 0xC2B2AE3DU;
  h = (h ^ (h >> 15U)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12U)) * 0x297A2D39U;
  h ^= h >> 15U;
  return (h + 0.5) / 4294967296.0;
}

struct PointMm {
  double a, b, z;
};

double surface_mm(double a, double b) {
  return 0.45 + 0.12 * std::sin(2.1 * a + 0.4) + 0.10 * std::cos(1.7 * b) + 0.08 * a;
}

// Distance to the axis of a vessel that winds along the slow axis.
double vessel_distance(const PointMm& p, double a_start, double drift, double below) {
  const double axis_a = a_start + drift * p.b + 0.18 * std::sin(2.4 * p.b + a_start);
  const double axis_z = surface_mm(axis_a, p.b) + below;
  return std::hypot(p.a - axis_a, p.z - axis_z);
}

// Mean level in decibels.
double level_at(const PointMm& p) {
  const double sphere = std::hypot(p.a - 2.2, p.b - 0.9, p.z - (surface_mm(2.2, 0.9) - 0.16));
  if (sphere < 0.2)
    return sphere > 0.17 ? 46 : 30;
  const double below = p.z - surface_mm(p.a, p.b);
  if (below < 0)
    return 2;
  for (const auto& [start, drift, depth, radius] :
       {std::array{0.5, 0.25, 0.25, 0.09}, std::array{1.5, -0.12, 0.33, 0.12},
        std::array{2.6, -0.4, 0.22, 0.07}}) {
    const double d = vessel_distance(p, start, drift, depth);
    if (d < radius)
      return d > radius - 0.025 ? 42 : 8;
  }
  if (below < 0.03)
    return 45;
  if (below < 0.14)
    return 30 - 20 * below;
  if (below < 0.17)
    return 38;
  return std::max(4.0, 33 - 24 * (below - 0.17));
}

// 0 to 1; the walls are a ramp of 20 µm.
double flow_at(const PointMm& p) {
  constexpr std::array<std::array<double, 4>, 8> vessels{{{0.5, 0.25, 0.25, 0.07},
                                                          {1.5, -0.12, 0.33, 0.1},
                                                          {2.6, -0.4, 0.22, 0.05},
                                                          {0.2, 0.6, 0.5, 0.02},
                                                          {0.9, 0.5, 0.45, 0.03},
                                                          {1.9, -0.55, 0.55, 0.02},
                                                          {2.9, -0.7, 0.6, 0.03},
                                                          {1.2, 0.35, 0.15, 0.02}}};
  double flow = 0;
  for (const auto& [start, drift, depth, radius] : vessels)
    flow = std::max(flow, (radius - vessel_distance(p, start, drift, depth)) / 0.02 + 0.5);
  return std::min(flow, 1.0);
}

} // namespace

pipeline::Volume perfused_volume(const pipeline::VolumeGeometry& g) {
  pipeline::Volume volume = tissue_volume(g);
  volume.add_flow();
  auto voxel = volume.flow.begin();
  for (int b = 0; b < g.b_scans; ++b)
    for (int a = 0; a < g.a_scans; ++a)
      for (int z = 0; z < g.depths; ++z, ++voxel) {
        const PointMm p{(a + 0.5) * g.a_spacing_um * 1e-3, (b + 0.5) * g.b_spacing_um * 1e-3,
                        (z + 0.5) * g.depth_spacing_um * 1e-3};
        const double noise =
            0.2 * uniform_noise(static_cast<std::uint32_t>(z), static_cast<std::uint32_t>(a),
                                static_cast<std::uint32_t>(b));
        if (p.z > surface_mm(p.a, p.b))
          *voxel = pipeline::quantise_flow(static_cast<float>(std::max(noise, flow_at(p))));
      }
  std::ranges::fill(volume.flow_states, pipeline::FlowState::told);
  return volume;
}

pipeline::Volume uniform_volume(const pipeline::VolumeGeometry& geometry, std::uint8_t count) {
  pipeline::Volume volume{geometry};
  std::fill(volume.levels.begin(), volume.levels.end(), count);
  std::fill(volume.b_scan_states.begin(), volume.b_scan_states.end(), pipeline::BScanState::good);
  return volume;
}

void add_tubes(pipeline::Volume& volume, float phase) {
  volume.add_flow();
  const pipeline::VolumeGeometry& g = volume.geometry;
  const auto share = [](int i, int n) {
    return (static_cast<float>(i) + 0.5F) / static_cast<float>(n);
  };
  const auto wall = static_cast<float>(2 * g.a_mm() / g.a_scans);
  const auto a_mm = static_cast<float>(g.a_mm());
  const auto b_mm = static_cast<float>(g.b_mm());
  const auto depth_mm = static_cast<float>(g.depth_mm());
  const float radius = 0.04F * a_mm;
  for (int b = 0; b < g.b_scans; ++b) {
    const float along = share(b, g.b_scans);
    const auto flow = volume.b_scan_flow(b);
    volume.flow_states[static_cast<std::size_t>(b)] = pipeline::FlowState::told;
    for (int a = 0; a < g.a_scans; ++a)
      for (int z = 0; z < g.depths; ++z) {
        const float x = share(a, g.a_scans);
        const float y = share(z, g.depths);
        const auto away = [&](float dx, float dy) { return std::hypot(dx * a_mm, dy * depth_mm); };
        const float first = away(x - 0.3F - 0.15F * std::sin(6 * along + phase), y - 0.35F);
        const float second = away(x - 0.7F, y - 0.5F - 0.15F * std::cos(5 * along + phase));
        const float across =
            std::hypot((along - 0.5F - 0.1F * std::sin(phase)) * b_mm, (y - 0.45F) * depth_mm);
        const float inside = radius - std::min({first, second, across});
        flow[static_cast<std::size_t>(a * g.depths + z)] =
            pipeline::quantise_flow(0.5F + inside / wall);
      }
  }
  const int left_out = g.b_scans / 4;
  std::ranges::fill(volume.b_scan_flow(left_out), pipeline::flow_untold);
  volume.flow_states[static_cast<std::size_t>(left_out)] = pipeline::FlowState::left_out;
}

ui::LevelShares level_shares(const pipeline::Volume& volume) {
  ui::LevelShares shares{};
  for (const std::uint8_t level : volume.levels)
    shares[level / 2U] += 1 / static_cast<float>(volume.levels.size());
  return shares;
}

pipeline::Volume tissue_volume(const pipeline::VolumeGeometry& g) {
  pipeline::Volume volume = uniform_volume(g, 0);
  auto voxel = volume.levels.begin();
  for (int b = 0; b < g.b_scans; ++b)
    for (int a = 0; a < g.a_scans; ++a)
      for (int z = 0; z < g.depths; ++z) {
        const PointMm p{(a + 0.5) * g.a_spacing_um * 1e-3, (b + 0.5) * g.b_spacing_um * 1e-3,
                        (z + 0.5) * g.depth_spacing_um * 1e-3};
        const double noise =
            uniform_noise(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                          static_cast<std::uint32_t>(z));
        // Intensity of fully developed speckle is exponentially distributed.
        const double speckle_db = 10 * std::log10(-std::log(noise));
        *voxel++ = pipeline::quantise_level(
            static_cast<float>(level_at(p) + 0.6 * std::max(speckle_db, -20.0)));
      }
  return volume;
}

pipeline::Volume ball_volume(int n, double radius_mm) {
  pipeline::Volume volume = uniform_volume({n, n, n, 25, 25, 25}, 0);
  for (int b = 0; b < n; ++b)
    for (int a = 0; a < n; ++a)
      for (int z = 0; z < n; ++z) {
        const auto mm = [n](int i) { return (i + 0.5 - n / 2.0) * 0.025; };
        const double distance = std::sqrt(mm(a) * mm(a) + mm(b) * mm(b) + mm(z) * mm(z));
        const double share = std::clamp((radius_mm - distance) / 0.05 + 0.5, 0.0, 1.0);
        volume.b_scan(b)[static_cast<std::size_t>(a * n + z)] =
            static_cast<std::uint8_t>(std::lround(200 * share));
      }
  return volume;
}

} // namespace octascope::tests

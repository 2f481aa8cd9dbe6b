#include "sim/phantoms/phantom_perfused.h"

#include <array>
#include <numbers>

#include "sim/spectrometer/noise.h"

namespace octascope::sim {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

struct Root {
  VesselPoint at;
  float heading_rad;
  float radius_mm;
  float thinnest_mm; // of its branches
};

// From all sides, at several depths: an arteriole's branches end as capillaries, a venule's as the
// small ones that it gathers from.
constexpr float venule_mm = 0.008F;
constexpr std::array<Root, 6> roots{{
    {{-1.55F, -0.7F, 0.40F}, 0.25F, PerfusedTissue::widest_mm, PerfusedTissue::capillary_mm},
    {{1.55F, 0.6F, 0.30F}, pi - 0.1F, 0.030F, PerfusedTissue::capillary_mm},
    {{0.3F, -1.55F, 0.22F}, pi / 2 - 0.3F, 0.021F, PerfusedTissue::capillary_mm},
    {{-1.55F, 0.9F, 0.65F}, -0.2F, PerfusedTissue::widest_mm, venule_mm},
    {{1.55F, -0.8F, 0.55F}, pi + 0.15F, 0.036F, venule_mm},
    {{-0.4F, 1.55F, 0.45F}, -pi / 2 + 0.2F, 0.032F, venule_mm},
}};

} // namespace

PerfusedTissue::PerfusedTissue(std::uint64_t seed) : seed_(hash(seed, 0x9e4f)) {
  constexpr float length_mm = 0.6F;
  std::vector<VesselSegment> segments;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const auto& [at, heading_rad, radius_mm, thinnest_mm] = roots[i];
    const auto tree = grow_vessels(
        at, heading_rad, radius_mm, length_mm, hash(seed_, i),
        {.smallest_part = thinnest_mm / radius_mm, .steepness = 0.5F, .lowest_mm = 0.9F});
    segments.insert(segments.end(), tree.begin(), tree.end());
  }
  bed_ = VesselBed(std::move(segments));
}

float PerfusedTissue::top_mm(float x_mm, float y_mm) const {
  return 0.32F + 0.02F * (x_mm * x_mm + y_mm * y_mm) +
         0.04F * smooth_noise(seed_ + 1, x_mm * 0.9F, y_mm * 0.9F) +
         0.012F * smooth_noise(seed_ + 2, x_mm * 4, y_mm * 4);
}

void PerfusedTissue::fill(Column& column, double /*phase*/, float x_mm, float y_mm) const {
  column.clear();
  const float top = top_mm(x_mm, y_mm);
  column.add(Layer{top, top + 0.05F, 12.5F, 1});
  column.add(Layer{top + 0.05F, 20, 10.5F, 1.2F, Grain::granules, 0.4F});
  column.add(Surface{top, 40, 1});
  bed_.fill(column, x_mm, y_mm, top, 20,
            Layer{.backscatter_counts = 14, .attenuation_per_mm = 2.5F});
}

std::vector<VesselSegment> PerfusedTissue::vessels() const {
  std::vector<VesselSegment> placed;
  append_below(placed, bed_,
               [&](float x_mm, float y_mm) -> std::optional<float> { return top_mm(x_mm, y_mm); });
  return placed;
}

Look PerfusedTissue::look(float x_mm, float y_mm) const {
  constexpr Rgb tissue{0.88F, 0.62F, 0.54F};
  constexpr Rgb red{0.68F, 0.18F, 0.16F};
  const float blotch = 0.5F + 0.5F * rough_noise(seed_ + 3, x_mm * 1.2F, y_mm * 1.2F);
  return {mix(mix(tissue, red, 0.15F * blotch), red, 0.85F * bed_.visibility(x_mm, y_mm, 0.5F)),
          -top_mm(x_mm, y_mm), 0.3F};
}

} // namespace octascope::sim

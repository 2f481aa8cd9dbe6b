#include "sim/phantoms/phantom_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/spectrometer/spectrometer_simd.h"

namespace octascope::sim {
namespace {

constexpr int grain_step = 4; // depth bins between the places where a grain is worked out

// Cells of the grains' noise, in mm.
constexpr float lamella_mm = 0.035F;
constexpr float lamella_length_mm = 0.6F;
constexpr float granule_mm = 0.07F;

OCTASCOPE_VECTOR_LOOP
void multiply_speckle(const float* amplitude, const float* first, float first_weight,
                      const float* second, float second_weight, float* scatterers, std::size_t n) {
  for (std::size_t d = 0; d < n; ++d) {
    scatterers[2 * d] =
        amplitude[d] * (first_weight * first[2 * d] + second_weight * second[2 * d]);
    scatterers[2 * d + 1] =
        amplitude[d] * (first_weight * first[2 * d + 1] + second_weight * second[2 * d + 1]);
  }
}

// A surface's phase follows its depth by half a wavelength (840 nm, in water): neighbouring A-scans
// of a slope differ in it at random, as they do in nature, so that their mean does not keep a
// ghost of the surface as background.
constexpr double phase_rad_per_mm = 4 * std::numbers::pi * 1.35 / 0.84e-3;

} // namespace

ProfileMaker::ProfileMaker(const pipeline::VolumeGeometry& geometry, std::uint64_t seed)
    : seed_(seed), depths_(geometry.depths),
      depth_spacing_mm_(static_cast<float>(geometry.depth_spacing_um * 1e-3)),
      a_spacing_mm_(static_cast<float>(geometry.a_spacing_um * 1e-3)),
      b_spacing_mm_(static_cast<float>(geometry.b_spacing_um * 1e-3)),
      gaussian_(hash(seed, 0x5bec), 17, 2 * static_cast<std::size_t>(geometry.depths)) {}

ProfileMaker::Profile ProfileMaker::make_profile() const {
  const auto n = static_cast<std::size_t>(depths_);
  Profile profile;
  profile.scatterers.resize(n);
  profile.surfaces.reserve(Column::most_surfaces);
  profile.amplitude.resize(n);
  profile.transmission.resize(n);
  profile.flowing.resize(n);
  return profile;
}

void ProfileMaker::fill(Profile& profile, const Column& column, float x_mm, float y_mm,
                        std::uint64_t visit) const {
  std::ranges::fill(profile.amplitude, 0.0F);
  std::ranges::fill(profile.transmission, 1.0F);
  std::ranges::fill(profile.flowing, std::uint8_t{0});
  for (const Layer& layer : column.layers())
    paint(profile, layer, x_mm, y_mm);
  attenuate(profile, column.surfaces());
  speckle(profile, x_mm, y_mm, visit);
}

// Bin d reaches from d − 1/2 to d + 1/2; those that a layer covers in part get that part of it.
void ProfileMaker::paint(Profile& profile, const Layer& layer, float x_mm, float y_mm) const {
  const float top = std::max(layer.top_mm / depth_spacing_mm_, 0.0F);
  const float bottom =
      std::min(layer.bottom_mm / depth_spacing_mm_, static_cast<float>(depths_) - 1.5F);
  const int first = static_cast<int>(std::floor(top + 0.5F));
  const int last = static_cast<int>(std::floor(bottom + 0.5F));
  if (bottom <= top)
    return;
  const float kept = std::exp(-layer.attenuation_per_mm * depth_spacing_mm_);
  const auto cover = [&](int depth, float level) {
    const float middle = static_cast<float>(depth);
    const float part = std::min(bottom, middle + 0.5F) - std::max(top, middle - 0.5F);
    float& amplitude = profile.amplitude[static_cast<std::size_t>(depth)];
    amplitude += (level - amplitude) * part;
  };
  float level = layer.backscatter_counts * grain(layer, x_mm, y_mm, first);
  for (int depth = first; depth <= last; depth += grain_step) {
    const float next = layer.backscatter_counts * grain(layer, x_mm, y_mm, depth + grain_step);
    const float slope = (next - level) / grain_step;
    for (int d = depth; d < std::min(depth + grain_step, last + 1); ++d, level += slope) {
      if (d > first && d < last)
        profile.amplitude[static_cast<std::size_t>(d)] = level;
      else
        cover(d, level);
    }
    level = next;
  }
  const auto begin = static_cast<std::ptrdiff_t>(first);
  const auto end = static_cast<std::ptrdiff_t>(last) + 1;
  std::fill(profile.transmission.begin() + begin, profile.transmission.begin() + end, kept);
  std::fill(profile.flowing.begin() + begin, profile.flowing.begin() + end,
            static_cast<std::uint8_t>(layer.flowing));
}

float ProfileMaker::grain(const Layer& layer, float x_mm, float y_mm, int depth) const {
  const float z_mm = static_cast<float>(depth) * depth_spacing_mm_;
  switch (layer.grain) {
  case Grain::none: return 1;
  case Grain::lamellae:
    return 1 + layer.grain_strength * smooth_noise(seed_ + 1, x_mm / lamella_length_mm,
                                                   y_mm / lamella_length_mm,
                                                   (z_mm - layer.top_mm) / lamella_mm);
  case Grain::granules:
    return 1 + layer.grain_strength *
                   smooth_noise(seed_ + 2, x_mm / granule_mm, y_mm / granule_mm, z_mm / granule_mm);
  }
  return 1;
}

void ProfileMaker::attenuate(Profile& profile, std::span<const Surface> surfaces) const {
  profile.surfaces.clear();
  for (const Surface& surface : surfaces) {
    const int depth = static_cast<int>(surface.depth_mm / depth_spacing_mm_ + 0.5F);
    if (surface.depth_mm >= 0 && depth < depths_)
      profile.transmission[static_cast<std::size_t>(depth)] *= surface.transmission;
  }
  float left = 1;
  for (std::size_t d = 0; d < profile.amplitude.size(); ++d) {
    const float here = left;
    profile.amplitude[d] *= left;
    left *= profile.transmission[d];
    profile.transmission[d] = here; // from now on: the light that arrives
  }
  for (const Surface& surface : surfaces) {
    const float depth = surface.depth_mm / depth_spacing_mm_;
    const auto bin = static_cast<std::size_t>(depth + 0.5F);
    if (surface.depth_mm >= 0 && bin < profile.amplitude.size())
      profile.surfaces.push_back(
          {static_cast<double>(depth),
           static_cast<double>(surface.amplitude_counts * profile.transmission[bin]),
           phase_rad_per_mm * static_cast<double>(surface.depth_mm)});
  }
}

void ProfileMaker::speckle(Profile& profile, float x_mm, float y_mm, std::uint64_t visit) const {
  const std::size_t n = profile.amplitude.size();
  // Half a spacing off, so that A-scans lie between two places of the speckle and share them.
  const float a = x_mm / a_spacing_mm_ + 0.5F;
  const float lower = std::floor(a);
  const auto a_key = static_cast<std::uint64_t>(static_cast<std::int64_t>(lower));
  const auto b_key = static_cast<std::uint64_t>(std::llround(y_mm / b_spacing_mm_ * 2));
  // √½, as the table's real and imaginary parts have variance 1 each.
  const float angle = (a - lower) * 1.57079633F;
  const float first_weight = std::cos(angle) * 0.70710678F;
  const float second_weight = std::sin(angle) * 0.70710678F;
  auto* out = reinterpret_cast<float*>(profile.scatterers.data());
  multiply_speckle(profile.amplitude.data(), gaussian_.run(hash(seed_, b_key, a_key), 2 * n).data(),
                   first_weight, gaussian_.run(hash(seed_, b_key, a_key + 1), 2 * n).data(),
                   second_weight, out, n);
  const float* moved = gaussian_.run(hash(seed_ + 3, b_key, a_key, visit), 2 * n).data();
  for (std::size_t d = 0; d < n; ++d)
    if (profile.flowing[d] != 0)
      profile.scatterers[d] = std::complex<float>(moved[2 * d], moved[2 * d + 1]) *
                              (profile.amplitude[d] * 0.70710678F);
}

} // namespace octascope::sim

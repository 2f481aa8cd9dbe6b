#include "sim/phantoms/phantom_profile.h"

#include <algorithm>
#include <cmath>

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

// √½: the Gaussian table's real and imaginary parts have variance 1 each.
constexpr float unit_power = 0.70710678F;

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
  profile.flowing_share.resize(n);
  return profile;
}

void ProfileMaker::fill(Profile& profile, const Column& column, float x_mm, float y_mm,
                        const Visit& visit) const {
  std::ranges::fill(profile.amplitude, 0.0F);
  std::ranges::fill(profile.transmission, 1.0F);
  std::ranges::fill(profile.flowing, std::uint8_t{0});
  std::ranges::fill(profile.flowing_share, 0.0F);
  for (std::size_t layer = 0; layer < column.layers().size(); ++layer)
    paint(profile, column, layer, x_mm, y_mm);
  attenuate(profile, column.surfaces());
  const SpeckleKeys keys = keys_of(x_mm, y_mm);
  speckle(profile, keys);
  if (visit.repeats == 1)
    renew_blood(profile, keys, visit.number);
  else
    move_blood(profile, column, keys, visit);
}

// Bin d reaches from d − 1/2 to d + 1/2; those that a layer covers in part get that part of it.
void ProfileMaker::paint(Profile& profile, const Column& column, std::size_t index, float x_mm,
                         float y_mm) const {
  const Layer& layer = column.layers()[index];
  const float top = std::max(layer.top_mm / depth_spacing_mm_, 0.0F);
  const float bottom =
      std::min(layer.bottom_mm / depth_spacing_mm_, static_cast<float>(depths_) - 1.5F);
  const int first = static_cast<int>(std::floor(top + 0.5F));
  const int last = static_cast<int>(std::floor(bottom + 0.5F));
  if (bottom <= top)
    return;
  const float kept = std::exp(-layer.attenuation_per_mm * depth_spacing_mm_);
  const float flows = layer.flowing ? 1 : 0;
  const auto cover = [&](int depth, float level) {
    const float middle = static_cast<float>(depth);
    const float part = std::min(bottom, middle + 0.5F) - std::max(top, middle - 0.5F);
    float& amplitude = profile.amplitude[static_cast<std::size_t>(depth)];
    amplitude += (level - amplitude) * part;
    float& share = profile.flowing_share[static_cast<std::size_t>(depth)];
    share += (flows - share) * part;
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
            static_cast<std::uint8_t>(layer.flowing ? index + 1 : 0));
  if (end - begin > 2)
    std::fill(profile.flowing_share.begin() + begin + 1, profile.flowing_share.begin() + end - 1,
              flows);
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
  // A surface's phase follows its depth: neighbouring A-scans of a slope differ in it at random, as
  // they do in nature, so that their mean does not keep a ghost of the surface as background.
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

ProfileMaker::SpeckleKeys ProfileMaker::keys_of(float x_mm, float y_mm) const {
  // Half a spacing off, so that A-scans lie between two places of the speckle and share them.
  const float a = x_mm / a_spacing_mm_ + 0.5F;
  const float lower = std::floor(a);
  const float angle = (a - lower) * 1.57079633F;
  return {.b = static_cast<std::uint64_t>(std::llround(y_mm / b_spacing_mm_ * 2)),
          .a = static_cast<std::uint64_t>(static_cast<std::int64_t>(lower)),
          .first_weight = std::cos(angle) * unit_power,
          .second_weight = std::sin(angle) * unit_power};
}

void ProfileMaker::speckle(Profile& profile, const SpeckleKeys& keys) const {
  const std::size_t n = profile.amplitude.size();
  auto* out = reinterpret_cast<float*>(profile.scatterers.data());
  multiply_speckle(profile.amplitude.data(),
                   gaussian_.run(hash(seed_, keys.b, keys.a), 2 * n).data(), keys.first_weight,
                   gaussian_.run(hash(seed_, keys.b, keys.a + 1), 2 * n).data(), keys.second_weight,
                   out, n);
}

void ProfileMaker::renew_blood(Profile& profile, const SpeckleKeys& keys,
                               std::uint64_t visit) const {
  const std::size_t n = profile.amplitude.size();
  const float* moved = gaussian_.run(hash(seed_ + 3, keys.b, keys.a, visit), 2 * n).data();
  for (std::size_t d = 0; d < n; ++d)
    if (profile.flowing[d] != 0)
      profile.scatterers[d] =
          std::complex<float>(moved[2 * d], moved[2 * d + 1]) * (profile.amplitude[d] * unit_power);
}

// Each repeat brings a number of its own to each voxel, and is a sum of those so far.
void ProfileMaker::move_blood(Profile& profile, const Column& column, const SpeckleKeys& keys,
                              const Visit& visit) const {
  const std::size_t n = profile.amplitude.size();
  const auto repeat = static_cast<std::size_t>(visit.repeat);
  struct Numbers {
    const float* first;
    const float* second;
  };
  std::array<Numbers, most_repeats> numbers{};
  for (std::size_t j = 0; j <= repeat; ++j) {
    const std::uint64_t number = visit.number - repeat + j;
    numbers[j] = {gaussian_.run(hash(seed_ + 3, keys.b, keys.a, number), 2 * n).data(),
                  gaussian_.run(hash(seed_ + 3, keys.b, keys.a + 1, number), 2 * n).data()};
  }
  const auto number = [&](std::size_t j, std::size_t d) {
    const auto part = [&](std::size_t i) {
      return keys.first_weight * numbers[j].first[i] + keys.second_weight * numbers[j].second[i];
    };
    return std::complex<float>(part(2 * d), part(2 * d + 1));
  };
  const std::span<const double> times = std::span{visit.times_s}.first(repeat + 1);
  ScattererMotion motion;     // of the bin
  ScattererMotion lumen_mean; // of the lumen above
  float crossed_mm = 0;       // blood above
  std::array<std::complex<float>, most_repeats> weights = repeat_weights(motion, times);
  for (std::size_t d = 0; d < n; ++d) {
    ScattererMotion here = lumen_mean;
    here.share = 1 - std::exp(-static_cast<float>(tail_per_mm) * crossed_mm);
    const bool flowing = profile.flowing[d] != 0;
    if (flowing) {
      const LumenFlow& flow = column.layers()[profile.flowing[d] - 1U].flow;
      const float speed = flow.speed_at(static_cast<float>(d) * depth_spacing_mm_);
      here = {flow.across_mm_per_s * speed, flow.along_mm_per_s * speed,
              std::max(profile.flowing_share[d], here.share)};
      lumen_mean = {flow.across_mm_per_s / 2, flow.along_mm_per_s / 2};
      crossed_mm += profile.flowing_share[d] * depth_spacing_mm_;
    } else if (here.share == 0) {
      continue;
    }
    if (here != motion) { // a tail's is one all the way down
      motion = here;
      weights = repeat_weights(motion, times);
    }
    std::complex<float> sum =
        weights[0] * (flowing ? number(0, d) * profile.amplitude[d] : profile.scatterers[d]);
    for (std::size_t j = 1; j <= repeat; ++j)
      sum += weights[j] * number(j, d) * profile.amplitude[d];
    profile.scatterers[d] = sum;
  }
}

} // namespace octascope::sim

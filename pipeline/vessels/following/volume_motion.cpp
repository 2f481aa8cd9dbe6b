#include "pipeline/vessels/following/volume_motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <numbers>
#include <span>

#include <fftw3.h>

#include "pipeline/reconstruction/fft_plan.h"

namespace octascope::pipeline {

namespace {

constexpr int most_cells = 96;
constexpr int most_depth_cells = 64;
// The spectrum's weight falls as a Gaussian's, to e^-½ at this share of the sampling frequency.
constexpr double spectrum_width = 0.15;

// 1 in the middle, fading over a fifth at either end.
float border_weight(int at, int of) {
  constexpr double faded = 0.2;
  const double place = (at + 0.5) / of;
  const double inside = std::min(place, 1 - place) / faded;
  return static_cast<float>(inside < 1 ? 0.5 - 0.5 * std::cos(std::numbers::pi * inside) : 1);
}

// The B-scan to take for `b`: itself, or the next one that is there.
int stand_in(std::span<const BScanState> states, int b) {
  const int count = static_cast<int>(states.size());
  for (int off = 0; off < count; ++off)
    for (const int at : {b - off, b + off})
      if (at >= 0 && at < count && has_levels(states[static_cast<std::size_t>(at)]))
        return at;
  return b;
}

// Of three values about a peak, where it lies between them.
double peak_between(float before, float at, float after) {
  constexpr float least = 1e-6F;
  const double l = std::log(std::max(before, least));
  const double m = std::log(std::max(at, least));
  const double r = std::log(std::max(after, least));
  const double bend = l - 2 * m + r;
  return bend < 0 ? std::clamp((l - r) / (2 * bend), -0.5, 0.5) : 0;
}

} // namespace

struct VolumeMotion::Transforms {
  FftBuffer cells, bins;
  FftPlan forward, backward;
};

VolumeMotion::VolumeMotion(const VolumeGeometry& geometry)
    : geometry_{geometry}, transforms_{std::make_unique<Transforms>()} {
  const std::array<int, 3> voxels{geometry.a_scans, geometry.b_scans,
                                  geometry.depths - blank_depth_bins};
  const std::array<int, 3> most{most_cells, most_cells, most_depth_cells};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    averaged_[axis] = (voxels[axis] + most[axis] - 1) / most[axis];
    cells_[axis] = voxels[axis] / averaged_[axis];
  }
  const auto count = [](int n) { return static_cast<std::size_t>(n); };
  Transforms& t = *transforms_;
  t.cells = make_fft_buffer(count(cells_[0]) * count(cells_[1]) * count(cells_[2]));
  t.bins = make_fft_buffer(2 * count(cells_[0]) * count(cells_[1]) * count(cells_[2] / 2 + 1));
  const std::scoped_lock lock{fft_planner_mutex()};
  t.forward.reset(fftwf_plan_dft_r2c_3d(cells_[1], cells_[0], cells_[2], t.cells.get(),
                                        as_complex(t.bins.get()), FFTW_ESTIMATE));
  t.backward.reset(fftwf_plan_dft_c2r_3d(cells_[1], cells_[0], cells_[2], as_complex(t.bins.get()),
                                         t.cells.get(), FFTW_ESTIMATE));
}

VolumeMotion::~VolumeMotion() = default;
VolumeMotion::VolumeMotion(VolumeMotion&&) noexcept = default;
VolumeMotion& VolumeMotion::operator=(VolumeMotion&&) noexcept = default;

std::optional<VolumeSpectrum> VolumeMotion::spectrum(std::span<const std::uint8_t> levels,
                                                     std::span<const BScanState> states) {
  if (2 * std::ranges::count_if(states, has_levels) < std::ssize(states))
    return std::nullopt;
  const auto depths = static_cast<std::size_t>(geometry_.depths);
  const auto [a_cells, b_cells, z_cells] = cells_;
  float* const cells = transforms_->cells.get();
  float* cell = cells;
  std::vector<std::uint32_t> sums(static_cast<std::size_t>(z_cells));
  double whole = 0;
  for (int b = 0; b < b_cells; ++b)
    for (int a = 0; a < a_cells; ++a) {
      std::ranges::fill(sums, 0U);
      for (int i = 0; i < averaged_[1]; ++i) {
        const int from = stand_in(states, b * averaged_[1] + i);
        for (int j = 0; j < averaged_[0]; ++j) {
          const std::size_t line =
              static_cast<std::size_t>(from) * static_cast<std::size_t>(geometry_.a_scans) +
              static_cast<std::size_t>(a * averaged_[0] + j);
          const std::uint8_t* level = levels.data() + line * depths + blank_depth_bins;
          for (std::uint32_t& sum : sums)
            for (int k = 0; k < averaged_[2]; ++k)
              sum += *level++;
        }
      }
      for (const std::uint32_t sum : sums) {
        whole += sum;
        *cell++ = static_cast<float>(sum);
      }
    }
  const auto mean = static_cast<float>(whole / static_cast<double>(cell - cells));
  cell = cells;
  for (int b = 0; b < b_cells; ++b)
    for (int a = 0; a < a_cells; ++a) {
      const float weight = border_weight(a, a_cells) * border_weight(b, b_cells);
      for (int z = 0; z < z_cells; ++z, ++cell)
        *cell = (*cell - mean) * weight * border_weight(z, z_cells);
    }
  fftwf_execute(transforms_->forward.get());
  const auto* bins = reinterpret_cast<const std::complex<float>*>(transforms_->bins.get());
  const std::size_t count = static_cast<std::size_t>(a_cells) * static_cast<std::size_t>(b_cells) *
                            static_cast<std::size_t>(z_cells / 2 + 1);
  return VolumeSpectrum{{bins, bins + count}};
}

VolumeShift VolumeMotion::shift(const VolumeSpectrum& from, const VolumeSpectrum& to) {
  const auto [a_cells, b_cells, z_cells] = cells_;
  const auto falling = [](int bin, int of) {
    const double frequency = static_cast<double>(std::min(bin, of - bin)) / of / spectrum_width;
    return std::exp(-frequency * frequency / 2);
  };
  auto* product = reinterpret_cast<std::complex<float>*>(transforms_->bins.get());
  double whole = 0;
  std::size_t i = 0;
  for (int b = 0; b < b_cells; ++b)
    for (int a = 0; a < a_cells; ++a)
      for (int z = 0; z <= z_cells / 2; ++z, ++i) {
        const double weight = falling(b, b_cells) * falling(a, a_cells) * falling(z, z_cells);
        const std::complex<float> both = to.bins[i] * std::conj(from.bins[i]);
        const float modulus = std::abs(both);
        product[i] = modulus > 0 ? both * (static_cast<float>(weight) / modulus) : 0;
        whole += weight * (z == 0 || 2 * z == z_cells ? 1 : 2); // the other half is its mirror
      }
  fftwf_execute(transforms_->backward.get());
  const float* cells = transforms_->cells.get();
  const float* const end = cells + static_cast<std::ptrdiff_t>(a_cells) * b_cells * z_cells;
  const auto peak = static_cast<int>(std::max_element(cells, end) - cells);
  const std::array<int, 3> at{peak / z_cells % a_cells, peak / z_cells / a_cells, peak % z_cells};
  const auto value = [&](std::size_t axis, int off) {
    std::array<int, 3> place = at;
    place[axis] = (place[axis] + off + cells_[axis]) % cells_[axis];
    return cells[(place[1] * cells_[0] + place[0]) * cells_[2] + place[2]];
  };
  const std::array<double, 3> spacing_mm{geometry_.a_spacing_um * 1e-3,
                                         geometry_.b_spacing_um * 1e-3,
                                         geometry_.depth_spacing_um * 1e-3};
  VolumeShift moved;
  moved.quality = static_cast<double>(cells[peak]) / whole;
  moved.found = moved.quality >= least_shift_quality;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int whole_cells = at[axis] > cells_[axis] / 2 ? at[axis] - cells_[axis] : at[axis];
    const double off = whole_cells + peak_between(value(axis, -1), value(axis, 0), value(axis, 1));
    moved.found = moved.found && 3 * std::abs(off) <= cells_[axis];
    moved.shift_mm[axis] = off * averaged_[axis] * spacing_mm[axis];
  }
  return moved;
}

} // namespace octascope::pipeline

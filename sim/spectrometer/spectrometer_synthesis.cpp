#include "sim/spectrometer/spectrometer_synthesis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <mutex>
#include <numbers>

#include "pipeline/reconstruction/fft_plan.h"
#include "sim/spectrometer/spectrometer_simd.h"

namespace octascope::sim {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int taps = 4;
constexpr int weights_per_pixel = 2 * taps; // real and imaginary
// Grid points before the first and behind the last, for the taps of the outermost pixels. Whole
// cache lines, which keeps the FFT's output as aligned as its input.
constexpr std::size_t margin = 16;
// Beatty, Nishimura, Pauly, IEEE Trans. Med. Imaging 24, 2005: the best shape for 4 taps and
// twofold oversampling, π·√((taps/2)²·(2 − 1/2)² − 0.8).
const double kernel_shape = pi * std::sqrt(4 * 2.25 - 0.8);

double kernel(double distance) {
  const double x = 2 * distance / taps;
  return x * x >= 1 ? 0 : std::cyl_bessel_i(0, kernel_shape * std::sqrt(1 - x * x));
}

// Fourier transform of the kernel, at |cycles| ≤ 1/4 a sample.
double kernel_weight(double cycles) {
  const double x = pi * taps * cycles;
  const double root = std::sqrt(kernel_shape * kernel_shape - x * x);
  return taps * std::sinh(root) / root;
}

struct FreeFft {
  void operator()(fftwf_complex* memory) const { fftwf_free(memory); }
};
using FftBuffer = std::unique_ptr<fftwf_complex[], FreeFft>;

FftBuffer zeroed_buffer(std::size_t count) {
  FftBuffer buffer(fftwf_alloc_complex(count));
  std::memset(buffer.get(), 0, count * sizeof(fftwf_complex));
  return buffer;
}

struct PixelTaps {
  std::array<float, weights_per_pixel> weights; // re₀, −im₀, re₁, −im₁ …
};

// counts[p] = base[p] + Σ weights · the grid's taps from first[p] on.
OCTASCOPE_VECTOR_LOOP
void read_grid(const float* grid, const PixelTaps* pixels, const std::int32_t* first,
               const float* base, float* counts, std::size_t n) {
  for (std::size_t p = 0; p < n; ++p) {
    const float* g = grid + 2 * first[p];
    const float* w = pixels[p].weights.data();
    std::array<float, 4> sum;
    for (std::size_t i = 0; i < 4; ++i)
      sum[i] = w[i] * g[i] + w[i + 4] * g[i + 4];
    counts[p] = base[p] + ((sum[0] + sum[1]) + (sum[2] + sum[3]));
  }
}

// grid[i] += start · step^i, complex. Eight rotations run abreast.
OCTASCOPE_VECTOR_LOOP
void add_fringe(std::complex<double> start, std::complex<double> step, float* grid,
                std::size_t blocks_of_8) {
  std::array<float, 8> re;
  std::array<float, 8> im;
  std::complex<double> power = 1;
  for (std::size_t lane = 0; lane < 8; ++lane, power *= step) {
    re[lane] = static_cast<float>((start * power).real());
    im[lane] = static_cast<float>((start * power).imag());
  }
  const auto step_re = static_cast<float>(power.real());
  const auto step_im = static_cast<float>(power.imag());
  for (std::size_t block = 0; block < blocks_of_8; ++block, grid += 16) {
    for (std::size_t lane = 0; lane < 8; ++lane) {
      grid[2 * lane] += re[lane];
      grid[2 * lane + 1] += im[lane];
      const float turned = re[lane] * step_re - im[lane] * step_im;
      im[lane] = re[lane] * step_im + im[lane] * step_re;
      re[lane] = turned;
    }
  }
}

// grid[i] *= start · step^i, likewise.
OCTASCOPE_VECTOR_LOOP
void turn_grid(std::complex<double> start, std::complex<double> step, float* grid,
               std::size_t blocks_of_8) {
  std::array<float, 8> re;
  std::array<float, 8> im;
  std::complex<double> power = 1;
  for (std::size_t lane = 0; lane < 8; ++lane, power *= step) {
    re[lane] = static_cast<float>((start * power).real());
    im[lane] = static_cast<float>((start * power).imag());
  }
  const auto step_re = static_cast<float>(power.real());
  const auto step_im = static_cast<float>(power.imag());
  for (std::size_t block = 0; block < blocks_of_8; ++block, grid += 16) {
    for (std::size_t lane = 0; lane < 8; ++lane) {
      const float here = grid[2 * lane];
      grid[2 * lane] = here * re[lane] - grid[2 * lane + 1] * im[lane];
      grid[2 * lane + 1] = here * im[lane] + grid[2 * lane + 1] * re[lane];
      const float turned = re[lane] * step_re - im[lane] * step_im;
      im[lane] = re[lane] * step_im + im[lane] * step_re;
      re[lane] = turned;
    }
  }
}

OCTASCOPE_VECTOR_LOOP
void add_noise_and_round(const float* mean, const float* noise, float counts_per_electron,
                         float read_variance, float full_scale, std::uint16_t* counts,
                         std::size_t n) {
  for (std::size_t p = 0; p < n; ++p) {
    const float variance = std::max(mean[p], 0.0F) * counts_per_electron + read_variance;
    const float value = mean[p] + noise[p] * std::sqrt(variance);
    counts[p] = static_cast<std::uint16_t>(
        static_cast<std::int32_t>(std::min(std::max(value, 0.0F), full_scale) + 0.5F));
  }
}

} // namespace

struct SpectrumSynthesis::Workspace::Buffers {
  explicit Buffers(std::size_t n)
      : bins(zeroed_buffer(n)), grid(zeroed_buffer(n + 2 * margin + 8)) {}

  FftBuffer bins; // those between the tissue's stay 0
  FftBuffer grid;
};

SpectrumSynthesis::Workspace::Workspace(std::unique_ptr<Buffers> buffers)
    : buffers_(std::move(buffers)) {}
SpectrumSynthesis::Workspace::Workspace(Workspace&&) noexcept = default;
SpectrumSynthesis::Workspace&
SpectrumSynthesis::Workspace::operator=(Workspace&&) noexcept = default;
SpectrumSynthesis::Workspace::~Workspace() = default;

struct SpectrumSynthesis::Tables {
  explicit Tables(const Spectrometer& s);

  // R(d) over the kernel's weight there.
  double depth_factor(double depth_bin) const {
    return spectrometer.roll_off(depth_bin) / kernel_weight((depth_bin - middle) / samples);
  }

  Spectrometer spectrometer;
  int samples;
  int depths;
  int middle; // the depth that the grid is shifted to
  std::vector<float> depth_factors;
  std::vector<float> base; // mean[p] without a sample
  std::vector<PixelTaps> pixels;
  std::vector<std::int32_t> first_tap; // in the grid with its margin
  GaussianTable noise;
  pipeline::FftPlan plan;
};

SpectrumSynthesis::Tables::Tables(const Spectrometer& s)
    : spectrometer(s), samples(s.samples()), depths(s.depths()), middle(s.depths() / 2),
      noise(hash(s.config().seed, 0x401e), 18, static_cast<std::size_t>(s.samples())) {
  for (int d = 0; d < depths; ++d)
    depth_factors.push_back(static_cast<float>(depth_factor(d)));
  for (std::size_t p = 0; p < static_cast<std::size_t>(samples); ++p) {
    const double light = s.gain()[p] * s.envelope()[p];
    const double m = s.k_of_pixel()[p];
    const double turn = 2 * pi * middle * m / samples - s.dispersion_of_pixel_rad()[p];
    const double first = std::floor(m) - (taps / 2 - 1);
    PixelTaps pixel;
    for (std::size_t t = 0; t < taps; ++t) {
      const double weight = light * kernel(m - first - static_cast<double>(t));
      pixel.weights[2 * t] = static_cast<float>(weight * std::cos(turn));
      pixel.weights[2 * t + 1] = static_cast<float>(-weight * std::sin(turn));
    }
    pixels.push_back(pixel);
    first_tap.push_back(static_cast<std::int32_t>(first) + static_cast<std::int32_t>(margin));
    base.push_back(static_cast<float>(s.dark_counts()[p] + light * s.config().reference_counts));
  }
  const auto n = static_cast<std::size_t>(samples);
  const FftBuffer bins = zeroed_buffer(n);
  const FftBuffer grid = zeroed_buffer(n + margin);
  const std::scoped_lock lock{pipeline::fft_planner_mutex()};
  plan.reset(
      fftwf_plan_dft_1d(samples, bins.get(), grid.get() + margin, FFTW_BACKWARD, FFTW_MEASURE));
}

SpectrumSynthesis::SpectrumSynthesis(const Spectrometer& spectrometer)
    : tables_(std::make_unique<const Tables>(spectrometer)) {}
SpectrumSynthesis::~SpectrumSynthesis() = default;

SpectrumSynthesis::Workspace SpectrumSynthesis::make_workspace() const {
  return Workspace(
      std::make_unique<Workspace::Buffers>(static_cast<std::size_t>(tables_->samples)));
}

void SpectrumSynthesis::mean_counts(std::span<const std::complex<float>> scatterers,
                                    std::span<const Reflector> surfaces, Workspace& workspace,
                                    std::span<float> counts, const Shift& shift) const {
  const Tables& t = *tables_;
  const auto n = static_cast<std::size_t>(t.samples);
  fftwf_complex* bins = workspace.buffers_->bins.get();
  fftwf_complex* grid = workspace.buffers_->grid.get();

  const int moved = static_cast<int>(std::lround(shift.depth_bins));
  // Depth d is frequency d − middle, the negative ones at the array's end.
  for (int d = 0; d < t.depths; ++d) {
    const auto depth = static_cast<std::size_t>(d);
    const int frequency = d - t.middle;
    const auto seen_at = static_cast<std::size_t>(std::clamp(d + moved, 0, t.depths - 1));
    fftwf_complex& bin = bins[frequency < 0 ? frequency + t.samples : frequency];
    bin[0] = scatterers[depth].real() * t.depth_factors[seen_at];
    bin[1] = scatterers[depth].imag() * t.depth_factors[seen_at];
  }
  fftwf_execute_dft(t.plan.get(), bins, grid + margin);
  std::memcpy(grid, grid + n, margin * sizeof(fftwf_complex));
  std::memcpy(grid + margin + n, grid + margin, margin * sizeof(fftwf_complex));

  for (const Reflector& surface : surfaces) {
    const double angle = 2 * pi * (surface.depth_bin - t.middle) / t.samples;
    const std::complex<double> start =
        std::polar(surface.amplitude_counts * t.depth_factor(surface.depth_bin + shift.depth_bins),
                   surface.phase_rad - angle * static_cast<double>(margin));
    add_fringe(start, std::polar(1.0, angle), &grid[0][0], (n + 2 * margin + 7) / 8);
  }
  if (shift.depth_bins != 0 || shift.phase_rad != 0) {
    const double angle = 2 * pi * shift.depth_bins / t.samples;
    const double middle_of_line = t.samples / 2.0 + static_cast<double>(margin);
    turn_grid(std::polar(1.0, shift.phase_rad - angle * middle_of_line), std::polar(1.0, angle),
              &grid[0][0], (n + 2 * margin + 7) / 8);
  }
  read_grid(&grid[0][0], t.pixels.data(), t.first_tap.data(), t.base.data(), counts.data(), n);
}

void SpectrumSynthesis::expose(std::span<const float> mean, std::uint64_t noise_key,
                               std::span<std::uint16_t> counts) const {
  const SpectrometerConfig& config = tables_->spectrometer.config();
  add_noise_and_round(mean.data(), tables_->noise.run(noise_key, mean.size()).data(),
                      static_cast<float>(1 / config.electrons_per_count),
                      static_cast<float>(config.read_noise_counts * config.read_noise_counts),
                      static_cast<float>(tables_->spectrometer.full_scale_counts()), counts.data(),
                      mean.size());
}

} // namespace octascope::sim

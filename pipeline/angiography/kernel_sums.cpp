#include "pipeline/angiography/kernel_sums.h"

#include <algorithm>
#include <cmath>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

// Sums in as many parts as the widest registers have: without that a compiler may not reorder them.
constexpr int lanes = 16;

constexpr float no_power = 1e-30F;

OCTASCOPE_CPU_CLONES
void split_loop(const PackedBin* __restrict line, int begin, int end, float* __restrict real,
                float* __restrict imaginary) {
  for (int z = begin; z < end; ++z) {
    real[z] = line[z].real();
    imaginary[z] = line[z].imaginary();
  }
}

// taps[2 * i] and taps[2 * i + 1] are the parts of what weighs line[z + i].
OCTASCOPE_CPU_CLONES
void interpolate_loop(const PackedBin* __restrict line, const float* __restrict taps, int count,
                      float* __restrict real, float* __restrict imaginary) {
  for (int z = 0; z < count; ++z) {
    float x = 0;
    float y = 0;
    for (int i = 0; i < 6; ++i) {
      const PackedBin bin = line[z + i];
      x += taps[2 * i] * bin.real();
      x -= taps[2 * i + 1] * bin.imaginary();
      y += taps[2 * i] * bin.imaginary();
      y += taps[2 * i + 1] * bin.real();
    }
    real[z] = x;
    imaginary[z] = y;
  }
}

OCTASCOPE_CPU_CLONES
void correlate_loop(const float* __restrict first, const float* __restrict second, int depths,
                    float* __restrict real, float* __restrict imaginary) {
  std::array<float, 32> re{}; // in registers
  std::array<float, 32> im{};
  for (int z = 16; z < depths - 16; ++z) {
    const float a = first[z];
    const float b = first[z + depths];
    const float* const c = second + z - 16;
    const float* const d = c + depths;
    for (std::size_t s = 0; s < re.size(); ++s) {
      re[s] += a * c[s] + b * d[s];
      im[s] += b * c[s] - a * d[s];
    }
  }
  for (std::size_t s = 0; s < re.size(); ++s) {
    real[s] += re[s];
    imaginary[s] += im[s];
  }
}

OCTASCOPE_CPU_CLONES
void squares_loop(const float* __restrict values, int count, float* __restrict sums) {
  for (int i = 0; i + lanes <= count; i += lanes)
    for (int lane = 0; lane < lanes; ++lane)
      sums[lane] += values[i + lane] * values[i + lane];
  for (int i = count / lanes * lanes; i < count; ++i)
    sums[0] += values[i] * values[i];
}

OCTASCOPE_CPU_CLONES
void product_loop(const float* __restrict re1, const float* __restrict im1,
                  const float* __restrict re2, const float* __restrict im2, int count,
                  float* __restrict re, float* __restrict im, float* __restrict power,
                  float* __restrict real_sums, float* __restrict imaginary_sums) {
  std::array<float, lanes> x{};
  std::array<float, lanes> y{};
  int z = 0;
  for (; z + lanes <= count; z += lanes) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const float a = (re1 + z)[i];
      const float b = (im1 + z)[i];
      const float c = (re2 + z)[i];
      const float d = (im2 + z)[i];
      (re + z)[i] = a * c + b * d;
      (im + z)[i] = b * c - a * d;
      x[i] += (re + z)[i];
      y[i] += (im + z)[i];
      (power + z)[i] += 0.5F * (a * a + b * b + c * c + d * d);
    }
  }
  for (; z < count; ++z) {
    re[z] = re1[z] * re2[z] + im1[z] * im2[z];
    im[z] = im1[z] * re2[z] - re1[z] * im2[z];
    x[0] += re[z];
    y[0] += im[z];
    power[z] += 0.5F * (re1[z] * re1[z] + im1[z] * im1[z] + re2[z] * re2[z] + im2[z] * im2[z]);
  }
  std::copy_n(x.begin(), lanes, real_sums);
  std::copy_n(y.begin(), lanes, imaginary_sums);
}

// Turned back by the phase whose cosine and sine are c and s.
OCTASCOPE_CPU_CLONES
void turn_loop(const float* __restrict re, const float* __restrict im, float c, float s, int count,
               float* __restrict like, float* __restrict other) {
  for (int z = 0; z < count; ++z) {
    like[z] += re[z] * c + im[z] * s;
    other[z] += im[z] * c - re[z] * s;
  }
}

OCTASCOPE_CPU_CLONES
void intensity_loop(const float* __restrict re1, const float* __restrict im1,
                    const float* __restrict re2, const float* __restrict im2, int count,
                    float* __restrict like, float* __restrict mean, float* __restrict power) {
  for (int z = 0; z < count; ++z) {
    const float first = re1[z] * re1[z] + im1[z] * im1[z];
    const float second = re2[z] * re2[z] + im2[z] * im2[z];
    like[z] += first * second;
    mean[z] += 0.5F * (first + second);
    power[z] += 0.5F * (first * first + second * second);
  }
}

OCTASCOPE_CPU_CLONES
void three_lines_loop(const float* __restrict a, const float* __restrict b,
                      const float* __restrict c, int depths, float* __restrict sum) {
  for (int z = 0; z < depths; ++z)
    sum[z] = a[z] + b[z] + c[z];
}

OCTASCOPE_CPU_CLONES
void two_lines_loop(const float* __restrict a, const float* __restrict b, int depths,
                    float* __restrict sum) {
  for (int z = 0; z < depths; ++z)
    sum[z] = a[z] + b[z];
}

#define OVER_DEPTHS(line, z) (line[z - 2] + line[z - 1] + line[z] + line[z + 1] + line[z + 2])

OCTASCOPE_CPU_CLONES
void finish_complex_loop(const float* __restrict like, const float* __restrict other,
                         const float* __restrict power, const float* __restrict scale, int depths,
                         float* __restrict decorrelation, float* __restrict level) {
  for (int z = 0; z < depths; ++z) {
    const float x = OVER_DEPTHS(like, z);
    const float y = OVER_DEPTHS(other, z);
    const float p = OVER_DEPTHS(power, z);
    decorrelation[z] = 1 - std::sqrt(x * x + y * y) / (p + no_power);
    level[z] = p * scale[z];
  }
}

OCTASCOPE_CPU_CLONES
void finish_intensity_loop(const float* __restrict like, const float* __restrict mean,
                           const float* __restrict power, const float* __restrict scale, int depths,
                           float* __restrict decorrelation, float* __restrict level,
                           float* __restrict second_moment) {
  for (int z = 0; z < depths; ++z) {
    const float p = OVER_DEPTHS(power, z);
    decorrelation[z] = 1 - OVER_DEPTHS(like, z) / (p + no_power);
    level[z] = OVER_DEPTHS(mean, z) * scale[z];
    second_moment[z] = p * scale[z];
  }
}

#undef OVER_DEPTHS

float total(const std::array<float, lanes>& sums) {
  float sum = 0;
  for (const float part : sums)
    sum += part;
  return sum;
}

} // namespace

void split_parts(const PackedBin* line, int begin, int end, float* real,
                 float* imaginary) noexcept {
  split_loop(line, begin, end, real, imaginary);
}

void interpolate(const PackedBin* line, const std::array<std::complex<float>, 6>& taps, int begin,
                 int end, float* real, float* imaginary) noexcept {
  const auto* const weights = reinterpret_cast<const float*>(taps.data()); // as the standard allows
  interpolate_loop(line + begin, weights, end - begin, real + begin, imaginary + begin);
}

void correlate_lags(const float* first, const float* second, int depths,
                    std::array<float, 32>& real, std::array<float, 32>& imaginary) noexcept {
  correlate_loop(first, second, depths, real.data(), imaginary.data());
}

float sum_of_squares(const float* values, int count) noexcept {
  std::array<float, lanes> sums{};
  squares_loop(values, count, sums.data());
  return total(sums);
}

void fetch_line(const PackedBin* line, int depths) noexcept {
  constexpr int cache_line = 64 / sizeof(PackedBin);
  for (int z = 0; z < depths; z += cache_line)
    __builtin_prefetch(line + z);
}

void add_complex_pair(const Parts& first, const Parts& second, int begin, int end,
                      const PairSums& sums, float* scratch) noexcept {
  const int count = end - begin;
  float* const re = scratch;
  float* const im = scratch + count;
  std::array<float, lanes> real_sums{};
  std::array<float, lanes> imaginary_sums{};
  product_loop(first.real + begin, first.imaginary + begin, second.real + begin,
               second.imaginary + begin, count, re, im, sums.power + begin, real_sums.data(),
               imaginary_sums.data());
  const float x = total(real_sums);
  const float y = total(imaginary_sums);
  const float modulus = std::sqrt(x * x + y * y);
  const bool turns = modulus > no_power;
  turn_loop(re, im, turns ? x / modulus : 1, turns ? y / modulus : 0, count, sums.like + begin,
            sums.other + begin);
}

void add_intensity_pair(const Parts& first, const Parts& second, int begin, int end,
                        const PairSums& sums) noexcept {
  intensity_loop(first.real + begin, first.imaginary + begin, second.real + begin,
                 second.imaginary + begin, end - begin, sums.like + begin, sums.other + begin,
                 sums.power + begin);
}

void add_lines(const float* const* lines, int count, int depths, float* sum) noexcept {
  if (count == 3)
    three_lines_loop(lines[0], lines[1], lines[2], depths, sum);
  else if (count == 2)
    two_lines_loop(lines[0], lines[1], depths, sum);
  else
    std::copy_n(lines[0], depths, sum);
}

void finish_complex(const PairSums& sums, const float* scale, int depths, float* decorrelation,
                    float* level) noexcept {
  finish_complex_loop(sums.like, sums.other, sums.power, scale, depths, decorrelation, level);
}

void finish_intensity(const PairSums& sums, const float* scale, int depths, float* decorrelation,
                      float* level, float* second_moment) noexcept {
  finish_intensity_loop(sums.like, sums.other, sums.power, scale, depths, decorrelation, level,
                        second_moment);
}

} // namespace octascope::pipeline

#include "pipeline/angiography/static_tissue.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "pipeline/angiography/kernel_sums.h"
#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

constexpr int block_depths = 32;
// Every fourth A-scan and depth is enough for quantiles of many voxels.
constexpr int step_of_many = 4;
constexpr int many_voxels = 1 << 14;
// The quantile that stands for static tissue: as many as 30 % of the voxels may flow.
constexpr double quantile = 0.35;
constexpr float normal_quantile = -0.385F;
constexpr float well_lit = 6;          // brighter than noise
constexpr std::size_t fewest_lit = 64; // of the voxels that are looked at
constexpr float most_static = 0.4F;    // decorrelation of what is still comparable
constexpr float least_spread = 0.03F;
constexpr float flowing_spreads = 3;
constexpr float tiny = 1e-30F;

// Between these parts of the vessel's decorrelation a voxel below it counts from not at all to wholly.
constexpr float tail_part = 0.4F;
constexpr float vessel_part = 0.6F;

// Independent samples of M repeats, relative to those of the kernel; the second is
// (M − 1)² / (M − 3/2), since the first and the last repeat count half.
struct Factors {
  float pairs;
  float level;
};
Factors factors_of(int repeats) {
  if (repeats == 2)
    return {1.0F, 2.0F};
  return repeats == 3 ? Factors{1.6F, 2.67F} : Factors{2.25F, 3.6F};
}

// Integers in the order of the floats that they are made of, and of which they are made again.
std::int32_t ordered(std::int32_t bits) {
  return bits ^ ((bits >> 31) & 0x7FFF'FFFF);
}

OCTASCOPE_CPU_CLONES
void order_floats(const float* __restrict values, std::size_t count,
                  std::int32_t* __restrict keys) {
  for (std::size_t i = 0; i < count; ++i)
    keys[i] = ordered(std::bit_cast<std::int32_t>(values[i]));
}

OCTASCOPE_CPU_CLONES
std::int32_t count_up_to(const std::int32_t* keys, std::size_t count, std::int32_t bound) {
  std::int32_t found = 0;
  for (std::size_t i = 0; i < count; ++i)
    found += keys[i] <= bound ? 1 : 0;
  return found;
}

// By bisection: to count so many values in one go is quick, to sort them by turns is not.
float quantile_of(const std::vector<float>& values, std::vector<std::int32_t>& keys) {
  const auto rank = static_cast<std::int32_t>(quantile * static_cast<double>(values.size() - 1));
  keys.resize(values.size()); // room is reserved
  order_floats(values.data(), values.size(), keys.data());
  std::int64_t low = ordered(std::bit_cast<std::int32_t>(-std::numeric_limits<float>::infinity()));
  std::int64_t high = ordered(std::bit_cast<std::int32_t>(std::numeric_limits<float>::infinity()));
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    if (count_up_to(keys.data(), keys.size(), static_cast<std::int32_t>(middle)) > rank)
      high = middle;
    else
      low = middle + 1;
  }
  return std::bit_cast<float>(ordered(static_cast<std::int32_t>(low)));
}

// The same quantile of a mean of n squared moduli of complex Gaussians, relative to its mean (Wilson
// and Hilferty's approximation).
float expected_quantile(float n) {
  const float root = 1 - 1 / (9 * n) + normal_quantile / (3 * std::sqrt(n));
  return std::max(0.1F, root * root * root);
}

// flow[z] without tails; excess[z] decorrelation without noise.
OCTASCOPE_CPU_CLONES
void classify_complex(const float* __restrict decorrelation, const float* __restrict level,
                      const float* __restrict noise, float d0, float noise_spread,
                      float static_spread, int depths, float* __restrict flow,
                      float* __restrict excess) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int z = 0; z < depths; ++z) {
    const float inverse = noise[z] / (level[z] + tiny);
    const float signal = 1 - inverse;
    const float spread = inverse * noise_spread + static_spread;
    const float above = decorrelation[z] - inverse - d0 * signal;
    const float u = std::max(0.0F, above / spread) * (1 / flowing_spreads);
    const float u4 = std::min(u * u * u * u, 1e9F);
    const bool told = level[z] > 0.0F && inverse < 1 / StaticTissue::least_level;
    flow[z] = told ? u4 / (1 + u4) : nan;
    excess[z] = told ? (decorrelation[z] - inverse) / signal : 0.0F;
  }
}

OCTASCOPE_CPU_CLONES
void classify_intensity(const float* __restrict decorrelation, const float* __restrict level,
                        const float* __restrict second_moment, const float* __restrict noise,
                        float d0, float noise_spread, float static_spread, int depths,
                        float* __restrict flow, float* __restrict excess) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int z = 0; z < depths; ++z) {
    const float expected =
        std::min(1.0F, noise[z] * (2 * level[z] - noise[z]) / (second_moment[z] + tiny));
    const float signal = 1 - expected;
    const float spread = expected * noise_spread + static_spread;
    const float above = decorrelation[z] - expected - d0 * signal;
    const float u = std::max(0.0F, above / spread) * (1 / flowing_spreads);
    const float u4 = std::min(u * u * u * u, 1e9F);
    const bool told = level[z] > StaticTissue::least_level * noise[z] && signal > 0.0F;
    flow[z] = told ? u4 / (1 + u4) : nan;
    excess[z] = told ? (decorrelation[z] - expected) / (signal + tiny) : 0.0F;
  }
}

// What flows, as decorrelation without noise.
OCTASCOPE_CPU_CLONES
void find_vessels(const float* __restrict flow, const float* __restrict excess, int depths,
                  float* __restrict vessels) {
  for (int z = 0; z < depths; ++z)
    vessels[z] = flow[z] >= 0.5F ? excess[z] : 0.0F; // 0 of NaN
}

// to[z] = max(from[z], from[z - distance])
OCTASCOPE_CPU_CLONES
void widen_maximum(const float* __restrict from, int distance, int count, float* __restrict to) {
  std::copy_n(from, distance, to);
  for (int z = distance; z < count; ++z)
    to[z] = from[z] > from[z - distance] ? from[z] : from[z - distance];
}

// The greatest of those before each, over 1, 2, 4 … of them: no step waits for the one before it.
// Returns the array that has it.
const float* greatest_before(float* values, float* other, int count) {
  std::copy_n(values, count - 1, other + 1);
  other[0] = 0;
  for (int distance = 1; distance < count; distance *= 2) {
    widen_maximum(other, distance, count, values);
    std::swap(values, other);
  }
  return other;
}

OCTASCOPE_CPU_CLONES
void suppress_tails(const float* __restrict shadows, const float* __restrict excess, int depths,
                    float* __restrict flow) {
  for (int z = 0; z < depths; ++z) {
    const float part =
        (excess[z] - tail_part * shadows[z]) / ((vessel_part - tail_part) * shadows[z] + tiny);
    const float kept = std::min(1.0F, std::max(0.0F, part));
    flow[z] *= shadows[z] > 0 ? kept : 1.0F;
  }
}

} // namespace

StaticTissue::StaticTissue(FlowMethod method, int a_scans, int depths, int repeats)
    : method_(method), a_scans_(a_scans), depths_(depths),
      step_(a_scans < many_voxels / depths ? 1 : step_of_many),
      pair_factor_(factors_of(repeats).pairs), level_factor_(factors_of(repeats).level),
      noise_(static_cast<std::size_t>(depths)),
      blocks_(static_cast<std::size_t>((depths + block_depths - 1) / block_depths)),
      excess_(noise_), vessels_(noise_), shadows_(noise_) {
  values_.reserve(static_cast<std::size_t>((a_scans + step_ - 1) / step_) *
                  static_cast<std::size_t>((depths + step_ - 1) / step_));
  keys_.reserve(values_.capacity());
}

// The noise that this voxel would have if it were static.
float StaticTissue::noise_at(const KernelPlanes& planes, std::size_t i) const {
  const float level = planes.level[i];
  if (method_ == FlowMethod::complex_bins)
    return planes.decorrelation[i] * level;
  const float variance = planes.decorrelation[i] * planes.second_moment[i];
  return level - std::sqrt(std::max(0.0F, level * level - variance));
}

void StaticTissue::measure(const KernelPlanes& planes, float depth_samples) noexcept {
  const float kernel_samples = depth_samples * static_cast<float>(kernel_a_scans);
  samples_ = pair_factor_ * kernel_samples;
  level_samples_ = level_factor_ * kernel_samples;
  if (method_ == FlowMethod::intensity)
    samples_ /= 4;
  measure_noise(planes);
  measure_static(planes);
}

// Over the A-scans, between two depths.
template <class Value>
float StaticTissue::lower_quantile(const KernelPlanes& planes, int begin, int end,
                                   const Value& value) noexcept {
  values_.clear();
  for (int a = 0; a < a_scans_; a += step_)
    for (int z = begin; z < end; z += step_) {
      const std::size_t i =
          static_cast<std::size_t>(a) * noise_.size() + static_cast<std::size_t>(z);
      if (planes.level[i] > 0)
        values_.push_back(value(i));
    }
  return values_.empty() ? std::numeric_limits<float>::quiet_NaN() : quantile_of(values_, keys_);
}

void StaticTissue::measure_noise(const KernelPlanes& planes) noexcept {
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    const int begin = static_cast<int>(block) * block_depths;
    const int end = std::min(depths_, begin + block_depths);
    const float by_change =
        lower_quantile(planes, begin, end, [&](std::size_t i) { return noise_at(planes, i); }) /
        expected_quantile(samples_);
    const float by_level =
        lower_quantile(planes, begin, end, [&](std::size_t i) { return planes.level[i]; }) /
        expected_quantile(level_samples_);
    // Of noise alone the change is estimated too low: a few samples always have something in common.
    blocks_[block] = by_level < 2 * by_change ? by_level : by_change;
  }
  fill_empty_blocks();
  values_.assign(blocks_.begin(), blocks_.end());
  const auto lower = values_.begin() + static_cast<std::ptrdiff_t>(values_.size() / 4);
  std::nth_element(values_.begin(), lower, values_.end());
  for (float& noise : blocks_)
    noise = std::min(noise, 2 * *lower);
  // From the middle of a block to that of the next.
  for (int z = 0; z < depths_; ++z) {
    const float at = std::clamp((static_cast<float>(z) - block_depths / 2) / block_depths, 0.0F,
                                static_cast<float>(blocks_.size() - 1));
    const auto before = static_cast<std::size_t>(at);
    const std::size_t after = std::min(before + 1, blocks_.size() - 1);
    const float fraction = at - static_cast<float>(before);
    noise_[static_cast<std::size_t>(z)] =
        blocks_[before] + fraction * (blocks_[after] - blocks_[before]);
  }
}

// As the block before, or else the first that has power.
void StaticTissue::fill_empty_blocks() noexcept {
  const auto first = std::ranges::find_if(blocks_, [](float noise) { return !std::isnan(noise); });
  float last = first == blocks_.end() ? 0.0F : *first;
  for (float& noise : blocks_)
    last = noise = std::isnan(noise) ? last : noise;
}

void StaticTissue::measure_static(const KernelPlanes& planes) noexcept {
  values_.clear();
  for (int a = 0; a < a_scans_; a += step_)
    for (int z = 0; z < depths_; z += step_) {
      const std::size_t i =
          static_cast<std::size_t>(a) * noise_.size() + static_cast<std::size_t>(z);
      const float noise = noise_[static_cast<std::size_t>(z)];
      const float level = planes.level[i];
      if (!(level > well_lit * noise))
        continue;
      const float expected = method_ == FlowMethod::complex_bins
                                 ? noise / level
                                 : noise * (2 * level - noise) / planes.second_moment[i];
      values_.push_back((planes.decorrelation[i] - expected) / (1 - std::min(0.9F, expected)));
    }
  is_lit_ = values_.size() >= fewest_lit;
  d0_ = is_lit_ ? std::max(0.0F, quantile_of(values_, keys_)) : 0.0F;
  incoherent_ = d0_ > most_static;
}

void StaticTissue::classify(const KernelPlanes& planes, std::span<float> flow) noexcept {
  const float noise_spread = 1 / std::sqrt(samples_);
  // Speckle of neighbouring A-scans is alike, so residual motion averages over fewer samples.
  const float static_spread = least_spread + d0_ * std::sqrt(2.0F) * noise_spread;
  const auto depths = static_cast<std::ptrdiff_t>(depths_);
  for (int a = 0; a < a_scans_; ++a) {
    float* const line = flow.data() + a * depths;
    const float* const decorrelation = planes.decorrelation.data() + a * depths;
    const float* const level = planes.level.data() + a * depths;
    if (method_ == FlowMethod::complex_bins)
      classify_complex(decorrelation, level, noise_.data(), d0_, noise_spread, static_spread,
                       depths_, line, excess_.data());
    else
      classify_intensity(decorrelation, level, planes.second_moment.data() + a * depths,
                         noise_.data(), d0_, noise_spread, static_spread, depths_, line,
                         excess_.data());
    find_vessels(line, excess_.data(), depths_, vessels_.data());
    if (!(sum_of_squares(vessels_.data(), depths_) > 0))
      continue; // as in most A-scans
    const float* const shadows = greatest_before(vessels_.data(), shadows_.data(), depths_);
    suppress_tails(shadows, excess_.data(), depths_, line);
  }
}

} // namespace octascope::pipeline

#include "ui/panels/projection.h"

#include <algorithm>
#include <array>

namespace octascope::ui {

namespace {

// As many levels as surely add up in 16 bits, which vector instructions add fastest.
constexpr std::size_t chunk = 256;

std::uint32_t sum_of(const std::uint8_t* line, std::size_t depths) {
  std::uint32_t sum = 0;
  for (std::size_t begin = 0; begin < depths; begin += chunk) {
    const std::size_t end = std::min(begin + chunk, depths);
    std::uint16_t part = 0;
    for (std::size_t z = begin; z < end; ++z)
      part = static_cast<std::uint16_t>(part + line[z]);
    sum += part;
  }
  return sum;
}

struct Span {
  std::uint32_t lowest;
  std::uint32_t highest;
};

// The range of the sums without 1 % at either end, to one part in 1024 of the largest possible.
Span robust_range(const pipeline::Volume& volume, std::span<const std::uint32_t> sums) {
  constexpr std::size_t bins = 1024;
  std::array<std::uint32_t, bins + 1> histogram{};
  const auto a_scans = static_cast<std::size_t>(volume.geometry.a_scans);
  const std::uint64_t largest = 255U * static_cast<std::uint64_t>(volume.geometry.depths);
  std::uint32_t count = 0;
  for (std::size_t b = 0; b < volume.b_scan_states.size(); ++b) {
    if (volume.b_scan_states[b] == pipeline::BScanState::missing)
      continue;
    for (const std::uint32_t sum : sums.subspan(b * a_scans, a_scans))
      ++histogram[static_cast<std::size_t>(sum * std::uint64_t{bins} / largest)];
    count += static_cast<std::uint32_t>(a_scans);
  }
  const auto value_at = [&](std::uint32_t rank) {
    std::size_t bin = 0;
    for (std::uint32_t below = histogram[0]; below <= rank && bin < bins; below += histogram[bin])
      ++bin;
    return bin;
  };
  if (count == 0)
    return {0, 1};
  const std::size_t low = value_at(count / 100);
  const std::size_t high = value_at(count - 1 - count / 100);
  return {static_cast<std::uint32_t>(low * largest / bins),
          static_cast<std::uint32_t>((high + 1) * largest / bins)};
}

} // namespace

void project_sum(const pipeline::Volume& volume, std::span<std::uint32_t> out) {
  const auto depths = static_cast<std::size_t>(volume.geometry.depths);
  const std::uint8_t* line = volume.levels.data();
  for (std::uint32_t& sum : out) {
    sum = sum_of(line, depths);
    line += depths;
  }
}

void stretch_contrast(const pipeline::Volume& volume, std::span<const std::uint32_t> sums,
                      std::span<std::uint8_t> out) {
  const Span range = robust_range(volume, sums);
  const float scale = 255.0F / static_cast<float>(std::max(range.highest - range.lowest, 1U));
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const std::uint32_t inside = std::clamp(sums[i], range.lowest, range.highest);
    out[i] = static_cast<std::uint8_t>(static_cast<float>(inside - range.lowest) * scale + 0.5F);
  }
}

} // namespace octascope::ui

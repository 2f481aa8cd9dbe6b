// Random numbers that are reproducible from a key on every machine.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "sim/coronary_tree/morphometry.h"
#include "sim/spectrometer/noise.h"

namespace octascope::sim {

// The n-th number is a hash of the key and n. Different keys give unrelated numbers.
class HashRandom {
public:
  explicit HashRandom(std::uint64_t key) : key_{key} {}

  std::uint64_t bits() { return hash(key_ + 0xd1342543de82ef95U * ++count_); }

  // [0, 1)
  double unit() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }

  // [−1, 1)
  double both_ways() { return 2 * unit() - 1; }

  // 0 … count − 1
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(unit() * static_cast<double>(count));
  }

  // Nearly normal, mean 0, variance 1, within ±3.5: the sum of four uniform numbers.
  double normal() {
    const std::uint64_t b = bits();
    const std::uint64_t sum =
        (b & 0xFFFFU) + (b >> 16U & 0xFFFFU) + (b >> 32U & 0xFFFFU) + (b >> 48U);
    constexpr double sqrt_3 = 1.7320508075688772;
    return (static_cast<double>(sum) / 65535.0 - 2) * sqrt_3;
  }

  // Positive, with this mean and deviation (at most 1.2 times the mean), skewed like lengths: the
  // square of a normal number, whose moments are known in closed form.
  double positive(MeanAndDeviation wanted) {
    const double relative = wanted.deviation / wanted.mean;
    const double spread = 1 - std::sqrt(1 - relative * relative / 2);
    const double root = std::sqrt(1 - spread) + std::sqrt(spread) * normal();
    return wanted.mean * root * root;
  }

  // One of the two integers around a positive value, with the right mean.
  std::size_t rounded(double value) { return static_cast<std::size_t>(value + unit()); }

  template <class T> void shuffle(std::span<T> items) {
    for (std::size_t i = items.size(); i > 1; --i)
      std::swap(items[i - 1], items[below(i)]);
  }

private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

} // namespace octascope::sim

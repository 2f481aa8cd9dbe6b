// Randomness reproducible from a seed: hashes, a table of Gaussian numbers, smooth noise.
//
// Nothing here keeps state, so any line of any volume can be made by any thread, in any order, with
// the same result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace octascope::sim {

// The finaliser of SplitMix64 (Steele, Lea, Flood, 2014): every bit of the input reaches every bit
// of the result.
constexpr std::uint64_t hash(std::uint64_t key) {
  key += 0x9e3779b97f4a7c15U;
  key = (key ^ (key >> 30U)) * 0xbf58476d1ce4e5b9U;
  key = (key ^ (key >> 27U)) * 0x94d049bb133111ebU;
  return key ^ (key >> 31U);
}

constexpr std::uint64_t hash(std::uint64_t a, std::uint64_t b) {
  return hash(hash(a) ^ b);
}
constexpr std::uint64_t hash(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return hash(hash(a, b), c);
}
constexpr std::uint64_t hash(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) {
  return hash(hash(a, b, c), d);
}

// A hash as a number in [0, 1).
constexpr double unit_interval(std::uint64_t key) {
  return static_cast<double>(hash(key) >> 11U) * 0x1p-53;
}

// 2^size_log2 numbers of mean 0 and variance 1, read in runs that begin anywhere. Immutable once
// made, so thread-safe.
class GaussianTable {
public:
  // Runs may be up to `longest_run` numbers long.
  GaussianTable(std::uint64_t seed, int size_log2, std::size_t longest_run);

  // `count` ≤ longest_run numbers; the same key gives the same numbers. Runs of different keys may
  // overlap, so the table should be much larger than a run.
  std::span<const float> run(std::uint64_t key, std::size_t count) const {
    return std::span{values_}.subspan(static_cast<std::size_t>(hash(key)) & mask_, count);
  }

private:
  std::size_t mask_;
  std::vector<float> values_;
};

// Smooth noise in [−1, 1]: random values at integer positions, blended with the smoothstep
// polynomial between them.
float smooth_noise(std::uint64_t seed, float x, float y);
float smooth_noise(std::uint64_t seed, float x, float y, float z);

// Three octaves of it, each of half the size and half the strength, in about [−1, 1].
float rough_noise(std::uint64_t seed, float x, float y);

} // namespace octascope::sim

// A complex bin of an A-scan in 32 bits, as repeats of a B-scan are kept until they are compared.
//
// Each part is the upper half of a float, rounded to the nearest: 8 significant bits. That errs by
// at most a 256th of the part, at random, which is 55 dB below the bin, while a bin's own noise is
// rarely 40 dB below it. All repeats of a B-scan do not fit into the second-level cache: of half the size
// they are stored and read in half the time.
#pragma once

#include <bit>
#include <complex>
#include <cstddef>
#include <cstdint>

namespace octascope::pipeline {

struct PackedBin {
  static constexpr double most_error = 1.0 / 256; // of the bin's modulus
  static constexpr std::uint32_t half_a_step = 0x8000;
  static constexpr std::uint32_t upper_half = 0xFFFF'0000;

  std::uint32_t bits = 0; // real part above, imaginary below

  static PackedBin of(std::complex<float> bin) {
    return {((std::bit_cast<std::uint32_t>(bin.real()) + half_a_step) & upper_half) |
            (std::bit_cast<std::uint32_t>(bin.imag()) + half_a_step) >> 16U};
  }

  float real() const { return std::bit_cast<float>(bits & upper_half); }
  float imaginary() const { return std::bit_cast<float>(bits << 16U); }
  std::complex<float> value() const { return {real(), imaginary()}; }

  friend bool operator==(PackedBin, PackedBin) = default;
};

// Where both are wanted of the same A-scans: as many of each.
struct BinsAndLevels {
  PackedBin* bins;
  std::uint8_t* levels;

  BinsAndLevels operator+(std::ptrdiff_t depths) const { return {bins + depths, levels + depths}; }
};

} // namespace octascope::pipeline

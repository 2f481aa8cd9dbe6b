#include "sim/faults/fault_spectra.h"

#include <algorithm>
#include <cstring>

#include "sim/faults/fault_random.h"

namespace octascope::sim {

void fill_with_frame(std::span<const std::byte> frame, std::span<std::byte> out) {
  while (!out.empty() && !frame.empty()) {
    const std::size_t n = std::min(frame.size(), out.size());
    std::memcpy(out.data(), frame.data(), n);
    out = out.subspan(n);
  }
}

void scramble(std::span<std::byte> bytes, std::uint64_t seed) {
  for (std::uint64_t block = 0; !bytes.empty(); ++block) {
    const std::uint64_t noise = mixed(seed + block);
    const std::size_t n = std::min(sizeof noise, bytes.size());
    std::memcpy(bytes.data(), &noise, n);
    bytes = bytes.subspan(n);
  }
}

int saturate_lines(const hal::LineFormat& format, std::span<std::byte> frame, double line_share,
                   std::uint64_t seed) {
  const auto full_scale =
      static_cast<std::uint16_t>(((1U << format.significant_bits) - 1U) << format.right_shift);
  int lines = 0;
  for (int line = 0; line < format.lines_per_frame; ++line) {
    if (even_number(mixed(seed + static_cast<std::uint64_t>(line))) >= line_share)
      continue;
    ++lines;
    const auto bytes =
        frame.subspan(static_cast<std::size_t>(line) * format.line_bytes(), format.line_bytes());
    if (format.sample_type == hal::SampleType::u8) {
      std::ranges::fill(bytes, static_cast<std::byte>(full_scale));
      continue;
    }
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
      bytes[i] = static_cast<std::byte>(full_scale & 0xffU);
      bytes[i + 1] = static_cast<std::byte>(full_scale >> 8U);
    }
  }
  return lines;
}

} // namespace octascope::sim

#include "hal/linux/kms/drm/edid.h"

#include <algorithm>
#include <array>
#include <numeric>

#include <fmt/format.h>

namespace octascope::hal::linux_backend::kms {

namespace {

constexpr std::size_t block_size = 128;
constexpr std::array<std::uint8_t, 8> header{0, 255, 255, 255, 255, 255, 255, 0};

bool is_base_block(std::span<const std::uint8_t> edid) {
  if (edid.size() < block_size || !std::equal(header.begin(), header.end(), edid.begin()))
    return false;
  const auto block = edid.first(block_size);
  return std::accumulate(block.begin(), block.end(), 0U) % 256 == 0;
}

// 13 characters, ended by a line feed where shorter.
std::string text_of(std::span<const std::uint8_t> characters) {
  std::string text;
  for (const std::uint8_t c : characters) {
    if (c == '\n' || c == 0)
      break;
    text += c >= 0x20 && c < 0x7f ? static_cast<char>(c) : '?';
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

// Three letters of five bits, A = 1.
std::string maker_of(std::span<const std::uint8_t> edid) {
  const unsigned packed = edid[8] * 256U + edid[9];
  std::string maker;
  for (const unsigned shift : {10U, 5U, 0U}) {
    const unsigned letter = packed >> shift & 31U;
    maker += letter >= 1 && letter <= 26 ? static_cast<char>('A' + letter - 1) : '?';
  }
  return maker;
}

} // namespace

std::string monitor_name(std::span<const std::uint8_t> edid) {
  if (!is_base_block(edid))
    return {};
  for (const std::size_t at : {54U, 72U, 90U, 108U}) {
    const auto descriptor = edid.subspan(at, 18);
    const bool is_name = descriptor[0] == 0 && descriptor[1] == 0 && descriptor[3] == 0xfc;
    if (!is_name)
      continue;
    if (std::string name = text_of(descriptor.subspan(5)); !name.empty())
      return name;
  }
  return fmt::format("{} {:04x}", maker_of(edid), edid[10] + edid[11] * 256U);
}

} // namespace octascope::hal::linux_backend::kms

#include "hal/linux/kms/drm/format_blob.h"

#include <cstring>

#include <drm_mode.h>

namespace octascope::hal::linux_backend::kms {

std::vector<FormatModifier> decode_formats(std::span<const std::byte> blob) {
  std::vector<FormatModifier> result;
  drm_format_modifier_blob head{};
  if (blob.size() < sizeof head)
    return result;
  std::memcpy(&head, blob.data(), sizeof head);
  for (std::size_t i = 0; i < head.count_modifiers; ++i) {
    drm_format_modifier modifier{};
    const std::size_t at = head.modifiers_offset + i * sizeof modifier;
    if (at + sizeof modifier > blob.size())
      break;
    std::memcpy(&modifier, blob.data() + at, sizeof modifier);
    for (std::size_t bit = 0; bit < 64; ++bit) {
      const std::size_t index = modifier.offset + bit;
      const std::size_t format_at = head.formats_offset + index * sizeof(std::uint32_t);
      if ((modifier.formats >> bit & 1U) == 0 || index >= head.count_formats ||
          format_at + sizeof(std::uint32_t) > blob.size())
        continue;
      std::uint32_t format = 0;
      std::memcpy(&format, blob.data() + format_at, sizeof format);
      result.push_back({format, modifier.modifier});
    }
  }
  return result;
}

} // namespace octascope::hal::linux_backend::kms

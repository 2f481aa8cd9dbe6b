// Decodes the kernel's list of the pixel formats and layouts that a plane can show. Pure.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/linux/kms/drm/topology.h"

namespace octascope::hal::linux_backend::kms {

// Decodes the property IN_FORMATS (struct drm_format_modifier_blob, drm_mode.h): a header, fourccs,
// and modifiers, each with a 64-bit mask of the fourccs, from an offset on, to which it applies.
// Skips what lies beyond the end of `blob`.
std::vector<FormatModifier> decode_formats(std::span<const std::byte> blob);

} // namespace octascope::hal::linux_backend::kms

// The kernel's list of which pixel formats a plane can show in which layouts. Pure.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/linux/kms/drm/topology.h"

namespace octascope::hal::linux_backend::kms {

// Of the property IN_FORMATS (struct drm_format_modifier_blob, drm_mode.h): a header, fourccs, and
// modifiers that say by a mask of 64 to which fourccs, from an offset on, they belong. What lies
// beyond the bytes is passed over.
std::vector<FormatModifier> decode_formats(std::span<const std::byte> blob);

} // namespace octascope::hal::linux_backend::kms

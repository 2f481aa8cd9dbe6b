// Which card, connector, CRTC, plane and mode show the picture. Pure: topologies in, a choice or
// words out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "hal/linux/kms/drm/topology.h"
#include "hal/linux/kms/mode/mode_choice.h"

namespace octascope::hal::linux_backend::kms {

struct OutputWish {
  std::string connector; // "HDMI-A-1" or "card1:HDMI-A-1"; empty: the first that is connected
  ModeWish mode;
  bool atomic = true; // false: the older calls, even where there are atomic ones
};

struct OutputChoice {
  std::size_t card = 0;      // in the list that was given
  std::size_t connector = 0; // in that card
  std::uint32_t crtc = 0;    // ids from here
  std::uint32_t plane = 0;   // 0: the CRTC's own, which older drivers do not list
  bool atomic = false;
  Mode mode;
};

// ErrorCode::absent: nothing is connected (it may come). ErrorCode::denied: cards there are, but
// they must not be opened. ErrorCode::unsupported: the mode is not to be had, or no CRTC can reach
// the connector.
Result<OutputChoice> choose_output(std::span<const Card> cards, const OutputWish& wish);

// Pixel formats that both the plane can show and EGL can draw, best first: 8 bits a colour without
// alpha before with. `plane` may be null (nothing known: any card can show XRGB8888).
std::vector<std::uint32_t> common_formats(const Plane* plane,
                                          std::span<const std::uint32_t> drawable);

// Of one format, without DRM_FORMAT_MOD_INVALID, which means "unknown" and must not be passed.
std::vector<std::uint64_t> usable_modifiers(const Card& card, const Plane* plane,
                                            std::uint32_t format);

const Plane* find_plane(const Card& card, std::uint32_t id);

} // namespace octascope::hal::linux_backend::kms

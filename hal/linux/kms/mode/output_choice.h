// Chooses the card, connector, CRTC, plane and mode that show the image. Pure: topologies in, a
// choice or an Error out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "hal/linux/kms/drm/topology.h"
#include "hal/linux/kms/mode/mode_choice.h"

namespace octascope::hal::linux_backend::kms {

struct OutputRequest {
  std::string connector; // "HDMI-A-1" or "card1:HDMI-A-1"; empty: the first that is connected
  ModeRequest mode;
  bool atomic = true; // false: the legacy calls, even if the driver has atomic commits
};

struct OutputChoice {
  std::size_t card = 0;      // index into `cards`
  std::size_t connector = 0; // index into the card's connectors
  std::uint32_t crtc = 0;    // an id
  std::uint32_t plane = 0;   // an id; 0: the CRTC's own plane, which older drivers do not list
  bool atomic = false;
  Mode mode;
};

// ErrorCode::absent: nothing is connected yet. ErrorCode::denied: there are cards, but they may not
// be opened. ErrorCode::unsupported: the mode is not available, or no CRTC can drive the connector.
Result<OutputChoice> choose_output(std::span<const Card> cards, const OutputRequest& wanted);

// Pixel formats that the plane can show and EGL can draw, best first: 8 bits per colour, without
// alpha before with alpha. If `plane` is null (unknown), only XRGB8888, which any card can show.
std::vector<std::uint32_t> common_formats(const Plane* plane,
                                          std::span<const std::uint32_t> drawable);

// The plane's modifiers for one format, without DRM_FORMAT_MOD_INVALID, which means "unknown" and
// must not be passed on.
std::vector<std::uint64_t> usable_modifiers(const Card& card, const Plane* plane,
                                            std::uint32_t format);

const Plane* find_plane(const Card& card, std::uint32_t id);

} // namespace octascope::hal::linux_backend::kms

// The kernel's description of its display devices, as plain values: read by card_survey, used by
// output_choice, shown by `devices` and `doctor`.
//
// A card has connectors (sockets), CRTCs (each sends one image in one mode) and planes (from which
// a CRTC takes pixels). Names and ids are the kernel's (drm-kms, docs.kernel.org).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/result.h"

namespace octascope::hal::linux_backend::kms {

// Like the kernel's drm_mode_modeinfo: positions in pixels and lines from the start of the image.
struct Mode {
  std::string name; // "1920x1080"
  std::uint32_t clock_khz = 0;
  std::uint16_t width = 0, hsync_start = 0, hsync_end = 0, htotal = 0, hskew = 0;
  std::uint16_t height = 0, vsync_start = 0, vsync_end = 0, vtotal = 0, vscan = 0;
  std::uint32_t flags = 0; // DRM_MODE_FLAG_…
  std::uint32_t type = 0;  // DRM_MODE_TYPE_…
};

// Full frames per second; 0 if the timings are invalid.
double refresh_hz(const Mode& mode);
bool is_preferred(const Mode& mode);
bool is_interlaced(const Mode& mode);
// "1920x1080@59.94"
std::string to_text(const Mode& mode);

enum class ConnectionStatus : std::uint8_t { connected, disconnected, unknown };

struct Connector {
  std::uint32_t id = 0;
  std::string name; // "HDMI-A-1"
  ConnectionStatus status = ConnectionStatus::unknown;
  bool writeback = false;           // sends to memory, not to a socket
  bool link_good = true;            // false: set the mode again, to retrain the link
  std::string monitor;              // its name from the EDID; may be empty
  std::uint32_t current_crtc = 0;   // an id; 0: none
  std::uint32_t possible_crtcs = 0; // bit i: the card's crtcs[i]
  std::vector<Mode> modes;          // the monitor's order, preferred ones first
};

enum class PlaneKind : std::uint8_t { unknown, overlay, primary, cursor };

struct FormatModifier {
  std::uint32_t format = 0; // fourcc
  std::uint64_t modifier = 0;
};

struct Plane {
  std::uint32_t id = 0;
  PlaneKind kind = PlaneKind::unknown;
  std::uint32_t current_crtc = 0;
  std::uint32_t possible_crtcs = 0;      // as for a connector
  std::vector<std::uint32_t> formats;    // fourcc
  std::vector<FormatModifier> modifiers; // empty: the driver lists none
};

struct Card {
  std::string node;             // "/dev/dri/card0"
  std::string driver;           // "i915"
  std::optional<Error> problem; // why it cannot be used; the following is empty then
  bool atomic = false;          // supports atomic commits
  bool modifiers = false;       // frame buffers may be added with a layout modifier
  bool monotonic = false;       // flips have time stamps of CLOCK_MONOTONIC
  std::vector<Connector> connectors;
  std::vector<std::uint32_t> crtcs; // ids
  std::vector<Plane> planes;        // of all kinds
};

// "card0" for "/dev/dri/card0"
std::string card_name(const Card& card);

} // namespace octascope::hal::linux_backend::kms

// What the configuration's [devices] asks for, device by device.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/clock.h"

namespace octascope::firmware_host {

struct DeviceConfig {
  // The real device if one is plugged in, else the twin.
  static constexpr std::string_view automatic = "auto";
  static constexpr std::string_view twin = "sim";
  static constexpr std::string_view nothing = "none";

  // auto, sim, v4l2 (waited for), a node: "/dev/video0", or a GenICam camera, which is waited for,
  // too: "usb3vision", "usb3vision:NAME", "gigevision:ADDRESS" (hal/linux/aravis).
  std::string line_camera{automatic};
  std::string galvo_trigger{automatic};           // auto, sim, gpio (waited for)
  std::string trigger_line = "octascope-trigger"; // a line's name, or "gpiochip0:17"
  std::string sync_line;                          // likewise; empty: none
  hal::Duration pulse_width = std::chrono::microseconds{50};
  std::string control_input{automatic}; // auto, sim, hid (waited for)
  // Of a control learned with `devices --learn`; takes precedence over the listed ones.
  std::optional<std::filesystem::path> control_device;
  // For the console display: vendor:product of each keyboard that is read; no other is opened.
  std::vector<std::string> keyboards;
  std::string scope_camera{automatic}; // auto, sim, none, libcamera (waited for), or a camera's id
  std::string connector;               // of the console display: "HDMI-A-1"; empty: the first
  std::string mode;                    // "1920x1080@60"; empty: what the monitor prefers
  double overscan_percent = 0;         // share of width and height hidden by the monitor's frame
  bool seat = true;                    // ask the seat daemon for the console; false: open it as
                                       // root

  std::optional<double> exposure_us; // of the line camera; empty: unchanged
  std::optional<int> gain;           // likewise, in the camera's own steps
  std::optional<int> camera_input;   // for a frame grabber with several connectors
  std::string camera_trigger;        // of a GenICam camera: the source that starts a frame; empty:
                                     // as the camera has it
  bool packet_resend = true;         // of a GigE Vision camera: ask for lost packets again

  // How the camera packs its samples; empty: by its pixel format.
  std::optional<int> significant_bits;
  int right_shift = 0;

  bool operator==(const DeviceConfig&) const = default;
};

} // namespace octascope::firmware_host

// Hardware that is plugged in, as the kernel lists it, and whether this user may open it. Opens no
// device.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace octascope::firmware_host {

struct FoundDevice {
  std::string node; // "/dev/video0"; of a display its connector: "card0-HDMI-A-1"
  std::string name; // what the kernel calls it; of a display "connected" or "disconnected"
  // Further facts for people: key ("product", "mode") and value ("05f3:00ff").
  using Fact = std::pair<std::string, std::string>;
  std::vector<Fact> facts{};
  bool usable = true;    // this user can use it now
  std::string why_not{}; // as text; empty if usable
  std::string remedy{};  // a command or an instruction; empty if usable
  std::string held_by{}; // programs that have it open: "pipewire (812)"; only those that this user
                         // may look into
};

// What the machine itself has or lacks, regardless of devices.
struct MachineFacts {
  bool udev_runs = true;
  bool rules_installed = true;             // deploy/70-octascope.rules
  std::vector<std::string> without_driver; // "USB camera 1-2:1.0": plugged in, no driver holds it
  bool has_graphics_card = false;
  bool has_graphics_driver = true; // false: there is a graphics card, but no driver that lists
                                   // connectors
};

struct HardwareSurvey {
  std::vector<FoundDevice> video;    // V4L2 nodes: line cameras, frame grabbers, scope cameras
  std::vector<FoundDevice> media;    // media controllers, which libcamera opens
  std::vector<FoundDevice> gpio;     // GPIO chips
  std::vector<FoundDevice> hid;      // raw HID devices: pedals, knobs, pucks
  std::vector<FoundDevice> input;    // input event nodes of keyboard-type pedals and knobs
  std::vector<FoundDevice> render;   // GPU nodes to draw with
  std::vector<FoundDevice> displays; // connectors of display controllers, with their status
  bool has_window_system = false;    // X11 or Wayland, by the environment
  MachineFacts machine;
};

// The user who asks. `may_open` is access(2) for reading and writing; groups by name.
struct Person {
  std::function<bool(const std::filesystem::path&)> may_open;
  std::vector<std::string> groups;        // of this session
  std::vector<std::string> future_groups; // by the group file: from the next login on
  static Person this_user();
};

// Whether there is X11 or Wayland, by the environment.
bool has_window_system();

// `root` is "/" except in tests, which lay out a folder with /sys, /dev, /run, /etc and /proc.
HardwareSurvey survey_hardware(const std::filesystem::path& root = "/",
                               const Person& person = Person::this_user());

} // namespace octascope::firmware_host

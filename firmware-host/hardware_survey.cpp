#include "firmware-host/hardware_survey.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string_view>

namespace octascope::firmware_host {

namespace fs = std::filesystem;

namespace {

std::string first_line(const fs::path& file) {
  std::ifstream in{file};
  std::string line;
  std::getline(in, line);
  return line;
}

// The value after `key=` in a uevent file.
std::string uevent_value(const fs::path& file, std::string_view key) {
  std::ifstream in{file};
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(key) && line.size() > key.size() && line[key.size()] == '=')
      return line.substr(key.size() + 1);
  }
  return {};
}

// The folders in `folder` whose names start with `prefix`, in the order of their names.
std::vector<fs::path> entries(const fs::path& folder, std::string_view prefix) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator it{folder, error}, end; !error && it != end; it.increment(error)) {
    if (it->path().filename().string().starts_with(prefix))
      found.push_back(it->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string node_of(const fs::path& entry) {
  return "/dev/" + entry.filename().string();
}

} // namespace

HardwareSurvey survey_hardware(const fs::path& root) {
  const fs::path sys = root / "sys";
  HardwareSurvey survey;
  for (const fs::path& entry : entries(sys / "class/video4linux", "video"))
    survey.video.push_back({node_of(entry), first_line(entry / "name")});
  for (const fs::path& entry : entries(sys / "bus/gpio/devices", "gpiochip"))
    survey.gpio.push_back({node_of(entry), uevent_value(entry / "uevent", "OF_FULLNAME")});
  for (const fs::path& entry : entries(sys / "class/hidraw", "hidraw"))
    survey.hid.push_back({node_of(entry), uevent_value(entry / "device/uevent", "HID_NAME")});
  for (const fs::path& entry : entries(sys / "class/drm", "card")) {
    const std::string status = first_line(entry / "status"); // connectors alone have one
    if (!status.empty())
      survey.displays.push_back({entry.filename().string(), status});
  }
  survey.has_window_system =
      std::getenv("WAYLAND_DISPLAY") != nullptr || std::getenv("DISPLAY") != nullptr;
  return survey;
}

} // namespace octascope::firmware_host

#include "hal/linux/libcamera/camera_choice.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"
#include "hal/linux/system/system_files.h"

namespace octascope::hal::linux_backend {

namespace {

namespace fs = std::filesystem;

std::string list(const std::vector<LibcameraFound>& found) {
  std::string text;
  for (const LibcameraFound& camera : found)
    text += fmt::format("{}\"{}\" (id {}{})", text.empty() ? "" : ", ", camera.model, camera.id,
                        camera.taken ? ", the line camera" : "");
  return text;
}

template <class Suits>
std::optional<std::size_t> first(const std::vector<LibcameraFound>& found, Suits suits) {
  const auto it = std::ranges::find_if(found, suits);
  if (it == found.end())
    return std::nullopt;
  return static_cast<std::size_t>(it - found.begin());
}

// Each architecture has a folder of its own in usr/lib.
bool has_ipa_modules(const fs::path& root) {
  return std::ranges::any_of(entries(root / "usr/lib"), [](const fs::path& folder) {
    return !entries(folder / "libcamera", "ipa_").empty();
  });
}

} // namespace

Result<std::size_t> choose_camera(const std::vector<LibcameraFound>& found,
                                  const std::string& wanted) {
  if (wanted.empty()) {
    if (const auto free = first(found, [](const LibcameraFound& c) { return !c.taken; }))
      return *free;
    return fail(ErrorCode::absent, "scope camera: found only {}, expected one more; plug it in",
                list(found));
  }
  if (const auto same = first(
          found, [&](const LibcameraFound& c) { return c.id == wanted || c.model == wanted; }))
    return *same;
  if (const auto part = first(found, [&](const LibcameraFound& c) {
        return c.id.find(wanted) != std::string::npos || c.model.find(wanted) != std::string::npos;
      }))
    return *part;
  return fail(
      ErrorCode::absent,
      "scope camera: expected \"{}\", found {}; plug it in, or name one of those that are there",
      wanted, list(found));
}

Error explain_absence(const fs::path& root) {
  std::error_code error;
  if (!fs::exists(root / "run/udev/control", error))
    return {ErrorCode::absent,
            "scope camera: no udev daemon runs, and libcamera finds no camera without one; start "
            "it: sudo systemctl start systemd-udevd systemd-udev-trigger"};
  const std::vector<fs::path> nodes = entries(root / "dev", "media");
  const auto refused = std::ranges::find_if(
      nodes, [](const fs::path& node) { return ::access(node.c_str(), R_OK | W_OK) != 0; });
  if (refused != nodes.end() && udev_is_at_work(root))
    return {ErrorCode::absent, fmt::format("scope camera: udev has not gone through /dev/{} yet; "
                                           "it is tried again by itself",
                                           refused->filename().string())};
  if (refused != nodes.end())
    return {ErrorCode::denied,
            fmt::format("scope camera: /dev/{} is there, but this user may not open it; join its "
                        "group: sudo usermod -aG video $USER, then log in again",
                        refused->filename().string())};
  if (!nodes.empty() && !has_ipa_modules(root))
    return {ErrorCode::absent,
            "scope camera: a camera may be there, but the modules by which libcamera steers "
            "cameras are not installed: sudo apt-get install libcamera-ipa"};
  if (nodes.empty())
    return {ErrorCode::absent, "scope camera: no camera is plugged in (there is no /dev/media*); "
                               "check the plug and the cable; it is tried again by itself"};
  return {ErrorCode::absent,
          fmt::format("scope camera: {} media device{} plugged in, but libcamera knows no camera "
                      "among them; LIBCAMERA_LOG_LEVELS=*:DEBUG says why, `cam --list` lists what "
                      "it knows",
                      nodes.size(), nodes.size() == 1 ? " is" : "s are")};
}

} // namespace octascope::hal::linux_backend

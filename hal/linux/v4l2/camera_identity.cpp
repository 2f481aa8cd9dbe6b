#include "hal/linux/v4l2/camera_identity.h"

#include <system_error>

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include "hal/linux/system/system_files.h"

namespace octascope::hal::linux_backend {

namespace fs = std::filesystem;

namespace {

// A video node hangs below an interface of its USB device, and that below the device itself. No
// device is so deep that looking further would find its own.
constexpr int most_levels = 4;

std::string trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos)
    return {};
  return std::string{text.substr(first, text.find_last_not_of(blank) - first + 1)};
}

std::string plain(std::string_view text) {
  std::string clean = trimmed(text);
  for (char& c : clean)
    if (const auto code = static_cast<unsigned char>(c);
        code < 0x20 || code == 0x7F || c == '"' || c == '\\')
      c = '?';
  return clean;
}

} // namespace

fs::path sysfs_folder(const FileDescriptor& node) {
  struct stat status {};
  if (::fstat(node.get(), &status) != 0)
    return {};
  return fmt::format("/sys/dev/char/{}:{}/device", major(status.st_rdev), minor(status.st_rdev));
}

std::string usb_serial_number(const fs::path& folder) {
  std::error_code error;
  fs::path level = fs::canonical(folder, error);
  for (int i = 0; !error && i < most_levels; ++i, level = level.parent_path()) {
    // Other buses have files of this name that mean something else.
    if (fs::exists(level / "idVendor", error))
      return trimmed(first_line(level / "serial"));
  }
  return {};
}

std::string camera_identity(std::string_view card, std::string_view serial_number) {
  const std::string serial = plain(serial_number);
  return plain(card) + (serial.empty() ? ", no serial number" : ", serial " + serial);
}

} // namespace octascope::hal::linux_backend

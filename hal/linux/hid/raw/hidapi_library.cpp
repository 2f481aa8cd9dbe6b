#include "hal/linux/hid/raw/hidapi_library.h"

#include <string_view>

#include <dlfcn.h>
#include <hidapi.h>

namespace octascope::hal::linux_backend {

namespace {

// The process's, as what they guard and count is.
std::mutex guard;
int users = 0;

} // namespace

HidapiLibrary::HidapiLibrary() {
  const std::lock_guard lock{guard};
  if (users++ == 0)
    hid_init(); // what it cannot have is told by the call that needs it
}

HidapiLibrary::~HidapiLibrary() {
  const std::lock_guard lock{guard};
  if (--users == 0)
    hid_exit();
}

std::unique_lock<std::mutex> HidapiLibrary::lock() const {
  return std::unique_lock{guard};
}

} // namespace octascope::hal::linux_backend

#if HID_API_VERSION < HID_API_MAKE_VERSION(0, 15, 0)
// Before 0.15 hid_enumerate() measures the text of a device's "uevent" and crashes where there is
// none, because the device was just pulled out (libusb/hidapi pull request 580). This stands before
// libudev's function, for hidapi too: then the text is empty, and the device is passed over.
struct udev_device;
extern "C" const char* udev_device_get_sysattr_value(udev_device* device, const char* name) {
  using Function = const char*(udev_device*, const char*);
  static auto* const libudevs =
      reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "udev_device_get_sysattr_value"));
  const char* const value = libudevs(device, name);
  return value == nullptr && std::string_view{name} == "uevent" ? "" : value;
}
#endif

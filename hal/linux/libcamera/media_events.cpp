#include "hal/linux/libcamera/media_events.h"

#include <string_view>

#include <dlfcn.h>
#include <libcamera/camera_manager.h>
#include <libudev.h>

namespace octascope::hal::linux_backend {

namespace {

bool is_of_libcamera(const void* code) {
  Dl_info module{};
  return ::dladdr(code, &module) != 0 && module.dli_fname != nullptr &&
         std::string_view{module.dli_fname}.find("/libcamera.so") != std::string_view::npos;
}

} // namespace

// What calls this has the function below in its program: nothing else would make the linker take it.
int start_without_video_nodes(libcamera::CameraManager& manager) {
  return manager.start();
}

} // namespace octascope::hal::linux_backend

// This stands before libudev's function, for libcamera too. To narrow the watch afterwards would be too late:
// libcamera's thread listens before its manager has started.
extern "C" int udev_monitor_filter_add_match_subsystem_devtype(udev_monitor* monitor,
                                                               const char* subsystem,
                                                               const char* devtype) {
  using Function = int(udev_monitor*, const char*, const char*);
  static auto* const of_libudev = reinterpret_cast<Function*>(
      ::dlsym(RTLD_NEXT, "udev_monitor_filter_add_match_subsystem_devtype"));
  if (octascope::hal::linux_backend::is_of_libcamera(__builtin_return_address(0)) &&
      std::string_view{subsystem} == "video4linux")
    return 0;
  return of_libudev(monitor, subsystem, devtype);
}

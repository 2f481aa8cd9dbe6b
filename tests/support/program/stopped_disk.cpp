// A disk that stands still, for a program that is started with this library before the others
// (LD_PRELOAD): while there is a file of the name in OCTASCOPE_STOPPED_DISK, whatever the program
// writes at a place of a file in the same folder, and has the disk sync, waits.
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <dlfcn.h>
#include <sys/types.h>
#include <unistd.h>

namespace {

// Without memory of its own: it may be called anywhere.
bool lies_beside(int descriptor, std::string_view name) {
  char link[64];
  char file[4096];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = ::readlink(link, file, sizeof file);
  return length > 0 && std::string_view{file, static_cast<std::size_t>(length)}.starts_with(
                           name.substr(0, name.rfind('/') + 1));
}

void wait_while_stopped(int descriptor) {
  const char* const name = std::getenv("OCTASCOPE_STOPPED_DISK");
  while (name != nullptr && ::access(name, F_OK) == 0 && lies_beside(descriptor, name))
    ::usleep(1000);
}

template <class Function> Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

} // namespace

extern "C" ssize_t pwrite64(int descriptor, const void* bytes, size_t size, off64_t offset) {
  static const auto write = next<decltype(&pwrite64)>("pwrite64");
  wait_while_stopped(descriptor);
  return write(descriptor, bytes, size, offset);
}

extern "C" ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t offset) {
  static const auto write = next<decltype(&pwrite)>("pwrite");
  wait_while_stopped(descriptor);
  return write(descriptor, bytes, size, offset);
}

extern "C" int fdatasync(int descriptor) {
  static const auto sync = next<decltype(&fdatasync)>("fdatasync");
  wait_while_stopped(descriptor);
  return sync(descriptor);
}

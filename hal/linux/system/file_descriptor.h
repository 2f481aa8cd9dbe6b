// A file descriptor that is closed once, and an ioctl that signals cannot break off.
#pragma once

#include <cerrno>
#include <utility>

#include <sys/ioctl.h>
#include <unistd.h>

namespace octascope::hal::linux_backend {

class FileDescriptor {
public:
  FileDescriptor() = default;
  explicit FileDescriptor(int descriptor) : descriptor_{descriptor} {}
  FileDescriptor(FileDescriptor&& other) noexcept
      : descriptor_{std::exchange(other.descriptor_, -1)} {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    if (this != &other) {
      reset();
      descriptor_ = std::exchange(other.descriptor_, -1);
    }
    return *this;
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() { reset(); }

  int get() const { return descriptor_; }
  explicit operator bool() const { return descriptor_ >= 0; }

  void reset() {
    // Linux frees the number whatever close() says: it must not be tried again.
    if (descriptor_ >= 0)
      ::close(std::exchange(descriptor_, -1));
  }

private:
  int descriptor_ = -1;
};

// As ioctl(2), begun again where a signal broke it off; errno says why it is −1.
template <class Argument>
int control(const FileDescriptor& file, unsigned long request, Argument* argument) {
  int result = -1;
  do {
    result = ::ioctl(file.get(), request, argument);
  } while (result == -1 && errno == EINTR);
  return result;
}

} // namespace octascope::hal::linux_backend

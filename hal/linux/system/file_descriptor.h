// An owned file descriptor, and an ioctl that is retried after a signal.
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
    // Linux frees the descriptor even if close() fails: never close it twice.
    if (descriptor_ >= 0)
      ::close(std::exchange(descriptor_, -1));
  }

private:
  int descriptor_ = -1;
};

// Like ioctl(2), but retried after EINTR. On −1, errno has the reason.
template <class Argument>
int control(const FileDescriptor& file, unsigned long request, Argument* argument) {
  int result = -1;
  do {
    result = ::ioctl(file.get(), request, argument);
  } while (result == -1 && errno == EINTR);
  return result;
}

} // namespace octascope::hal::linux_backend

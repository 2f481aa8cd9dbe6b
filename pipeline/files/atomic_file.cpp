#include "pipeline/files/atomic_file.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

tl::unexpected<hal::Error> system_failure(const fs::path& file, std::string_view action) {
  const int reason = errno;
  const ErrorCode fault = reason == ENOENT                      ? ErrorCode::absent
                          : reason == EACCES || reason == EROFS ? ErrorCode::denied
                                                                : ErrorCode::system;
  return hal::fail(fault, "{}: cannot {}: {}", file.string(), action,
                   std::generic_category().message(reason));
}

} // namespace

// A file system that cannot do it (EINVAL) has nothing to be written.
hal::Result<> sync_folder_of(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path{"."};
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    return errno == EACCES ? hal::Result<>{} : system_failure(file, "be found in its folder");
  const bool synced = ::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS;
  const int reason = errno;
  ::close(descriptor);
  errno = reason;
  return synced ? hal::Result<>{} : system_failure(file, "be kept in its folder on the disk");
}

hal::Result<AtomicFile> AtomicFile::create(const fs::path& destination, Readers readers) {
  std::error_code error;
  const fs::file_status status = fs::status(destination, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    return hal::fail(ErrorCode::invalid_argument,
                     "{}: is a {}, expected the name of a file to write", destination.string(),
                     fs::is_directory(status) ? "directory" : "device or the like");
  if (!destination.has_filename())
    return hal::fail(ErrorCode::invalid_argument, "\"{}\": expected the name of a file to write",
                     destination.string());
  // Through a link, so that the file it points at is replaced and not the link.
  const fs::path target = fs::is_symlink(fs::symlink_status(destination, error))
                              ? fs::weakly_canonical(destination, error)
                              : destination;
  fs::path temporary = target;
  temporary.replace_filename(fmt::format(".{}.part-{}", target.filename().string(), ::getpid()));
  const mode_t mode = readers == Readers::owner ? 0600 : 0666; // and less, if the umask says so
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode);
  if (descriptor < 0)
    return system_failure(destination, "be written, no file can be made in its folder");
  return AtomicFile{descriptor, target, std::move(temporary)};
}

AtomicFile::AtomicFile(int descriptor, fs::path destination, fs::path temporary)
    : descriptor_(descriptor), destination_(std::move(destination)),
      temporary_(std::move(temporary)) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      destination_(std::move(other.destination_)), temporary_(std::exchange(other.temporary_, {})) {
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0)
    ::close(descriptor_);
  if (!temporary_.empty())
    ::unlink(temporary_.c_str());
}

hal::Result<> AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR)
      continue;
    if (written < 0)
      return system_failure(destination_, "be written");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
  return {};
}

hal::Result<> AtomicFile::commit() {
  if (::fsync(descriptor_) != 0)
    return system_failure(destination_, "be written to the disk");
  if (::close(std::exchange(descriptor_, -1)) != 0)
    return system_failure(destination_, "be closed");
  if (::rename(temporary_.c_str(), destination_.c_str()) != 0)
    return system_failure(destination_, "be put in place");
  temporary_.clear();
  return sync_folder_of(destination_);
}

hal::Result<> write_atomically(const fs::path& file, std::string_view text) {
  HAL_TRY(auto made, AtomicFile::create(file));
  HAL_CHECK(made.write_at(0, std::as_bytes(std::span{text})));
  return made.commit();
}

} // namespace octascope::pipeline

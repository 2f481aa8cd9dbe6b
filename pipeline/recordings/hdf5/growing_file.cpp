#include "pipeline/recordings/hdf5/growing_file.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace octascope::pipeline {

namespace {

constexpr std::size_t most_dimensions = 4;
constexpr hsize_t page = 4096;

// To open a file that a reader has locked.
constexpr int attempts = 50;
constexpr std::chrono::milliseconds between_attempts{20};

// A name of the open file itself, wherever it has been moved to.
std::string own_name(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

bool is_file(const std::filesystem::path& path, const struct stat& file) {
  struct stat found = {};
  return ::stat(path.c_str(), &found) == 0 && found.st_dev == file.st_dev &&
         found.st_ino == file.st_ino;
}

// A disk that hangs does so here, and not under the lock that HDF5 has for all files: recordings on
// other disks go on. HDF5 empties the file, and tells of a disk that refuses.
void await_disk(int descriptor) {
  if (::pwrite(descriptor, "", 1, 0) == 1)
    static_cast<void>(::fdatasync(descriptor));
}

// A reader that looks whether the file is there yet holds it locked for a moment.
Hdf5Handle begin_file(const std::string& path, hid_t access) {
  const auto begin = [&] {
    return Hdf5Handle{H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose};
  };
  Hdf5Handle file = begin();
  for (int i = 1;
       i < attempts && !file.valid() && hdf5_reason().find("unable to lock") != std::string::npos;
       ++i) {
    std::this_thread::sleep_for(between_attempts);
    file = begin();
  }
  return file;
}

} // namespace

Hdf5Handle make_growing_dataset(hid_t file, const char* name, hid_t type,
                                std::span<const hsize_t> chunk, Chunks chunks) {
  hsize_t none[most_dimensions];
  hsize_t most[most_dimensions];
  std::ranges::copy(chunk, none);
  std::ranges::copy(chunk, most);
  none[0] = 0;
  most[0] = H5S_UNLIMITED;
  const int rank = static_cast<int>(chunk.size());
  const Hdf5Handle space{H5Screate_simple(rank, none, most), H5Sclose};
  const Hdf5Handle made{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
  const Hdf5Handle access{H5Pcreate(H5P_DATASET_ACCESS), H5Pclose};
  if (H5Pset_chunk(made, rank, chunk.data()) < 0)
    return {};
  if (chunks == Chunks::written_whole && H5Pset_chunk_cache(access, 0, 0, 0) < 0)
    return {};
  return {H5Dcreate2(file, name, type, space, H5P_DEFAULT, made, access), H5Dclose};
}

bool append_row(hid_t dataset, hid_t type, std::span<const hsize_t> size, const void* row) {
  if (H5Dset_extent(dataset, size.data()) < 0)
    return false;
  hsize_t start[most_dimensions]{};
  hsize_t count[most_dimensions];
  std::ranges::copy(size, count);
  start[0] = size[0] - 1;
  count[0] = 1;
  const Hdf5Handle to{H5Dget_space(dataset), H5Sclose};
  const Hdf5Handle from{H5Screate_simple(static_cast<int>(size.size()), count, nullptr), H5Sclose};
  return H5Sselect_hyperslab(to, H5S_SELECT_SET, start, nullptr, count, nullptr) >= 0 &&
         H5Dwrite(dataset, type, from, to, H5P_DEFAULT, row) >= 0;
}

bool append_chunk(hid_t dataset, std::span<const hsize_t> size, std::span<const std::byte> chunk) {
  hsize_t offset[most_dimensions]{};
  offset[0] = size[0] - 1;
  return H5Dset_extent(dataset, size.data()) >= 0 &&
         H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, offset, chunk.size(), chunk.data()) >= 0;
}

GrowingFile::GrowingFile(std::filesystem::path path, int descriptor)
    : path_(std::move(path)), descriptor_(descriptor) {}

// After a failure HDF5 would write of places that the file does not reach to, and nobody could read
// it any more: it is never closed, and stays as it was flushed last.
GrowingFile::~GrowingFile() {
  if (broken_)
    file_.leave_open();
}

hal::Result<std::unique_ptr<GrowingFile>>
GrowingFile::create(const std::filesystem::path& path, const std::function<bool(hid_t)>& fill,
                    std::size_t aligned_bytes) {
  // Made by us, so that nobody but the owner may read it from the first byte on.
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) {
    const int reason = errno;
    return hal::fail(reason == EEXIST   ? hal::ErrorCode::invalid_argument
                     : reason == ENOENT ? hal::ErrorCode::absent
                     : reason == EACCES ? hal::ErrorCode::denied
                                        : hal::ErrorCode::system,
                     "{}: cannot be made: {}{}", path.string(), std::strerror(reason),
                     reason == EEXIST ? "; a recording is never written over" : "");
  }
  auto made = std::unique_ptr<GrowingFile>(new GrowingFile{path, descriptor});
  await_disk(descriptor);
  const Hdf5Handle access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST); // for readers who look on
  if (aligned_bytes > 0)
    H5Pset_alignment(access, aligned_bytes, page);
  // The file that was made: by its path, another one would be made in the place of one that is gone.
  made->file_ = begin_file(own_name(descriptor), access);
  if (!made->file_.valid() || !fill(made->file_) || H5Fstart_swmr_write(made->file_) < 0) {
    const auto error = made->failed("cannot be begun");
    HAL_CHECK(made->check_place());
    made.reset();
    std::error_code ignored;
    std::filesystem::remove(path, ignored); // there is nothing in it
    return error;
  }
  return made;
}

tl::unexpected<hal::Error> GrowingFile::failed(std::string_view what) {
  const std::string reason = hdf5_reason();
  broken_ = true;
  return hal::fail(hal::ErrorCode::system, "{}: {}: {}{}", path_.string(), what, reason,
                   reason.find("No space") == std::string::npos ? ""
                                                                : "; free some room on the disk");
}

hal::Result<> GrowingFile::check_place() const {
  struct stat own = {};
  if (::fstat(descriptor_, &own) != 0)
    return hal::fail(hal::ErrorCode::system, "{}: cannot be looked at: {}", path_.string(),
                     std::strerror(errno));
  if (is_file(path_, own))
    return {};
  std::error_code error;
  const bool replaced = std::filesystem::exists(path_, error);
  const auto moved_to = std::filesystem::read_symlink(own_name(descriptor_), error);
  return hal::fail(hal::ErrorCode::absent,
                   "{}: {} while it was being recorded: what was recorded {}", path_.string(),
                   replaced ? "another file took its place" : "was removed or moved",
                   own.st_nlink == 0        ? std::string{"is lost"}
                   : is_file(moved_to, own) ? fmt::format("is in {}", moved_to.string())
                                            : std::string{"has another name"});
}

hal::Result<> GrowingFile::sync() {
  if (::fdatasync(descriptor_) == 0)
    return check_place();
  broken_ = true;
  return hal::fail(hal::ErrorCode::system, "{}: cannot be written to the disk: {}", path_.string(),
                   std::strerror(errno));
}

// By whatever name it has now. A reader that is just opening it holds it locked for a moment.
Hdf5Handle GrowingFile::open_once_more() const {
  Hdf5Handle again{H5Fopen(own_name(descriptor_).c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
  for (int i = 1; i < attempts && !again.valid() && check_place(); ++i) {
    std::this_thread::sleep_for(between_attempts);
    again = {H5Fopen(own_name(descriptor_).c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
  }
  return again;
}

// Attributes cannot change while readers may look on: the file is closed and opened once more.
hal::Result<> GrowingFile::finish(const std::function<bool(hid_t)>& mark) {
  if (broken_)
    return hal::fail(hal::ErrorCode::system,
                     "{}: was not finished, as it could not be written: what was flushed is there",
                     path_.string());
  if (file_.close() < 0)
    return failed("cannot be closed");
  const Hdf5Handle again = open_once_more();
  if (!again.valid() || !mark(again) || H5Fflush(again, H5F_SCOPE_LOCAL) < 0) {
    const auto error = failed("cannot be marked as finished");
    HAL_CHECK(check_place()); // the better reason
    return error;
  }
  return sync();
}

} // namespace octascope::pipeline

#include "pipeline/recordings/recording_writer.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pipeline/recordings/descriptor.h"
#include "pipeline/recordings/hdf5.h"
#include "pipeline/recordings/recording_attributes.h"
#include "pipeline/recordings/recording_layout.h"

namespace octascope::pipeline {

namespace layout = recording_layout;

namespace {

constexpr hsize_t entries_a_chunk = 256;

// A dataset that grows along its first dimension. Chunks are not cached: each is written once,
// whole.
Hdf5Handle make_dataset(hid_t file, const char* name, hid_t type, std::span<const hsize_t> chunk) {
  hsize_t none[4];
  hsize_t most[4];
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
  if (rank == 4 && H5Pset_chunk_cache(access, 0, 0, 0) < 0)
    return {};
  return {H5Dcreate2(file, name, type, space, H5P_DEFAULT, made, access), H5Dclose};
}

// Makes room for one more and writes it there.
bool append_row(hid_t dataset, hid_t type, std::span<const hsize_t> size, const void* row) {
  if (H5Dset_extent(dataset, size.data()) < 0)
    return false;
  hsize_t start[4]{};
  hsize_t count[4];
  std::ranges::copy(size, count);
  start[0] = size[0] - 1;
  count[0] = 1;
  const Hdf5Handle to{H5Dget_space(dataset), H5Sclose};
  const Hdf5Handle from{H5Screate_simple(static_cast<int>(size.size()), count, nullptr), H5Sclose};
  return H5Sselect_hyperslab(to, H5S_SELECT_SET, start, nullptr, count, nullptr) >= 0 &&
         H5Dwrite(dataset, type, from, to, H5P_DEFAULT, row) >= 0;
}

} // namespace

struct RecordingWriter::File {
  File(std::filesystem::path p, int d) : path(std::move(p)), descriptor(d) {}

  tl::unexpected<hal::Error> failed(std::string_view what) {
    const std::string reason = hdf5_reason();
    broken = true;
    return hal::fail(hal::ErrorCode::system, "{}: {}: {}{}", path.string(), what, reason,
                     reason.find("No space") == std::string::npos ? ""
                                                                  : "; free some room on the disk");
  }
  hal::Result<> check_place() const;
  Hdf5Handle open_once_more() const;
  bool make_datasets();
  bool append_levels(const Volume& volume);
  bool flush() { return H5Dflush(levels) >= 0 && H5Dflush(states) >= 0 && H5Dflush(metadata) >= 0; }

  std::filesystem::path path;
  Descriptor descriptor; // of the same file, to have it written to the disk
  VolumeGeometry geometry;
  hsize_t volumes = 0;
  bool broken = false;
  Hdf5Handle file, levels, states, metadata, entry_type; // the file closes last but for its types
};

// A name of the open file itself, wherever it has been moved to.
std::string own_name(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

bool is_file(const std::filesystem::path& path, const struct stat& file) {
  struct stat found = {};
  return ::stat(path.c_str(), &found) == 0 && found.st_dev == file.st_dev &&
         found.st_ino == file.st_ino;
}

hal::Result<> RecordingWriter::File::check_place() const {
  struct stat own = {};
  if (::fstat(descriptor, &own) != 0)
    return hal::fail(hal::ErrorCode::system, "{}: cannot be looked at: {}", path.string(),
                     std::strerror(errno));
  if (is_file(path, own))
    return {};
  std::error_code error;
  const bool replaced = std::filesystem::exists(path, error);
  const auto moved_to = std::filesystem::read_symlink(own_name(descriptor), error);
  return hal::fail(hal::ErrorCode::absent,
                   "{}: {} while it was being recorded: what was recorded {}", path.string(),
                   replaced ? "another file took its place" : "was removed or moved",
                   own.st_nlink == 0        ? std::string{"is lost"}
                   : is_file(moved_to, own) ? fmt::format("is in {}", moved_to.string())
                                            : std::string{"has another name"});
}

bool RecordingWriter::File::make_datasets() {
  entry_type = layout::ledger_type();
  levels = make_dataset(file, layout::levels, H5T_STD_U8LE, layout::levels_size(geometry, 1));
  states = make_dataset(file, layout::b_scan_states, H5T_STD_U8LE,
                        layout::states_size(geometry, entries_a_chunk));
  metadata = make_dataset(file, layout::metadata, entry_type, std::array{entries_a_chunk});
  return levels.valid() && states.valid() && metadata.valid();
}

// As one chunk, past HDF5's buffers.
bool RecordingWriter::File::append_levels(const Volume& volume) {
  const auto size = layout::levels_size(geometry, volumes + 1);
  const std::array<hsize_t, 4> offset{volumes, 0, 0, 0};
  return H5Dset_extent(levels, size.data()) >= 0 &&
         H5Dwrite_chunk(levels, H5P_DEFAULT, 0, offset.data(), volume.levels.size(),
                        volume.levels.data()) >= 0;
}

RecordingWriter::RecordingWriter(std::unique_ptr<File> file) : file_(std::move(file)) {}
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&&) noexcept = default;

RecordingWriter::~RecordingWriter() {
  const Hdf5Silence silence;
  file_.reset();
}

hal::Result<RecordingWriter> RecordingWriter::create(const std::filesystem::path& path,
                                                     const RecordingFacts& facts) {
  const Hdf5Silence silence;
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
  auto made = std::make_unique<File>(path, descriptor);
  made->geometry = facts.geometry;
  const Hdf5Handle access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST); // for readers who look on
  made->file = {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose};
  if (!made->file.valid() || !write_facts(made->file, facts) || !made->make_datasets() ||
      H5Fstart_swmr_write(made->file) < 0) {
    const auto error = made->failed("cannot be begun");
    made.reset();
    std::error_code ignored;
    std::filesystem::remove(path, ignored); // there is nothing in it
    return error;
  }
  return RecordingWriter{std::move(made)};
}

hal::Result<> RecordingWriter::append(const Volume& volume, const RecordedVolume& entry) {
  const Hdf5Silence silence;
  File& f = *file_;
  if (f.broken || volume.geometry != f.geometry)
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        "{}: found a volume {}, expected one of the recording's own geometry, before any failure",
        f.path.string(), f.broken ? "after a failure" : "of another one");
  const std::array<hsize_t, 1> rows{f.volumes + 1};
  if (!f.append_levels(volume) ||
      !append_row(f.states, H5T_NATIVE_UINT8, layout::states_size(f.geometry, rows[0]),
                  volume.b_scan_states.data()) ||
      !append_row(f.metadata, f.entry_type, rows, &entry) || !f.flush())
    return f.failed("a volume cannot be written");
  ++f.volumes;
  return {};
}

hal::Result<> RecordingWriter::sync() {
  if (::fdatasync(file_->descriptor) == 0)
    return file_->check_place();
  file_->broken = true;
  return hal::fail(hal::ErrorCode::system, "{}: cannot be written to the disk: {}",
                   file_->path.string(), std::strerror(errno));
}

// By whatever name it has now. A reader that is just opening it holds it locked for a moment.
Hdf5Handle RecordingWriter::File::open_once_more() const {
  using namespace std::chrono_literals;
  constexpr int attempts = 50;
  Hdf5Handle again{H5Fopen(own_name(descriptor).c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
  for (int i = 1; i < attempts && !again.valid() && check_place(); ++i) {
    std::this_thread::sleep_for(20ms);
    again = {H5Fopen(own_name(descriptor).c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
  }
  return again;
}

// Attributes cannot change while readers may look on: the file is closed and opened once more.
hal::Result<> RecordingWriter::finish(const RecordingEnd& end) {
  const Hdf5Silence silence;
  File& f = *file_;
  bool closed = true;
  for (Hdf5Handle* const handle : {&f.metadata, &f.states, &f.levels, &f.file})
    closed = handle->close() >= 0 && closed;
  if (!closed)
    return f.failed("cannot be closed");
  const Hdf5Handle again = f.open_once_more();
  RecordingEnd finished = end;
  finished.finished = true;
  if (!again.valid() || !write_end(again, finished) || H5Fflush(again, H5F_SCOPE_LOCAL) < 0) {
    const auto failed = f.failed("cannot be marked as finished");
    HAL_CHECK(f.check_place()); // the better reason
    return failed;
  }
  return sync();
}

} // namespace octascope::pipeline

#include "pipeline/recordings/hdf5/reading.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pipeline/recordings/hdf5/hdf5_head.h"

namespace octascope::pipeline {

namespace {

// What is being written just now is tried again, after waits that double from a nanosecond on: so
// many attempts take milliseconds. HDF5's own hundred would take for ever where a file is damaged.
constexpr unsigned read_attempts = 22;

// Nor is what a file of its size cannot hold, even if another program packed it: deflate, the
// tightest of HDF5's own filters, makes no more of a byte.
constexpr double most_bytes_of_a_byte = 1032;

// HDF5 reads and writes at places: where the file is at plays no part.
std::optional<int> descriptor_of(hid_t file) {
  void* descriptor = nullptr;
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &descriptor) < 0)
    return std::nullopt;
  return *static_cast<const int*>(descriptor);
}

double bytes_of(std::span<const hsize_t> sizes, std::size_t element_bytes) {
  double bytes = static_cast<double>(element_bytes);
  for (const hsize_t size : sizes)
    bytes *= static_cast<double>(size);
  return bytes;
}

// Of a dataset that holds something: all of it, and one chunk.
hal::Result<> check_claims(hid_t dataset, const char* name, std::span<const hsize_t> sizes,
                           std::size_t element_bytes) {
  const Hdf5Handle file{H5Iget_file_id(dataset), H5Fclose};
  const std::uint64_t file_bytes = stored_bytes(file);
  const Hdf5Handle made{H5Dget_create_plist(dataset), H5Pclose};
  std::array<hsize_t, 4> chunk{};
  double claimed = bytes_of(sizes, element_bytes);
  if (claimed > 0 && H5Pget_layout(made) == H5D_CHUNKED &&
      H5Pget_chunk(made, static_cast<int>(chunk.size()), chunk.data()) > 0)
    claimed = std::max(claimed, bytes_of(std::span{chunk}.first(sizes.size()), element_bytes));
  if (claimed <= most_bytes_of_a_byte * static_cast<double>(file_bytes))
    return {};
  return hal::fail(hal::ErrorCode::bad_data,
                   "/{}: found {:.4g} bytes of it claimed, expected what a file of {} bytes can "
                   "hold: the file is damaged, or another program changed it",
                   name, claimed, file_bytes);
}

} // namespace

// The file itself, before HDF5 looks at it.
hal::Result<> check_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    return hal::fail(hal::ErrorCode::absent, "there is no such file");
  if (std::filesystem::is_directory(status))
    return hal::fail(hal::ErrorCode::invalid_argument, "found a folder, expected a recording");
  if (!std::filesystem::is_regular_file(status)) // HDF5 would wait for what comes out of a pipe
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "found a pipe or a device, expected a recording");
  if (::access(path.c_str(), R_OK) != 0)
    return hal::fail(hal::ErrorCode::denied,
                     std::string{"cannot be read: "} + std::strerror(errno));
  return {};
}

// One that was never finished counts as being written; one that was finished and then cut off does
// not, though HDF5 1.14 would read it so and take zeros for what is missing. Between the two looks a
// writer may finish.
hal::Result<Hdf5Handle> open_hdf5(const std::filesystem::path& path) {
  const Hdf5Handle access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
  H5Pset_metadata_read_attempts(access, read_attempts);
  std::string reason;
  for (const unsigned mode : {H5F_ACC_RDONLY, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, H5F_ACC_RDONLY}) {
    const bool swmr = (mode & H5F_ACC_SWMR_READ) != 0;
    if (const Hdf5Head head = read_hdf5_head(path);
        swmr && (!head.open_for_swmr || head.is_truncated()))
      break;
    Hdf5Handle file{H5Fopen(path.c_str(), mode, access), H5Fclose};
    if (file.valid())
      return file;
    if (reason.empty() || swmr) // HDF5 forgets it with the next call
      reason = hdf5_reason();
  }
  return tl::make_unexpected(refusal_of_hdf5(path, reason));
}

hal::Result<> check_members(hid_t dataset, const char* name, hid_t expected) {
  const Hdf5Handle found{H5Dget_type(dataset), H5Tclose};
  for (int i = 0; i < H5Tget_nmembers(expected); ++i) {
    char* const found_name = H5Tget_member_name(expected, static_cast<unsigned>(i));
    const std::string member{found_name};
    H5free_memory(found_name);
    const int there = H5Tget_member_index(found, member.c_str());
    const H5T_class_t type =
        there < 0 ? H5T_NO_CLASS : H5Tget_member_class(found, static_cast<unsigned>(there));
    if (type != H5T_INTEGER && type != H5T_FLOAT)
      return hal::fail(hal::ErrorCode::bad_data,
                       "/{}: found no numbers named {}, expected them: the file is damaged, or "
                       "another program changed it",
                       name, member);
  }
  return {};
}

hal::Result<Hdf5Handle> open_dataset(hid_t where, const char* name, H5T_class_t type_class,
                                     std::span<const hsize_t> expected, hsize_t& rows) {
  const Hdf5Handle access{H5Pcreate(H5P_DATASET_ACCESS), H5Pclose};
  H5Pset_chunk_cache(access, 0, 0, 0);
  Hdf5Handle dataset{H5Dopen2(where, name, access), H5Dclose};
  if (!dataset.valid())
    return hal::fail(
        hal::ErrorCode::bad_data,
        "found no dataset /{}, expected one: the file is damaged, or another program changed it",
        name);
  const Hdf5Handle type{H5Dget_type(dataset), H5Tclose};
  const Hdf5Handle space{H5Dget_space(dataset), H5Sclose};
  std::array<hsize_t, 4> found{};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 4 || H5Sget_simple_extent_dims(space, found.data(), nullptr) != rank)
    return hal::fail(hal::ErrorCode::bad_data, "/{}: found {} dimensions, expected {}", name, rank,
                     expected.size());
  const auto sizes = std::span{found}.first(static_cast<std::size_t>(rank));
  if (H5Tget_class(type) != type_class || sizes.size() != expected.size() ||
      !std::ranges::equal(sizes.subspan(1), expected.subspan(1)))
    return hal::fail(hal::ErrorCode::bad_data,
                     "/{}: found {} of {}, expected [rows{}{}] of {}, as the attributes say: "
                     "the file is damaged, or another program changed it",
                     name, sizes, name_of(H5Tget_class(type)), expected.size() > 1 ? ", " : "",
                     fmt::join(expected.subspan(1), ", "), name_of(type_class));
  HAL_CHECK(check_claims(dataset, name, sizes, H5Tget_size(type)));
  rows = found[0];
  return dataset;
}

std::uint64_t stored_bytes(hid_t file) {
  const auto descriptor = descriptor_of(file);
  struct stat status = {};
  if (!descriptor || ::fstat(*descriptor, &status) != 0)
    return 0;
  constexpr blkcnt_t block = 512; // whatever the file system's are
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (status.st_blocks >= status.st_size / block + (status.st_size % block != 0 ? 1 : 0))
    return size;
  // Fewer may be compressed ones, or not written yet: the file system tells holes from these.
  std::uint64_t bytes = 0;
  for (off_t end = 0;;) {
    const off_t at = ::lseek(*descriptor, end, SEEK_DATA);
    if (at < 0)
      return errno == ENXIO ? bytes : size; // nothing more, or it cannot tell
    end = ::lseek(*descriptor, at, SEEK_HOLE);
    if (end <= at)
      return size;
    bytes += static_cast<std::uint64_t>(end - at);
  }
}

hal::Result<> check_end(hid_t file, std::uint64_t address, std::uint64_t bytes) {
  const auto descriptor = descriptor_of(file);
  struct stat status = {};
  if (!descriptor || ::fstat(*descriptor, &status) != 0)
    return {}; // nothing is known
  const auto file_bytes = static_cast<std::uint64_t>(status.st_size);
  if (address <= file_bytes && bytes <= file_bytes - address)
    return {};
  return hal::fail(hal::ErrorCode::bad_data,
                   "was truncated after it was opened: found {} bytes, expected {} at least",
                   file_bytes, address + bytes);
}

bool walk_chunks(hid_t dataset) {
  const Hdf5Handle all{H5Dget_space(dataset), H5Sclose}; // H5S_ALL not every version takes
  hsize_t chunks = 0;
  return H5Dget_num_chunks(dataset, all, &chunks) >= 0;
}

std::optional<StoredChunk> find_chunk(hid_t dataset, std::span<const hsize_t> offset) {
  unsigned filters = 0;
  haddr_t address = HADDR_UNDEF;
  hsize_t bytes = 0;
  if (H5Dget_chunk_info_by_coord(dataset, offset.data(), &filters, &address, &bytes) < 0 ||
      address == HADDR_UNDEF)
    return std::nullopt;
  return StoredChunk{address, bytes, filters};
}

bool read_rows(hid_t dataset, hid_t type, std::span<const hsize_t> size, hsize_t first,
               void* rows) {
  std::array<hsize_t, 4> start{};
  const Hdf5Handle from{H5Dget_space(dataset), H5Sclose};
  const Hdf5Handle to{H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr),
                      H5Sclose};
  start[0] = first;
  return H5Sselect_hyperslab(from, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr) >=
             0 &&
         H5Dread(dataset, type, to, from, H5P_DEFAULT, rows) >= 0;
}

} // namespace octascope::pipeline

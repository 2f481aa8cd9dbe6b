#include "pipeline/recordings/recording_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pipeline/recordings/hdf5.h"
#include "pipeline/recordings/hdf5_head.h"
#include "pipeline/recordings/recording_attributes.h"
#include "pipeline/recordings/recording_layout.h"
#include "pipeline/recordings/trial.h"

namespace octascope::pipeline {

namespace layout = recording_layout;

struct RecordingReader::File {
  std::filesystem::path path;
  RecordingFacts facts;
  RecordingEnd end;
  std::vector<RecordedVolume> volumes;
  Hdf5Handle file, levels, states;
};

namespace {

// What is being written just now is tried again, after waits that double from a nanosecond on: so
// many attempts take milliseconds. HDF5's own hundred would take for ever where a file is damaged.
constexpr unsigned read_attempts = 22;

// One that was never finished counts as being written; one that was finished and then cut off does
// not, though HDF5 1.14 would read it so and take zeros for what is missing. Between the two looks a
// writer may finish.
hal::Result<Hdf5Handle> open_file(const std::filesystem::path& path) {
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

// HDF5's own limit for a chunk, and more volumes than a year has: what a file claims beyond them is
// not to be given memory.
constexpr std::size_t most_voxels = 0xFFFFFFFF;
constexpr hsize_t most_volumes = 500'000'000;

// Nor is what a file of its size cannot hold, even if another program packed it: deflate, the
// tightest of HDF5's own filters, makes no more of a byte.
constexpr double most_bytes_of_a_byte = 1032;

double bytes_of(std::span<const hsize_t> sizes, std::size_t element_bytes) {
  double bytes = static_cast<double>(element_bytes);
  for (const hsize_t size : sizes)
    bytes *= static_cast<double>(size);
  return bytes;
}

// Of a dataset that holds something: all of it, and one chunk.
hal::Result<> check_claims(hid_t file, hid_t dataset, const char* name,
                           std::span<const hsize_t> sizes, std::size_t element_bytes) {
  hsize_t file_bytes = 0;
  if (H5Fget_filesize(file, &file_bytes) < 0)
    return hal::fail(hal::ErrorCode::bad_data, "its size cannot be found: " + hdf5_reason());
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

// Every number of a RecordedVolume.
hal::Result<> check_entry_type(hid_t metadata) {
  const Hdf5Handle found{H5Dget_type(metadata), H5Tclose};
  const Hdf5Handle expected = layout::ledger_type();
  for (int i = 0; i < H5Tget_nmembers(expected); ++i) {
    char* const name = H5Tget_member_name(expected, static_cast<unsigned>(i));
    const std::string member{name};
    H5free_memory(name);
    const int there = H5Tget_member_index(found, member.c_str());
    const H5T_class_t type =
        there < 0 ? H5T_NO_CLASS : H5Tget_member_class(found, static_cast<unsigned>(there));
    if (type != H5T_INTEGER && type != H5T_FLOAT)
      return hal::fail(hal::ErrorCode::bad_data,
                       "/{}: found no numbers named {}, expected them: the file is damaged, or "
                       "another program changed it",
                       layout::metadata, member);
  }
  return {};
}

// A dataset whose dimensions but the first are `expected`; the first is put into `volumes`.
hal::Result<Hdf5Handle> open_dataset(hid_t file, const char* name, H5T_class_t type_class,
                                     std::span<const hsize_t> expected, hsize_t& volumes) {
  const Hdf5Handle access{H5Pcreate(H5P_DATASET_ACCESS), H5Pclose};
  H5Pset_chunk_cache(access, 0, 0, 0);
  Hdf5Handle dataset{H5Dopen2(file, name, access), H5Dclose};
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
                     "/{}: found {} of {}, expected [volumes{}{}] of {}, as the attributes say: "
                     "the file is damaged, or another program changed it",
                     name, sizes, name_of(H5Tget_class(type)), expected.size() > 1 ? ", " : "",
                     fmt::join(expected.subspan(1), ", "), name_of(type_class));
  HAL_CHECK(check_claims(file, dataset, name, sizes, H5Tget_size(type)));
  volumes = found[0];
  return dataset;
}

// The first `count` of them.
hal::Result<std::vector<RecordedVolume>> read_entries(hid_t metadata, hsize_t count) {
  std::vector<RecordedVolume> entries(count);
  const hsize_t start = 0;
  const Hdf5Handle type = layout::ledger_type();
  const Hdf5Handle from{H5Dget_space(metadata), H5Sclose};
  const Hdf5Handle to{H5Screate_simple(1, &count, nullptr), H5Sclose};
  if (count > 0 &&
      (H5Sselect_hyperslab(from, H5S_SELECT_SET, &start, nullptr, &count, nullptr) < 0 ||
       H5Dread(metadata, type, to, from, H5P_DEFAULT, entries.data()) < 0))
    return hal::fail(hal::ErrorCode::bad_data, "/ledger: cannot be read: " + hdf5_reason());
  return entries;
}

// Of what was cut off a file after it was opened HDF5 reads zeros, and no error.
hal::Result<> check_end(hid_t file, hid_t levels, std::size_t n) {
  const std::array<hsize_t, 4> chunk{n, 0, 0, 0};
  unsigned filters = 0;
  haddr_t address = HADDR_UNDEF;
  hsize_t bytes = 0;
  void* descriptor = nullptr;
  struct stat status = {};
  if (H5Dget_chunk_info_by_coord(levels, chunk.data(), &filters, &address, &bytes) < 0 ||
      address == HADDR_UNDEF || H5Fget_vfd_handle(file, H5P_DEFAULT, &descriptor) < 0 ||
      ::fstat(*static_cast<const int*>(descriptor), &status) != 0)
    return {}; // another program chose the chunks: nothing is known
  const auto file_bytes = static_cast<std::uint64_t>(status.st_size);
  if (address <= file_bytes && bytes <= file_bytes - address)
    return {};
  return hal::fail(hal::ErrorCode::bad_data,
                   "was truncated after it was opened: found {} bytes, expected {} at least",
                   file_bytes, address + bytes);
}

bool read_row(hid_t dataset, std::span<const hsize_t> size, std::size_t n, void* row) {
  std::array<hsize_t, 4> start{};
  std::array<hsize_t, 4> count{};
  std::ranges::copy(size, count.begin());
  start[0] = n;
  count[0] = 1;
  const Hdf5Handle from{H5Dget_space(dataset), H5Sclose};
  const Hdf5Handle to{H5Screate_simple(static_cast<int>(size.size()), count.data(), nullptr),
                      H5Sclose};
  return H5Sselect_hyperslab(from, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) >=
             0 &&
         H5Dread(dataset, H5T_NATIVE_UINT8, to, from, H5P_DEFAULT, row) >= 0;
}

hal::TimePoint time_point(std::int64_t ns) {
  return hal::TimePoint{hal::Duration{ns}};
}

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

} // namespace

RecordingReader::RecordingReader(std::unique_ptr<File> file) : file_(std::move(file)) {}
RecordingReader::RecordingReader(RecordingReader&&) noexcept = default;
RecordingReader& RecordingReader::operator=(RecordingReader&&) noexcept = default;

RecordingReader::~RecordingReader() {
  const Hdf5Silence silence;
  file_.reset();
}

hal::Result<RecordingReader> RecordingReader::open(const std::filesystem::path& path) {
  const Hdf5Silence silence;
  auto opened = check_file(path)
                    .and_then([&] { return try_apart([&] { read_indices(load(path)); }); })
                    .and_then([&] { return load(path); });
  if (!opened)
    return hal::fail(opened.error().code, "{}: {}", path.string(), opened.error().message);
  return RecordingReader{std::move(*opened)};
}

hal::Result<std::unique_ptr<RecordingReader::File>>
RecordingReader::load(const std::filesystem::path& path) {
  auto opened = std::make_unique<File>();
  opened->path = path;
  HAL_TRY(opened->file, open_file(path));
  HAL_TRY(opened->facts, read_facts(opened->file));
  HAL_TRY(opened->end, read_end(opened->file));
  const VolumeGeometry& geometry = opened->facts.geometry;
  std::array<hsize_t, 3> counts{};
  HAL_TRY(opened->levels, open_dataset(opened->file, layout::levels, H5T_INTEGER,
                                       layout::levels_size(geometry, 0), counts[0]));
  HAL_TRY(opened->states, open_dataset(opened->file, layout::b_scan_states, H5T_INTEGER,
                                       layout::states_size(geometry, 0), counts[1]));
  HAL_TRY(const auto metadata, open_dataset(opened->file, layout::metadata, H5T_COMPOUND,
                                            std::array<hsize_t, 1>{}, counts[2]));
  HAL_CHECK(check_entry_type(metadata));
  // Of one that broke off, the last volume may lack its entry.
  const hsize_t volumes = std::ranges::min(counts);
  if (geometry.voxels() > most_voxels || volumes > most_volumes)
    return hal::fail(hal::ErrorCode::bad_data,
                     "found {} volumes of {} voxels, expected at most {} of {}", volumes,
                     geometry.voxels(), most_volumes, most_voxels);
  HAL_TRY(opened->volumes, read_entries(metadata, volumes));
  return opened;
}

// All that HDF5 looks at when volumes are read, but for the volumes themselves.
void RecordingReader::read_indices(const hal::Result<std::unique_ptr<File>>& opened) {
  if (!opened)
    return;
  hsize_t chunks = 0;
  for (const hid_t dataset : {hid_t{(*opened)->levels}, hid_t{(*opened)->states}})
    H5Dget_num_chunks(dataset, H5S_ALL, &chunks);
}

const RecordingFacts& RecordingReader::facts() const {
  return file_->facts;
}
const RecordingEnd& RecordingReader::end() const {
  return file_->end;
}
const std::vector<RecordedVolume>& RecordingReader::volumes() const {
  return file_->volumes;
}

hal::Result<> RecordingReader::read(std::size_t n, Volume& volume) {
  const Hdf5Silence silence;
  const VolumeGeometry& geometry = file_->facts.geometry;
  if (n >= file_->volumes.size() || volume.geometry != geometry)
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        "{}: volume {} is asked for, expected 0 to {}, into one of the recording's geometry",
        file_->path.string(), n, static_cast<std::int64_t>(file_->volumes.size()) - 1);
  if (const auto checked = check_end(file_->file, file_->levels, n); !checked)
    return hal::fail(checked.error().code, "{}: volume {}: {}", file_->path.string(), n,
                     checked.error().message);
  if (!read_row(file_->levels, layout::levels_size(geometry, 0), n, volume.levels.data()) ||
      !read_row(file_->states, layout::states_size(geometry, 0), n, volume.b_scan_states.data()))
    return hal::fail(hal::ErrorCode::bad_data, "{}: volume {} cannot be read: {}",
                     file_->path.string(), n, hdf5_reason());
  for (BScanState& state : volume.b_scan_states)
    if (state > BScanState::saturated)
      return hal::fail(hal::ErrorCode::bad_data,
                       "{}: volume {}: found {} as a B-scan's state, expected 0 (missing), 1 "
                       "(good) or 2 (saturated)",
                       file_->path.string(), n, static_cast<int>(state));
  const RecordedVolume& entry = file_->volumes[n];
  volume.metadata = {.index = entry.index,
                     .pulsed = time_point(entry.first_line_ns),
                     .first_line = time_point(entry.first_line_ns),
                     .last_line = time_point(entry.last_line_ns),
                     .published = time_point(entry.published_ns),
                     .lost_b_scans = entry.lost_b_scans,
                     .lost_lines = entry.lost_lines,
                     .saturated_lines = entry.saturated_lines,
                     .scan_lag_a_scans = entry.scan_lag_a_scans};
  return {};
}

} // namespace octascope::pipeline

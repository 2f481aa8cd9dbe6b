#include "pipeline/recordings/recording_reader.h"

#include <algorithm>
#include <array>

#include "pipeline/recordings/hdf5/reading.h"
#include "pipeline/recordings/hdf5/trial.h"
#include "pipeline/recordings/recording_attributes.h"
#include "pipeline/recordings/recording_layout.h"

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

// HDF5's own limit for a chunk, and more volumes than a year has: what a file claims beyond them is
// not to be given memory.
constexpr std::size_t most_voxels = 0xFFFFFFFF;
constexpr hsize_t most_volumes = 500'000'000;

// The first `count` of them.
hal::Result<std::vector<RecordedVolume>> read_entries(hid_t metadata, hsize_t count) {
  std::vector<RecordedVolume> entries(count);
  if (count > 0 &&
      !read_rows(metadata, layout::ledger_type(), std::array{count}, 0, entries.data()))
    return hal::fail(hal::ErrorCode::bad_data, "/ledger: cannot be read: " + hdf5_reason());
  return entries;
}

hal::Result<> check_levels(hid_t file, hid_t levels, std::size_t n) {
  const auto chunk = find_chunk(levels, std::array<hsize_t, 4>{n, 0, 0, 0});
  if (!chunk) // another program chose the chunks: nothing is known
    return {};
  return check_end(file, chunk->address, chunk->bytes);
}

hal::TimePoint time_point(std::int64_t ns) {
  return hal::TimePoint{hal::Duration{ns}};
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
  HAL_TRY(auto opened, load_tried(path, load, read_indices));
  return RecordingReader{std::move(opened)};
}

hal::Result<std::unique_ptr<RecordingReader::File>>
RecordingReader::load(const std::filesystem::path& path) {
  auto opened = std::make_unique<File>();
  opened->path = path;
  HAL_TRY(opened->file, open_hdf5(path));
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
  HAL_CHECK(check_members(metadata, layout::metadata, layout::ledger_type()));
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
  for (const hid_t dataset : {hid_t{(*opened)->levels}, hid_t{(*opened)->states}})
    static_cast<void>(walk_chunks(dataset)); // what fails is said by what reads volumes
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
  if (const auto checked = check_levels(file_->file, file_->levels, n); !checked)
    return hal::fail(checked.error().code, "{}: volume {}: {}", file_->path.string(), n,
                     checked.error().message);
  if (!read_rows(file_->levels, H5T_NATIVE_UINT8, layout::levels_size(geometry, 1), n,
                 volume.levels.data()) ||
      !read_rows(file_->states, H5T_NATIVE_UINT8, layout::states_size(geometry, 1), n,
                 volume.b_scan_states.data()))
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

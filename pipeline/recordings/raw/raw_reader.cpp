#include "pipeline/recordings/raw/raw_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

#include "pipeline/recordings/hdf5/attributes.h"
#include "pipeline/recordings/hdf5/hdf5_head.h"
#include "pipeline/recordings/hdf5/reading.h"
#include "pipeline/recordings/hdf5/trial.h"
#include "pipeline/recordings/raw/frame_places.h"
#include "pipeline/recordings/raw/raw_attributes.h"
#include "pipeline/recordings/raw/raw_layout.h"

namespace octascope::pipeline {

namespace layout = raw_layout;

struct RawReader::File {
  std::filesystem::path path;
  RawFacts facts;
  RawEnd end;
  std::vector<RawFrame> frames;  // sorted
  std::vector<std::size_t> rows; // of each, in the file
  std::vector<RawVolume> volumes;
  Hdf5Handle file, spectra, backgrounds;
};

namespace {

// As frames lie unpacked, a file has no more than it has room for, whatever it claims: so that what
// is read of it takes little more memory than it has bytes.
hal::Result<hsize_t> frames_with_room(hid_t file, const hal::LineFormat& format, hsize_t claimed) {
  hsize_t file_bytes = 0;
  if (H5Fget_filesize(file, &file_bytes) < 0)
    return hal::fail(hal::ErrorCode::bad_data, "its size cannot be found: " + hdf5_reason());
  const std::uint64_t stored = stored_bytes(file);
  const hsize_t most = stored / format.frame_bytes();
  if (claimed > most && stored < file_bytes / 2)
    return hal::fail(hal::ErrorCode::bad_data,
                     "found {} frames claimed, and {} of {} bytes stored, the others are holes: "
                     "expected {} bytes a frame; take another copy of the file",
                     claimed, stored, file_bytes, format.frame_bytes());
  return std::min(claimed, most);
}

hal::Result<std::vector<RawFrame>> read_entries(hid_t frames, hsize_t count) {
  std::vector<RawFrame> entries(count);
  const Hdf5Handle type = layout::frame_type();
  if (count > 0 && !read_rows(frames, type, std::array{count}, 0, entries.data()))
    return hal::fail(hal::ErrorCode::bad_data, "/{}: cannot be read: {}", layout::frames,
                     hdf5_reason());
  for (const RawFrame& entry : entries)
    if (!(std::abs(entry.scan_lag_a_scans) <= largest_size))
      return hal::fail(hal::ErrorCode::bad_data,
                       "/{}: found {} as scan_lag_a_scans, expected at most {}", layout::frames,
                       entry.scan_lag_a_scans, largest_size);
  return entries;
}

// Unpacked, one chunk a frame, samples as they are in memory: so that they can be used in place.
hal::Result<> check_storage(hid_t spectra, const hal::LineFormat& format) {
  const Hdf5Handle made{H5Dget_create_plist(spectra), H5Pclose};
  const Hdf5Handle type{H5Dget_type(spectra), H5Tclose};
  std::array<hsize_t, 3> chunk{};
  const bool chunked = H5Pget_layout(made) == H5D_CHUNKED &&
                       H5Pget_chunk(made, static_cast<int>(chunk.size()), chunk.data()) == 3;
  if (chunked && chunk == layout::spectra_size(format, 1) && H5Pget_nfilters(made) == 0 &&
      H5Tequal(type, layout::sample_type(format.sample_type)) > 0)
    return {};
  return hal::fail(
      hal::ErrorCode::bad_data,
      "/{}: found it packed, in other chunks, or of another type than the attributes "
      "say, expected each frame as one chunk without filters, as octascope writes it: "
      "another program changed the file (h5repack -f NONE -l CHUNK=1x{}x{} unpacks it)",
      layout::spectra, format.lines_per_frame, format.samples_per_line);
}

auto place_of(const RawFrame& frame) {
  return std::tuple{frame.volume, frame.b_scan, frame.repeat};
}

bool is_whole(std::span<const RawFrame> frames, const ScanPlan& plan) {
  if (frames.size() != static_cast<std::size_t>(plan.sweeps()))
    return false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto sweep = static_cast<int>(i);
    if (frames[i].b_scan != plan.b_scan_of(sweep) || frames[i].repeat != sweep % plan.repeats)
      return false;
  }
  return true;
}

std::vector<RawVolume> volumes_of(std::span<const RawFrame> frames, const ScanPlan& plan) {
  std::vector<RawVolume> volumes;
  for (std::size_t first = 0; first < frames.size();) {
    const std::uint64_t index = frames[first].volume;
    const auto same = frames.subspan(first);
    const auto other =
        std::ranges::find_if(same, [&](const RawFrame& frame) { return frame.volume != index; });
    const auto count = static_cast<std::size_t>(other - same.begin());
    volumes.push_back({index, first, count, is_whole(same.first(count), plan)});
    first += count;
  }
  return volumes;
}

} // namespace

bool is_raw_recording(const std::filesystem::path& file) {
  return read_hdf5_head(file).has_signature;
}

bool says_raw_spectra(const std::filesystem::path& file) {
  const Hdf5Silence silence;
  bool says = false;
  const auto look = [&] {
    if (const auto opened = open_hdf5(file)) {
      const auto format = read_text(*opened, "format");
      says = format && *format == layout::format_name;
    }
  };
  const auto tried = check_file(file).and_then([&] { return try_apart(look); });
  if (tried)
    look();
  return says;
}

RawReader::RawReader(std::unique_ptr<File> file) : file_(std::move(file)) {}
RawReader::RawReader(RawReader&&) noexcept = default;
RawReader& RawReader::operator=(RawReader&&) noexcept = default;

RawReader::~RawReader() {
  const Hdf5Silence silence;
  file_.reset();
}

hal::Result<RawReader> RawReader::open(const std::filesystem::path& path) {
  HAL_TRY(auto opened, load_tried(path, load, read_indices));
  return RawReader{std::move(opened)};
}

hal::Result<std::unique_ptr<RawReader::File>> RawReader::load(const std::filesystem::path& path) {
  auto opened = std::make_unique<File>();
  opened->path = path;
  HAL_TRY(opened->file, open_hdf5(path));
  HAL_TRY(opened->facts, read_raw_facts(opened->file));
  HAL_TRY(opened->end, read_raw_end(opened->file));
  const hal::LineFormat& format = opened->facts.format;
  const bool floats = format.sample_type == hal::SampleType::f32;
  std::array<hsize_t, 3> counts{};
  HAL_TRY(opened->spectra,
          open_dataset(opened->file, layout::spectra, floats ? H5T_FLOAT : H5T_INTEGER,
                       layout::spectra_size(format, 0), counts[0]));
  HAL_TRY(const auto frames, open_dataset(opened->file, layout::frames, H5T_COMPOUND,
                                          std::array<hsize_t, 1>{}, counts[1]));
  HAL_CHECK(check_members(frames, layout::frames, layout::frame_type()));
  counts[2] = counts[0];
  if (opened->facts.has_backgrounds()) {
    HAL_TRY(opened->backgrounds, open_dataset(opened->file, layout::backgrounds, H5T_FLOAT,
                                              layout::backgrounds_size(format, 0), counts[2]));
  }
  HAL_CHECK(check_storage(opened->spectra, format));
  // Of one that broke off, the last frames may lack their entries, or these their frames.
  HAL_TRY(const hsize_t count, frames_with_room(opened->file, format, std::ranges::min(counts)));
  HAL_TRY(const auto entries, read_entries(frames, count));
  opened->rows.resize(count);
  std::iota(opened->rows.begin(), opened->rows.end(), std::size_t{0});
  std::ranges::stable_sort(opened->rows, {},
                           [&](std::size_t row) { return place_of(entries[row]); });
  for (const std::size_t row : opened->rows)
    opened->frames.push_back(entries[row]);
  opened->volumes = volumes_of(opened->frames, opened->facts.plan);
  return opened;
}

// All that HDF5 looks at when frames are looked for, but for the frames themselves.
void RawReader::read_indices(const hal::Result<std::unique_ptr<File>>& opened) {
  if (!opened)
    return;
  for (const hid_t dataset : {hid_t{(*opened)->spectra}, hid_t{(*opened)->backgrounds}})
    if (dataset >= 0)
      static_cast<void>(walk_chunks(dataset)); // what fails is said by what looks for frames
}

const RawFacts& RawReader::facts() const {
  return file_->facts;
}
const RawEnd& RawReader::end() const {
  return file_->end;
}
const std::vector<RawFrame>& RawReader::frames() const {
  return file_->frames;
}
const std::vector<RawVolume>& RawReader::volumes() const {
  return file_->volumes;
}

hal::Result<RawVolume> RawReader::whole_volume(std::size_t n) const {
  const std::string path = file_->path.string();
  const auto& volumes = file_->volumes;
  if (n >= volumes.size())
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "{}: volume {} is asked for, found {} of them, counted from 0", path, n,
                     volumes.size());
  if (!volumes[n].whole)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "{}: volume {} is not whole: found {} of its {} sweeps", path, n,
                     volumes[n].count, file_->facts.plan.sweeps());
  return volumes[n];
}

hal::Result<RawVolume> RawReader::first_whole_volume() const {
  const auto found = std::ranges::find_if(file_->volumes, &RawVolume::whole);
  if (found != file_->volumes.end())
    return *found;
  return hal::fail(hal::ErrorCode::bad_data,
                   "{}: no volume in it is whole: found {} frames, expected {} for a volume",
                   file_->path.string(), file_->frames.size(), file_->facts.plan.sweeps());
}

hal::Result<SpectraFile> RawReader::spectra(std::size_t first, std::size_t count,
                                            RawLines lines) const {
  const Hdf5Silence silence;
  const RawFacts& facts = file_->facts;
  const auto part = std::span{file_->frames}.subspan(first, count);
  SpectraFile::Sweeps sweeps{.kept_lines = lines == RawLines::all ? facts.format.lines_per_frame
                                                                  : facts.kept_lines(),
                             .lines = facts.format.lines_per_frame,
                             .samples = facts.format.samples_per_line,
                             .type = facts.format.sample_type,
                             .places = {}};
  const auto rows = std::span{file_->rows}.subspan(first, count);
  std::vector<std::size_t> in_file(count); // workers finish in another order
  std::iota(in_file.begin(), in_file.end(), std::size_t{0});
  std::ranges::sort(in_file, {}, [&](std::size_t i) { return rows[i]; });
  HAL_TRY(auto places, FramePlaces::open(file_->path, file_->spectra, facts.format.frame_bytes()));
  sweeps.places.resize(count);
  for (const std::size_t i : in_file) {
    const auto place = places.find(rows[i], part[i].crc32);
    if (!place)
      return hal::fail(hal::ErrorCode::bad_data,
                       "{}: frame {} is not there: the file is damaged, or another program changed "
                       "it",
                       file_->path.string(), rows[i]);
    sweeps.places[i] = {*place, part[i].crc32};
  }
  return SpectraFile::open(file_->path, std::move(sweeps));
}

hal::Result<std::vector<float>> RawReader::backgrounds(std::size_t first, std::size_t count) const {
  const Hdf5Silence silence;
  std::vector<float> all;
  if (!file_->facts.has_backgrounds())
    return all;
  const auto samples = static_cast<std::size_t>(file_->facts.format.samples_per_line);
  all.resize(count * samples);
  for (std::size_t i = 0; i < count; ++i) {
    float* const values = all.data() + i * samples;
    if (!read_rows(file_->backgrounds, H5T_NATIVE_FLOAT,
                   layout::backgrounds_size(file_->facts.format, 1), file_->rows[first + i],
                   values) ||
        !std::all_of(values, values + samples, [](float value) { return std::isfinite(value); }))
      return hal::fail(hal::ErrorCode::bad_data,
                       "{}: /{}: found no numbers for frame {}, expected {} of them",
                       file_->path.string(), layout::backgrounds, file_->rows[first + i], samples);
  }
  return all;
}

} // namespace octascope::pipeline

#include "pipeline/recordings/raw/frame_places.h"

#include <array>

#include "pipeline/files/crc32.h"
#include "pipeline/recordings/hdf5/reading.h"

namespace octascope::pipeline {

namespace {

// Of larger frames a file has too few for HDF5 to take long.
constexpr std::size_t small_frame = std::size_t{64} << 10;

constexpr std::uint64_t page = 4096; // at which frames begin
constexpr std::uint64_t most_pages_between = 64;
constexpr int most_misses = 16; // running: then the file is packed in another way

} // namespace

hal::Result<FramePlaces> FramePlaces::open(const std::filesystem::path& file, hid_t spectra,
                                           std::size_t frame_bytes) {
  HAL_TRY(const auto input, InputFile::open(file, "raw spectra", UINT64_MAX));
  HAL_TRY(auto mapped, input.map());
  return FramePlaces{std::move(mapped), spectra, frame_bytes};
}

std::optional<std::uint64_t> FramePlaces::find(std::size_t row, std::uint32_t crc32) {
  std::optional<std::uint64_t> place;
  if (last_ && row > last_->row && frame_bytes_ <= small_frame && misses_ < most_misses) {
    place = find_behind(*last_, row, crc32);
    misses_ = place ? 0 : misses_ + 1;
  }
  if (!place)
    place = ask_hdf5(row);
  if (place)
    last_ = {row, *place};
  return place;
}

bool FramePlaces::is_at(std::uint64_t place, std::uint32_t crc32) const {
  const std::span<const std::byte> bytes = mapped_.bytes();
  return place <= bytes.size() && frame_bytes_ <= bytes.size() - place &&
         crc32_of(bytes.subspan(place, frame_bytes_)) == crc32;
}

std::optional<std::uint64_t> FramePlaces::find_behind(const Found& last, std::size_t row,
                                                      std::uint32_t crc32) const {
  const std::uint64_t stride = (frame_bytes_ + page - 1) / page * page;
  const std::uint64_t next = last.place + (row - last.row) * stride;
  if (is_at(next, crc32))
    return next;
  const std::uint64_t unaligned = last.place + (row - last.row) * frame_bytes_; // by h5repack
  if (is_at(unaligned, crc32))
    return unaligned;
  for (std::uint64_t pages = 1; pages <= most_pages_between; ++pages)
    if (is_at(next + pages * page, crc32))
      return next + pages * page;
  return std::nullopt;
}

std::optional<std::uint64_t> FramePlaces::ask_hdf5(std::size_t row) {
  ++asked_;
  const auto chunk = find_chunk(spectra_, std::array<hsize_t, 3>{row, 0, 0});
  if (!chunk || chunk->bytes != frame_bytes_ || chunk->skipped_filters != 0)
    return std::nullopt;
  return chunk->address;
}

} // namespace octascope::pipeline

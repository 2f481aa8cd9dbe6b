#include "pipeline/recordings/hdf5/variable_text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <unistd.h>

#include "pipeline/recordings/hdf5/little_endian.h"

namespace octascope::pipeline {

namespace {

// What an attribute holds in place of the text (HDF5 File Format Specification, VIII.B): its length,
// the address of a global heap, and its object there. So many bytes where addresses have eight.
constexpr std::size_t reference_bytes = 16;

struct HeapReference {
  std::uint64_t length = 0, heap = 0, object = 0;
};

// A conversion, as HDF5 asks for one: an element of the file goes through unchanged.
herr_t leave_unchanged(hid_t, hid_t, H5T_cdata_t*, std::size_t, std::size_t, std::size_t, void*,
                       void*, hid_t) {
  return 0;
}

std::optional<HeapReference> read_reference(hid_t attribute) {
  const Hdf5Handle text{H5Aget_type(attribute), H5Tclose};
  const Hdf5Handle opaque{H5Tcreate(H5T_OPAQUE, reference_bytes), H5Tclose};
  if (H5Aget_storage_size(attribute) != reference_bytes ||
      H5Tregister(H5T_PERS_SOFT, "unchanged", text, opaque, leave_unchanged) < 0)
    return std::nullopt;
  std::array<std::byte, reference_bytes> bytes{};
  const bool read = H5Aread(attribute, opaque, bytes.data()) >= 0;
  H5Tunregister(H5T_PERS_SOFT, "unchanged", text, opaque, leave_unchanged);
  const std::span all{bytes};
  if (!read)
    return std::nullopt;
  return HeapReference{little_endian(all.subspan<0, 4>()), little_endian(all.subspan<4, 8>()),
                       little_endian(all.subspan<12, 4>())};
}

// III.E: "GCOL", version 1, the size of it all; then objects, each with its number, a count of
// references, its size and its bytes, which end at a multiple of eight. Object 0 is free space.
constexpr std::string_view heap_signature{"GCOL\1", 5};
constexpr std::uint64_t heap_head_bytes = 16, object_head_bytes = 16;
constexpr std::uint64_t most_heap_bytes = std::uint64_t{64} << 20;

std::optional<std::vector<std::byte>> read_at(int file, std::uint64_t place, std::uint64_t size) {
  std::vector<std::byte> bytes(size);
  if (::pread(file, bytes.data(), size, static_cast<off_t>(place)) != static_cast<ssize_t>(size))
    return std::nullopt;
  return bytes;
}

std::optional<std::string> read_from_heap(int file, const HeapReference& reference) {
  const auto head = read_at(file, reference.heap, heap_head_bytes);
  if (!head ||
      !std::ranges::equal(std::span{*head}.first<5>(), std::as_bytes(std::span{heap_signature})))
    return std::nullopt;
  const std::uint64_t size = little_endian(std::span{*head}.subspan<8, 8>());
  if (size > most_heap_bytes)
    return std::nullopt;
  const auto heap = read_at(file, reference.heap, size);
  if (!heap)
    return std::nullopt;
  for (std::uint64_t at = heap_head_bytes; at + object_head_bytes <= size;) {
    const std::span object = std::span{*heap}.subspan(at);
    const std::uint64_t number = little_endian(object.subspan<0, 2>());
    const std::uint64_t bytes = little_endian(object.subspan<8, 8>());
    if (number == 0 || bytes > object.size() - object_head_bytes)
      return std::nullopt;
    if (number == reference.object) {
      if (bytes < reference.length)
        return std::nullopt;
      const std::span text = object.subspan(object_head_bytes, reference.length);
      return std::string{reinterpret_cast<const char*>(text.data()), text.size()};
    }
    at += object_head_bytes + (bytes + 7) / 8 * 8;
  }
  return std::nullopt;
}

} // namespace

hal::Result<std::string> read_variable_text(hid_t attribute, std::size_t most_bytes) {
  const auto damaged = [] {
    return hal::fail(hal::ErrorCode::bad_data, "found a text of variable length that is not where "
                                               "the file says, expected one: it is damaged there");
  };
  const auto reference = read_reference(attribute);
  if (!reference)
    return damaged();
  if (reference->length > most_bytes)
    return hal::fail(hal::ErrorCode::bad_data, "found a text of {} bytes, expected at most {}",
                     reference->length, most_bytes);
  if (reference->length == 0)
    return std::string{};
  const Hdf5Handle file{H5Iget_file_id(attribute), H5Fclose};
  void* descriptor = nullptr; // of the driver that opens a single file
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &descriptor) < 0 || descriptor == nullptr)
    return damaged();
  auto text = read_from_heap(*static_cast<const int*>(descriptor), *reference);
  return text ? hal::Result<std::string>{std::move(*text)} : damaged();
}

} // namespace octascope::pipeline

// Volumes as NRRD files: attached header, raw little-endian data, sizes depth A B, spacings in mm.
//
// Format: NRRD0005 of the Teem library, so that its `unu` and other viewers can open them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hal/result.h"
#include "pipeline/files/atomic_file.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

enum class NrrdType : std::uint8_t {
  uint8,   // display counts; level_scale.h and the file's header give their meaning in dB
  float32, // decibels
};

// Additional header lines `key:=value`, as pairs of key and value. Other programs display them.
using NrrdNotes = std::vector<std::pair<std::string, std::string>>;

// Writes a volume B-scan by B-scan, in any order and from any thread. The file appears complete or
// not at all.
class NrrdWriter {
public:
  // ErrorCode::invalid_argument: an empty volume, or a note longer than longest_nrrd_line.
  static hal::Result<NrrdWriter> create(const std::filesystem::path& file,
                                        const VolumeGeometry& geometry, NrrdType type,
                                        const NrrdNotes& notes = {},
                                        Readers readers = Readers::as_the_umask_allows);

  // `levels` are b_scan_voxels() values of the writer's type, as [a][z]. Thread-safe.
  hal::Result<> write_b_scan(int b, std::span<const float> levels) const;
  hal::Result<> write_b_scan(int b, std::span<const std::uint8_t> levels) const;

  // Call once every B-scan has been written.
  hal::Result<> commit() { return file_.commit(); }

private:
  NrrdWriter(AtomicFile file, const VolumeGeometry& geometry, NrrdType type,
             std::size_t header_bytes);
  hal::Result<> write(int b, NrrdType type, std::span<const std::byte> levels) const;

  AtomicFile file_;
  VolumeGeometry geometry_;
  NrrdType type_;
  std::size_t header_bytes_;
};

// The longest header line in bytes, without its line end; the reader refuses longer ones.
inline constexpr std::size_t longest_nrrd_line = 4096;

struct NrrdVolume {
  VolumeGeometry geometry;
  // In the file's type, [b][a][z], depth fastest.
  std::variant<std::vector<std::uint8_t>, std::vector<float>> levels;
};

hal::Result<> write_nrrd(const std::filesystem::path& file, const NrrdVolume& volume);

// Reads files from NrrdWriter, and files from other programs with the same three axes: attached
// header, type uint8 or float, raw, little-endian, spacings optional (default 1 mm). Refuses
// anything else, with what was found and what was expected.
hal::Result<NrrdVolume> read_nrrd(const std::filesystem::path& file);

} // namespace octascope::pipeline

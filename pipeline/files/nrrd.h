// Volumes as NRRD files: attached header, raw little-endian data, sizes depth A B, spacings in mm.
//
// Format: NRRD0005 of the Teem library, so that its `unu` and other people's viewers open it.
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
  uint8,   // display counts; level_scale.h, and the header, say what they mean in dB
  float32, // decibels
};

// What else a header says: keys and their values, as `key:=value` lines. Other programs show them.
using NrrdNotes = std::vector<std::pair<std::string, std::string>>;

// Writes a volume B-scan by B-scan, in any order and from any thread; the file appears complete or
// not at all.
class NrrdWriter {
public:
  // ErrorCode::invalid_argument: an empty volume; a note that is longer than a line of a header may
  // be.
  static hal::Result<NrrdWriter> create(const std::filesystem::path& file,
                                        const VolumeGeometry& geometry, NrrdType type,
                                        const NrrdNotes& notes = {},
                                        Readers readers = Readers::as_the_umask_allows);

  // `levels` are b_scan_voxels() values of the writer's type, as [a][z]. Thread-safe.
  hal::Result<> write_b_scan(int b, std::span<const float> levels) const;
  hal::Result<> write_b_scan(int b, std::span<const std::uint8_t> levels) const;

  // When every B-scan was written.
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

// Of a header, without its end; a reader takes no longer one for a header's.
inline constexpr std::size_t longest_nrrd_line = 4096;

struct NrrdVolume {
  VolumeGeometry geometry;
  // Of the file's type, [b][a][z], depth fastest.
  std::variant<std::vector<std::uint8_t>, std::vector<float>> levels;
};

hal::Result<> write_nrrd(const std::filesystem::path& file, const NrrdVolume& volume);

// Reads what NrrdWriter writes, and files of others with the same three axes: attached header, type
// uint8 or float, raw, little-endian, spacings or none (1 mm). Anything else is refused with what
// was found and expected.
hal::Result<NrrdVolume> read_nrrd(const std::filesystem::path& file);

} // namespace octascope::pipeline

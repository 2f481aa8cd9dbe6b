// Volumes as NRRD files: axes depth, A-scan, B-scan; spacings are converted to and from the file's
// units.
//
// Format: https://teem.sourceforge.net/nrrd/format.html. What is written has an attached header and
// raw little-endian data, and lies in the volume's frame (pipeline/vessels/registration.h) in mm,
// so that 3D Slicer, ITK and Teem's `unu` place it correctly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "hal/result.h"
#include "pipeline/files/atomic_file.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

enum class NrrdType : std::uint8_t {
  uint8,   // display counts; level_scale.h and the file's header give their meaning in dB
  float32, // decibels, or what the note nrrd_content says
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

// The key under which a file says which spacings were assumed (VolumeGeometry::assumed).
inline constexpr std::string_view nrrd_assumed_spacings = "assumed_spacings";

// The key under which a file says what its values are, where they are no levels.
inline constexpr std::string_view nrrd_content = "content";

struct NrrdVolume {
  VolumeGeometry geometry;
  // In the file's type, [b][a][z], depth fastest.
  std::variant<std::vector<std::uint8_t>, std::vector<float>> levels;
  std::vector<std::string> remarks = {}; // when read: what was assumed or left out, a sentence each
  std::string content = {};              // when read: the note nrrd_content; empty: there is none
};

hal::Result<> write_nrrd(const std::filesystem::path& file, const NrrdVolume& volume);

// Reads files from NrrdWriter and from other programs: attached or detached, raw or gzip, any number
// type and byte order. 8-bit counts are kept (level_scale.h); all other types are levels in dB and
// become float. A scale in the header takes precedence: the keys `lowest_level_db` and
// `level_step_db`, or `old min` and `old max` of quantised values. What it cannot place or does not
// know is refused, with what was found, what was expected and a remedy. ErrorCode::absent, denied,
// invalid_argument: as InputFile.
hal::Result<NrrdVolume> read_nrrd(const std::filesystem::path& file);

// The same for the bytes of an attached file; `name` is for messages.
hal::Result<NrrdVolume> parse_nrrd(std::span<const std::byte> file, std::string_view name);

} // namespace octascope::pipeline

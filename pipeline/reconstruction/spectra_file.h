// Raw spectra in a file: little-endian, C order [B-scan][A-scan][sample], nothing else; or sweeps
// that lie somewhere in a larger one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/result.h"
#include "pipeline/calibration/calibration.h" // how many samples a line may have
#include "pipeline/files/input_file.h"
#include "pipeline/reconstruction/spectrum_format.h"

namespace octascope::pipeline {

struct SpectraShape {
  int b_scans = 0;
  int a_scans = 0;
  int samples = 0;

  // "B,A,N" as on the command line.
  static hal::Result<SpectraShape> parse(std::string_view text);

  std::size_t lines() const {
    return static_cast<std::size_t>(b_scans) * static_cast<std::size_t>(a_scans);
  }
  bool operator==(const SpectraShape&) const = default;
};

// Read-only and memory-mapped: B-scans are read from disk on first access, so a file may
// exceed memory. Thread-safe. The file must not be shortened while it is open.
class SpectraFile {
public:
  // The size must be exactly B × A × N × bytes; else the message has found and expected.
  static hal::Result<SpectraFile> open(const std::filesystem::path& file, const SpectraShape& shape,
                                       hal::SampleType type);

  // Where a larger file has them.
  struct SweepPlace {
    std::uint64_t offset = 0; // in the file
    std::uint32_t crc32 = 0;  // zlib's, of all its lines
  };
  struct Sweeps {
    int kept_lines = 0; // of each, the first: the A-scans of the shape
    int lines = 0;      // that each has in the file
    int samples = 0;
    hal::SampleType type = hal::SampleType::u16;
    std::vector<SweepPlace> places; // one a B-scan of the shape
  };
  // ErrorCode::bad_data: a sweep lies outside the file, or where no sample can lie.
  static hal::Result<SpectraFile> open(const std::filesystem::path& file, Sweeps sweeps);

  const SpectraShape& shape() const { return shape_; }
  hal::SampleType type() const { return type_; }

  // All lines of B-scan `b`, valid as long as this lives.
  std::span<const std::byte> b_scan(int b) const;

  // Whether B-scan `b` is as it was written, as far as the file has a checksum of it, and all its
  // floats are numbers; else what is wrong, in words.
  std::optional<std::string> find_fault(int b) const;

  // f32 only: the first sample of B-scan `b` that is NaN or infinite, in words.
  std::optional<std::string> find_non_finite(int b) const;

  // Integers only: the first sample of B-scan `b` that has, shifted as `format` says, more bits
  // than are significant there, in words: it is of another type.
  std::optional<std::string> find_above_full_scale(int b, const SpectrumFormat& format) const;

private:
  SpectraFile(std::filesystem::path file, const SpectraShape& shape, hal::SampleType type,
              MappedFile mapped)
      : file_(std::move(file)), shape_(shape), type_(type), mapped_(std::move(mapped)) {}

  std::size_t line_bytes() const {
    return static_cast<std::size_t>(shape_.samples) * bytes_per_sample(type_);
  }

  template <class Count>
  std::optional<std::string> find_above(int b, const SpectrumFormat& format) const;
  std::string place_of(int b, std::size_t index) const;

  std::filesystem::path file_;
  SpectraShape shape_;
  hal::SampleType type_;
  MappedFile mapped_;
  int lines_ = 0;                  // of each sweep, with those after the kept ones
  std::vector<SweepPlace> places_; // by B-scan; empty: one B-scan after the other
};

} // namespace octascope::pipeline

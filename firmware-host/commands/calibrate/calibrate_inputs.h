// The measurements that a calibration is made of: one averaged spectrum a file.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/reconstruction/spectra_file.h"

namespace octascope::firmware_host {

struct SpectrumInput {
  std::optional<int> samples; // not given: the file is one line
  std::optional<hal::SampleType> type;
  std::optional<int> significant_bits; // of integer counts; all of the type's when not given
};

// What `given` says, else what the file's name says (…f32…, …u16…, …u8…), else u16.
hal::SampleType spectrum_type(const std::filesystem::path& file,
                              std::optional<hal::SampleType> given);

// A file that is read as numbers, one a line of text (text_curve.h), whatever its type: .txt, .csv.
bool is_text(const std::filesystem::path& file);

// The mean of the lines of a file, raw or text. ErrorCode::bad_data with line and sample: not
// finite; with `refuse_saturated`, at full scale or flat at its highest value in several places.
hal::Result<std::vector<double>> read_spectrum(const std::filesystem::path& file,
                                               const SpectrumInput& input, bool refuse_saturated);

// Raw little-endian samples as numbers.
std::vector<double> to_numbers(std::span<const std::byte> bytes, hal::SampleType type);

} // namespace octascope::firmware_host

// The measurements that a calibration is made from: one averaged spectrum per file.
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
  std::optional<int> samples; // empty: the file is one line
  std::optional<hal::SampleType> type;
  std::optional<int> significant_bits; // of integer counts; empty: all of the type's
};

// `given` if set, else the type in the file's name (…f32…, …u16…, …u8…), else u16.
hal::SampleType spectrum_type(const std::filesystem::path& file,
                              std::optional<hal::SampleType> given);

// Whether the file is text, one number a line (text_curve.h), whatever its type: .txt, .csv.
bool is_text(const std::filesystem::path& file);

// The mean of the lines of a file, raw, text, or a recording of raw spectra, which says itself what
// its samples are. ErrorCode::bad_data, with line and sample: a value
// is not finite or, with `refuse_saturated`, at full scale or flat at its maximum in several
// places.
hal::Result<std::vector<double>> read_spectrum(const std::filesystem::path& file,
                                               const SpectrumInput& input, bool refuse_saturated);

// Tissue: of a recording of raw spectra the first whole volume.
struct TissueInput {
  std::optional<pipeline::SpectraShape> shape; // a recording says it itself
  std::optional<hal::SampleType> type;
};
hal::Result<pipeline::SpectraFile> open_tissue(const std::filesystem::path& file,
                                               const TissueInput& input);

// Raw little-endian samples as numbers.
std::vector<double> to_numbers(std::span<const std::byte> bytes, hal::SampleType type);

} // namespace octascope::firmware_host

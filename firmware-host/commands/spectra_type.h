// --spectra, --shape, --dtype and --shift: raw spectra, and what a sample of them is.
#pragma once

#include <optional>
#include <string>

#include <CLI/App.hpp>

#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"
#include "pipeline/reconstruction/spectrum_format.h"

namespace octascope::firmware_host {

// As text, the way CLI11 collects it.
struct SpectraTypeArguments {
  std::string type = "u16";
  int shift = 0;
};

// Both need `spectra`.
void add_spectra_type_options(CLI::App& command, SpectraTypeArguments& arguments,
                              CLI::Option* spectra);

struct SpectraType {
  hal::SampleType type = hal::SampleType::u16;
  std::optional<int> significant_bits; // empty: what the shift leaves
};
SpectraType spectra_type_of(const SpectraTypeArguments& arguments);

// ErrorCode::invalid_argument where type, bits and shift do not go together.
hal::Result<pipeline::SpectrumFormat> spectrum_format(int samples, const SpectraType& type,
                                                      int right_shift);

// The same for what plays spectra as a camera does, which counts: f32 is refused.
hal::Result<pipeline::SpectrumFormat> camera_format(int samples,
                                                    const SpectraTypeArguments& arguments);

// --spectra with its --shape and type, or a recording of raw spectra, which says them itself: a shape
// that was given as well must agree. For what plays spectra as a camera does.
hal::Result<RecordingOptions> recording_options(const std::string& spectra,
                                                const std::string& shape,
                                                const SpectraTypeArguments& type);

} // namespace octascope::firmware_host

#include "firmware-host/commands/spectra_type.h"

#include <map>

#include <CLI/CLI.hpp>

#include "firmware-host/commands/numbers.h"
#include "pipeline/recordings/raw/raw_reader.h"

namespace octascope::firmware_host {

using hal::ErrorCode;
using hal::SampleType;

namespace {

// Cameras of 10, 12 and 14 bits are u16 with fewer significant ones. u16 and u8 leave open how many
// there are: what the shift leaves.
const std::map<std::string, SpectraType>& types() {
  static const std::map<std::string, SpectraType> all{
      {"u8", {SampleType::u8, {}}},   {"u10", {SampleType::u16, 10}},
      {"u12", {SampleType::u16, 12}}, {"u14", {SampleType::u16, 14}},
      {"u16", {SampleType::u16, {}}}, {"f32", {SampleType::f32, {}}}};
  return all;
}

} // namespace

void add_spectra_type_options(CLI::App& command, SpectraTypeArguments& arguments,
                              CLI::Option* spectra) {
  command
      .add_option("--dtype", arguments.type,
                  "Type of a sample (u16 if not given); u10, u12 and u14 take 16 bits")
      ->check(CLI::IsMember({"u8", "u10", "u12", "u14", "u16", "f32"}))
      ->needs(spectra)
      ->type_name("u8|u10|u12|u14|u16|f32")
      ->option_text("u8|u10|u12|u14|u16|f32");
  command
      .add_option("--shift", arguments.shift,
                  "Bits to shift each sample to the right: left-justified 12-bit counts need "
                  "--dtype u12 --shift 4")
      ->check(within(0, 15))
      ->needs(spectra)
      ->type_name("BITS");
}

SpectraType spectra_type_of(const SpectraTypeArguments& arguments) {
  return types().at(arguments.type);
}

hal::Result<pipeline::SpectrumFormat> spectrum_format(int samples, const SpectraType& type,
                                                      int right_shift) {
  pipeline::SpectrumFormat format{samples, type.type};
  if (type.type == SampleType::f32 && right_shift != 0)
    return hal::fail(ErrorCode::invalid_argument,
                     "--shift is {}, but f32 cannot be shifted, expected 0", right_shift);
  const int bits = format.significant_bits;
  format.right_shift = right_shift;
  format.significant_bits = type.significant_bits.value_or(bits - right_shift);
  if (right_shift < 0 || format.significant_bits < 1 ||
      format.significant_bits + right_shift > bits)
    return hal::fail(
        ErrorCode::invalid_argument,
        "--shift is {}, expected 0 to {}: the sample has {} bits, {} of them significant",
        right_shift, bits - type.significant_bits.value_or(1), bits,
        type.significant_bits.value_or(bits));
  return format;
}

hal::Result<pipeline::SpectrumFormat> camera_format(int samples,
                                                    const SpectraTypeArguments& arguments) {
  const SpectraType type = spectra_type_of(arguments);
  if (type.type == SampleType::f32)
    return hal::fail(ErrorCode::invalid_argument,
                     "--dtype is f32, expected u8, u10, u12, u14 or u16, which cameras give; "
                     "octascope reconstruct takes f32, and render --volume draws what it writes");
  return spectrum_format(samples, type, arguments.shift);
}

namespace {

hal::Result<RecordingOptions> raw_recording_options(const std::string& spectra,
                                                    const std::string& shape) {
  HAL_TRY(const auto reader, pipeline::RawReader::open(spectra));
  const pipeline::RawFacts& facts = reader.facts();
  if (facts.averaged_lines > 0)
    return hal::fail(ErrorCode::invalid_argument,
                     "{}: found the mean of {} lines, expected a volume of spectra; octascope "
                     "calibrate takes it",
                     spectra, facts.averaged_lines);
  RecordingOptions options{spectra,
                           {facts.plan.sweeps(), facts.kept_lines(), facts.format.samples_per_line},
                           pipeline::SpectrumFormat{facts.format}};
  if (shape.empty())
    return options;
  HAL_TRY(const auto given, pipeline::SpectraShape::parse(shape));
  if (given != options.shape)
    return hal::fail(ErrorCode::invalid_argument,
                     "--shape is {}, expected none, or {},{},{}, as {} says", shape,
                     options.shape.b_scans, options.shape.a_scans, options.shape.samples, spectra);
  return options;
}

} // namespace

hal::Result<RecordingOptions> recording_options(const std::string& spectra,
                                                const std::string& shape,
                                                const SpectraTypeArguments& type) {
  if (pipeline::is_raw_recording(spectra))
    return raw_recording_options(spectra, shape);
  if (shape.empty())
    return hal::fail(ErrorCode::invalid_argument,
                     "--spectra needs --shape B,A,N: B-scans, A-scans, samples");
  HAL_TRY(const auto parsed, pipeline::SpectraShape::parse(shape));
  HAL_TRY(const auto format, camera_format(parsed.samples, type));
  return RecordingOptions{spectra, parsed, format};
}

} // namespace octascope::firmware_host

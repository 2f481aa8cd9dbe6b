#include "firmware-host/commands/volume/reconstruct_input.h"

#include <utility>

#include "firmware-host/commands/spectra_type.h"
#include "pipeline/recordings/raw/raw_reader.h"

namespace octascope::firmware_host {

using hal::ErrorCode;

namespace {

hal::Result<pipeline::Calibration> load_calibration(const ReconstructOptions& options, int samples,
                                                    pipeline::Calibration otherwise) {
  if (options.calibration)
    return pipeline::Calibration::load(*options.calibration, samples);
  return otherwise;
}

hal::Result<ReconstructInput> open_plain(const ReconstructOptions& options) {
  if (!options.shape)
    return hal::fail(ErrorCode::invalid_argument,
                     "--spectra needs --shape B,A,N: B-scans, A-scans, samples");
  if (options.raw_volume)
    return hal::fail(ErrorCode::invalid_argument,
                     "--volume is {}, expected none: {} is no recording of raw spectra (HDF5)",
                     *options.raw_volume, options.spectra.string());
  const pipeline::SpectraShape& shape = *options.shape;
  const int repeats = options.repeats.value_or(1);
  if (shape.b_scans % repeats != 0)
    return hal::fail(ErrorCode::invalid_argument,
                     "--shape has {} sweeps, expected a multiple of the {} repeats of each B-scan",
                     shape.b_scans, repeats);
  const auto format =
      spectrum_format(shape.samples, {options.type, options.significant_bits}, options.right_shift);
  if (!format) // told as such ever since, as if the file did not fit
    return hal::fail(ErrorCode::bad_data, "{}", format.error().message);
  HAL_TRY(auto spectra, pipeline::SpectraFile::open(options.spectra, shape, options.type));
  HAL_TRY(auto calibration,
          load_calibration(options, shape.samples, pipeline::Calibration::identity(shape.samples)));
  return ReconstructInput{std::move(spectra), *format, std::move(calibration), repeats};
}

// What another calibration does not say of the scan, the recording does.
void take_lateral_spacings(const pipeline::ScanPlan& plan, pipeline::Calibration& calibration) {
  pipeline::AssumedSpacings& assumed = calibration.assumed_spacings;
  if (assumed.a_scans) {
    calibration.a_spacing_um = plan.a_spacing_um;
    assumed.a_scans = plan.assumed_spacings.a_scans;
  }
  if (assumed.b_scans) {
    calibration.b_spacing_um = plan.b_spacing_um;
    assumed.b_scans = plan.assumed_spacings.b_scans;
  }
}

// As the run had it, but for another calibration that was asked for.
hal::Result<ReconstructInput> open_recording(const ReconstructOptions& options) {
  HAL_TRY(const auto reader, pipeline::RawReader::open(options.spectra));
  const pipeline::RawFacts& facts = reader.facts();
  if (facts.averaged_lines > 0)
    return hal::fail(ErrorCode::invalid_argument,
                     "{}: found the mean of {} lines, expected a volume of spectra; octascope "
                     "calibrate takes it",
                     options.spectra.string(), facts.averaged_lines);
  if (options.repeats && *options.repeats != facts.plan.repeats)
    return hal::fail(ErrorCode::invalid_argument, "--repeats is {}, expected {}, as {} says",
                     *options.repeats, facts.plan.repeats, options.spectra.string());
  HAL_TRY(const auto volume, options.raw_volume ? reader.whole_volume(*options.raw_volume)
                                                : reader.first_whole_volume());
  HAL_TRY(auto spectra, reader.spectra(volume.first, volume.count, pipeline::RawLines::kept));
  if (options.shape && *options.shape != spectra.shape())
    return hal::fail(ErrorCode::invalid_argument,
                     "--shape is {},{},{}, expected none, or {},{},{}, as {} says",
                     options.shape->b_scans, options.shape->a_scans, options.shape->samples,
                     spectra.shape().b_scans, spectra.shape().a_scans, spectra.shape().samples,
                     options.spectra.string());
  HAL_TRY(auto calibration,
          load_calibration(options, facts.format.samples_per_line, facts.calibration));
  ReconstructInput input{std::move(spectra), pipeline::SpectrumFormat{facts.format},
                         std::move(calibration), facts.plan.repeats};
  input.plan = facts.plan;
  input.plan->zero_padding = input.calibration.zero_padding;
  input.plan->scan_lag_a_scans = reader.frames()[volume.first].scan_lag_a_scans;
  HAL_TRY(input.backgrounds, reader.backgrounds(volume.first, volume.count));
  input.path = facts.path == "fused" ? pipeline::ReconstructionPath::fused
                                     : pipeline::ReconstructionPath::fftw;
  input.isa = facts.path == "fused" ? facts.isa : std::string{};
  if (options.calibration) {
    take_lateral_spacings(facts.plan, input.calibration);
    return input;
  }
  input.calibration.a_spacing_um = facts.plan.a_spacing_um;
  input.calibration.b_spacing_um = facts.plan.b_spacing_um;
  input.calibration.depth_spacing_um = facts.plan.depth_spacing_um;
  input.calibration.refractive_index = facts.plan.refractive_index;
  input.calibration.assumed_spacings = facts.plan.assumed_spacings;
  return input;
}

} // namespace

pipeline::VolumeGeometry ReconstructInput::geometry() const {
  return {calibration.depths(),
          a_scans(),
          b_scans(),
          calibration.bin_spacing_um(),
          calibration.a_spacing_um,
          calibration.b_spacing_um,
          calibration.refractive_index,
          calibration.assumed_spacings};
}

hal::Result<ReconstructInput> open_input(const ReconstructOptions& options) {
  return pipeline::is_raw_recording(options.spectra) ? open_recording(options)
                                                     : open_plain(options);
}

} // namespace octascope::firmware_host

// What `reconstruct` works on: spectra, plain or a recording of them, and what belongs to them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware-host/commands/volume/reconstruct.h"
#include "hal/result.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/reconstruction/path_choice.h"
#include "pipeline/reconstruction/spectra_file.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/volume/volume_geometry.h"

namespace octascope::firmware_host {

struct ReconstructInput {
  pipeline::SpectraFile spectra; // the sweeps of one volume
  pipeline::SpectrumFormat format;
  pipeline::Calibration calibration;
  int repeats = 1;

  // Of a recording.
  std::optional<pipeline::ScanPlan> plan = {}; // with its scan lag; empty: plain spectra
  std::vector<float> backgrounds = {};         // running ones, [sweep][sample]; empty: to be found
  pipeline::ReconstructionPath path = pipeline::ReconstructionPath::automatic;
  std::string isa = {};

  int b_scans() const { return spectra.shape().b_scans / repeats; }
  int a_scans() const { return plan ? plan->a_scans : spectra.shape().a_scans; }
  pipeline::VolumeGeometry geometry() const;
};

// ErrorCode::invalid_argument for what a user can correct on the command line.
hal::Result<ReconstructInput> open_input(const ReconstructOptions& options);

} // namespace octascope::firmware_host

// The raw spectra of a run, kept beside its levels or instead of them.
#pragma once

#include <string>

#include "firmware-host/configuration/run_options.h"
#include "firmware-host/devices/devices.h"
#include "firmware-host/reconstruction/reconstruction.h"
#include "hal/result.h"
#include "pipeline/acquisition/volume_thread.h"
#include "pipeline/recordings/raw/raw_recorder.h"
#include "ui/status/status.h"

namespace octascope::firmware_host {

// Begun now.
pipeline::RawFacts raw_facts(const Devices& devices, const Reconstruction& reconstruction,
                             const RunOptions& options, std::string configuration_text);

// Has the workers offer each frame that they have converted. All three outlive the volumes' thread.
void offer_frames(pipeline::VolumeThreadSetup& setup, const Reconstruction& reconstruction,
                  pipeline::RawRecorder& recorder);

// For the screen, which says of both recordings that one is on, and what was not kept.
void add_raw(ui::RecordingStatus& status, const pipeline::RawRecorderStatus& raw,
             hal::TimePoint now);

// Before the run: that the file is not there and can be made; leaves nothing behind.
hal::Result<> check_raw_file(const std::filesystem::path& file);

// After the run: what the file holds, and whether it ended by itself or holds nothing.
std::string raw_summary(const pipeline::RawRecorder& recorder);
hal::Result<> raw_outcome(const pipeline::RawRecorder& recorder);

} // namespace octascope::firmware_host

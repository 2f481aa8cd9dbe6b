// What a user asked of `octascope run` or `octascope replay`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "pipeline/reconstruction/spectra_file.h"
#include "pipeline/volume/eye.h"

namespace octascope::firmware_host {

enum class DisplayChoice : std::uint8_t { automatic, kms, window, offscreen };

struct RecordingOptions {
  std::filesystem::path file;
  pipeline::SpectraShape shape;
  pipeline::SpectrumFormat format{shape.samples, hal::SampleType::u16}; // u8 or u16
};

// For `octascope replay`: volumes come from a file and no camera is used.
struct ReplayOptions {
  std::filesystem::path file;
  double rate = 1;
  bool once = false;
  std::size_t from = 0; // the first volume, counted from 0
};

struct RunOptions {
  std::optional<std::filesystem::path> configuration;
  DisplayChoice display = DisplayChoice::automatic;
  std::optional<std::array<int, 2>> size; // width, height
  bool simulate = false;                  // twins even where a real device is present
  std::optional<double> duration_s;
  std::optional<std::uint64_t> volumes;
  std::optional<RecordingOptions> recording;
  std::optional<ReplayOptions> replay;
  std::optional<std::filesystem::path> calibration;
  std::optional<std::filesystem::path> snapshot;
  std::optional<std::filesystem::path> report;
  std::optional<std::filesystem::path> trace;    // of a run
  std::optional<std::filesystem::path> faults;   // fault script for the twins
  std::optional<std::filesystem::path> controls; // what the pedal's twin does, and when
  std::optional<std::string> phantom;
  std::optional<std::filesystem::path> vessels;      // a tree, shown in the volume
  std::optional<std::filesystem::path> registration; // from the tree to the volume
  bool bidirectional = false;                        // overrides the plan
  bool rolling = false;                              // likewise, [display] rolling and the settings
  std::optional<std::filesystem::path> record_to;    // all volumes, from the first on
  std::optional<std::filesystem::path> raw_to;       // likewise, their raw spectra
  std::string subject;                               // of recordings; empty: not given
  pipeline::Eye eye = pipeline::Eye::not_said;       // likewise
  std::optional<int> repeats;                        // overrides the plan
  std::optional<bool> flow;                          // overrides [pipeline] flow
};

} // namespace octascope::firmware_host

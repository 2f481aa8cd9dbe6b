// Writes one volume to one file in each format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "firmware-host/commands/recordings/export.h"
#include "hal/result.h"
#include "pipeline/recordings/recording.h"

namespace octascope::firmware_host {

// What is written besides the levels.
struct VolumeToExport {
  const pipeline::Volume& volume;
  const pipeline::RecordedVolume& entry;
  std::size_t n = 0; // of the recording, from 0
};

// Bound to one thread.
class VolumeExporter {
public:
  virtual ~VolumeExporter() = default;

  // The file appears complete or not at all, readable by its owner alone.
  virtual hal::Result<> write(const std::filesystem::path& file, const VolumeToExport& volume) = 0;

  // Approximate size of a file; 0 if unknown beforehand and small.
  virtual std::uint64_t file_bytes() const = 0;
};

// `options.window` is set if the format needs one; `facts` must outlive the exporter.
hal::Result<std::unique_ptr<VolumeExporter>>
make_volume_exporter(const ExportOptions& options, const pipeline::RecordingFacts& facts,
                     const pipeline::RecordedVolume& first);

} // namespace octascope::firmware_host

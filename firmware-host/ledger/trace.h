// What every thread did for each of the last volumes that were shown, for a viewer of traces.
//
// The file is in the Trace Event Format (Google, 2016) that Perfetto and chrome://tracing open:
// complete events ("X") with times in microseconds.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "firmware-host/ledger/passage.h"
#include "hal/result.h"
#include "pipeline/volume/volume.h"

namespace octascope::firmware_host {

// For one thread. Allocates on construction and in write() only.
class Trace {
public:
  static constexpr std::size_t most_volumes = 1000; // older ones are left out

  explicit Trace(int b_scans);

  // `volume` comes from the pipeline.
  void add(const pipeline::Volume& volume, const Showing& showing);

  // Whole or not at all. Times count from `started`.
  hal::Result<> write(const std::filesystem::path& file, hal::TimePoint started) const;

private:
  struct Passage {
    pipeline::VolumeMetadata metadata;
    Showing showing;
  };

  std::size_t b_scans_;
  std::size_t added_ = 0;
  std::vector<Passage> passages_;          // a ring
  std::vector<pipeline::BScanWork> works_; // `b_scans_` for each of them
};

} // namespace octascope::firmware_host

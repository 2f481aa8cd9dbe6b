// The last volumes' ways to the glass, for the display's timing diagram.
#pragma once

#include "firmware-host/ledger/passage.h"
#include "pipeline/volume/volume.h"
#include "ui/status/timing.h"

namespace octascope::firmware_host {

// For one thread. Allocates on construction only.
class TimingHistory {
public:
  explicit TimingHistory(int b_scans);

  // `volume` comes from the pipeline.
  void add(const pipeline::Volume& volume, const Showing& showing);

  const ui::Timing& timing() const { return timing_; }

private:
  ui::Timing timing_;
  std::size_t next_ = 0; // the oldest
};

} // namespace octascope::firmware_host

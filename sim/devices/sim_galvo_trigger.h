// The simulated galvo trigger: its pulses reach the scanner of a GalvoLink.
#pragma once

#include "hal/galvo_trigger.h"
#include "sim/devices/galvo_link.h"
#include "sim/faults/fault_probe.h"

namespace octascope::sim {

class SimGalvoTrigger final : public hal::GalvoTrigger {
public:
  // All borrowed objects must outlive the trigger; `faults` may be null.
  SimGalvoTrigger(GalvoLink& link, hal::Clock& clock, const FaultSchedule* faults = nullptr);

private:
  std::string_view do_backend() const override { return "sim"; }
  bool do_simulated() const override { return true; }
  hal::Result<> do_open(const hal::GalvoTriggerConfig& config) override;
  hal::Result<hal::TimePoint> do_pulse() override;
  void do_close() override;

  GalvoLink& link_;
  hal::Clock& clock_;
  FaultProbe probe_;
  hal::GalvoTriggerConfig config_;
  hal::TimePoint line_is_low_; // from then on: the falling edge of the last pulse
};

} // namespace octascope::sim

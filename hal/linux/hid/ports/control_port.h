// One open node of a control: a device with raw reports, or an input device.
#pragma once

#include <memory>
#include <optional>

#include "hal/linux/hid/decoders/hid_decoder.h"
#include "hal/linux/hid/models/control_model.h"
#include "hal/linux/hid/survey/hid_survey.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Threads: one at a time.
class ControlPort {
public:
  virtual ~ControlPort() = default;

  // ErrorCode::denied, busy, absent …; a keyboard is grabbed, so that it does not type elsewhere.
  static Result<std::unique_ptr<ControlPort>> open(const HidNode& node, const ControlModel& model);

  // Starts reading; call it once. Lights the device's lamp, if it has one, until destruction;
  // a lamp that fails is not an error.
  Result<> start() { return do_start(); }

  // The following are for a started port.

  // Readable when read() has something to return.
  int descriptor() const { return do_descriptor(); }

  // Whether there was an event or a report; `reading` has its contents, or is empty if it has none
  // of interest. Does not wait; allocates only if the device is gone.
  Result<bool> read(std::optional<HidReading>& reading) { return do_read(reading); }

  // Stops reading. Does not wait, but destruction may: first call finish() on all ports that are to
  // be destroyed, so that their waits overlap.
  void finish() { do_finish(); }

private:
  virtual Result<> do_start() = 0;
  virtual int do_descriptor() const = 0;
  virtual Result<bool> do_read(std::optional<HidReading>& reading) = 0;
  virtual void do_finish() {}
};

// The remedy for a control that may not be opened or is used by another program.
std::string remedy_of_control(const std::string& node, ErrorCode fault);

} // namespace octascope::hal::linux_backend

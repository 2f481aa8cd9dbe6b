// One open file of a control: a device with raw reports or an input device.
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

  // ErrorCode::denied, busy, absent …; a keyboard is grabbed, so that it types nowhere else.
  static Result<std::unique_ptr<ControlPort>> open(const HidNode& node, const ControlModel& model);

  // From now on it is listened to, once, and its lamp is lit, where it has one, until this is
  // destroyed. What a lamp does not do is nobody's fault.
  Result<> start() { return do_start(); }

  // Once started: readable when read() has something to tell.
  int descriptor() const { return do_descriptor(); }

  // Once started: whether there was an event or a report; what it says is in `reading`, which stays
  // empty for one that says nothing. Does not wait; no allocation unless the device is gone.
  Result<bool> read(std::optional<HidReading>& reading) { return do_read(reading); }

  // Once started: nothing more is read. Does not wait, where destroying may: with all that are to
  // go at once, it waits but once.
  void finish() { do_finish(); }

private:
  virtual Result<> do_start() = 0;
  virtual int do_descriptor() const = 0;
  virtual Result<bool> do_read(std::optional<HidReading>& reading) = 0;
  virtual void do_finish() {}
};

// What to do about a control that may not be opened or is held by somebody.
std::string remedy_of_control(const std::string& node, ErrorCode fault);

} // namespace octascope::hal::linux_backend

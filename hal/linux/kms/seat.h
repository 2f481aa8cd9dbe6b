// The right to use a display and keyboards: granted by the seat's manager (seatd, logind) through
// libseat, which takes it back while another console is in front; or plainly taken, where nobody
// manages seats and we may (root, a test bench).
#pragma once

#include <memory>
#include <string>

#include "hal/clock.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend::kms {

struct SeatDevice {
  FileDescriptor file;
  int id = -1; // the seat's name for it
};

// Threads: one thread at a time.
class Seat {
public:
  Seat() = default;
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;
  virtual ~Seat() = default;

  virtual Result<SeatDevice> open_device(const std::string& node) = 0;
  virtual void close_device(SeatDevice device) = 0;

  // Makes an open card ours to set modes on. ErrorCode::busy: another program has it.
  virtual Result<> take_card(const SeatDevice& card) = 0;

  // Hears what the manager says, without waiting; false while another console is in front: devices
  // must be left alone then. False once, too, where one was in front since the last call: what the
  // devices were set to may be lost.
  virtual bool active() = 0;

  // Sleeps until the manager says something, at most `timeout`.
  virtual void wait(Duration timeout) = 0;
};

// Waits up to two seconds for the console to be ours. ErrorCode::absent: no manager answers.
Result<std::unique_ptr<Seat>> open_managed_seat();
std::unique_ptr<Seat> open_plain_seat();

} // namespace octascope::hal::linux_backend::kms

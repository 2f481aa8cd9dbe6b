// The right to use a display and keyboards: granted by the seat's manager (seatd, logind) through
// libseat, which takes it back while another console is in front; or taken directly where no
// manager runs and the user may (root, a test bench).
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

  // Handles the manager's messages, without waiting. False while another console is in front:
  // devices must not be used then. Also false once if one was in front since the last call, because
  // the devices' settings may be lost.
  virtual bool active() = 0;

  // Sleeps until the manager says something, at most `timeout`.
  virtual void wait(Duration timeout) = 0;
};

// Waits up to two seconds for the console to be ours. ErrorCode::absent: no manager answers.
Result<std::unique_ptr<Seat>> open_managed_seat();
std::unique_ptr<Seat> open_plain_seat();

} // namespace octascope::hal::linux_backend::kms

// Access to the display and keyboards. A seat manager (seatd, logind) grants it through libseat and
// revokes it while another console is in the foreground. Without a manager, the devices are opened
// directly, if the user may (root, a test bench).
#pragma once

#include <memory>
#include <string>

#include "hal/clock.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend::kms {

struct SeatDevice {
  FileDescriptor file;
  int id = -1; // libseat's device id
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

  // Makes this process the master of an open card, so that it may set modes. ErrorCode::busy:
  // another program is.
  virtual Result<> take_card(const SeatDevice& card) = 0;

  // Handles the manager's messages without waiting. False while another console is in the
  // foreground: the devices must not be used then. Also false once if one was since the last call,
  // because the devices' settings may be lost.
  virtual bool active() = 0;

  // Waits at most `timeout` for a message of the manager.
  virtual void wait(Duration timeout) = 0;
};

// Waits up to two seconds for access to the console. ErrorCode::absent: no manager answers.
Result<std::unique_ptr<Seat>> open_managed_seat();
std::unique_ptr<Seat> open_plain_seat();

} // namespace octascope::hal::linux_backend::kms

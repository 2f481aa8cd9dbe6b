// Pedals, knobs and pucks: every known one that is plugged in, on one board (control_board.h).
//
// The device that leads (the first of known_controls()) is the one whose profile fits. A control
// that is plugged in while the others are in use joins them at once: what is pressed is released,
// and the numbers are given anew. When one is pulled out, the contract of hal::ControlInput holds
// for all of them; after close() and open() the rest serves on.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hal/control_input.h"
#include "hal/linux/hid/controls/control_board.h"
#include "hal/linux/hid/ports/control_port.h"
#include "hal/linux/hid/survey/hid_survey.h"
#include "hal/linux/system/device_watch.h"

namespace octascope::hal::linux_backend {

// A control in use.
struct ServingControl {
  PluggedControl control;
  ControlBoard::Place place; // its switches and knobs on the board
};

// Threads: as hal::ControlInput; serving(), complaints() and changes() are free.
class HidControls final : public ControlInput {
public:
  // `clock` outlives this and keeps to CLOCK_MONOTONIC. `models`: which devices are opened, in the
  // order of precedence; learned ones may be put before the listed ones.
  explicit HidControls(Clock& clock, std::vector<ControlModel> models = listed_control_models());
  ~HidControls() override;

  // The leading control first; empty while none is open. For the choice of a profile.
  std::vector<ServingControl> serving() const;
  // One for each known control that is plugged in and could not be opened: why, and the remedy.
  std::vector<std::string> complaints() const;
  // Grows whenever serving() changes.
  std::uint64_t changes() const { return changes_.load(std::memory_order_acquire); }

private:
  struct Port {
    std::unique_ptr<ControlPort> file;
    std::string node;
    std::size_t on_board = 0;
  };

  std::string_view do_backend() const override { return "hid"; }
  bool do_simulated() const override { return false; }
  Result<> do_open() override;
  Result<std::size_t> do_read(std::span<ControlEvent> events, Duration timeout) override;
  std::uint64_t do_bounces() const override { return board_.bounces(); }
  void do_close() override;

  Result<> watch();
  Result<> open_all();
  void open_one(const PluggedControl& control, std::vector<ServingControl>& serving,
                std::vector<Error>& refused);
  void close_ports();
  void publish(std::vector<ServingControl> serving, const std::vector<Error>& refused);

  void receive(TimePoint until);
  void look_for_changes();
  void read_port(Port& port);
  void look_for_new_ones();
  bool is_open(const std::string& node) const;
  bool can_be_opened_now(const PluggedControl& control) const;

  Clock& clock_;
  const std::vector<ControlModel> models_;
  std::optional<DeviceWatch> hidraw_watch_, input_watch_;
  std::vector<Port> ports_;
  ControlBoard board_;
  bool held_back_ = false;    // there was no room for all that could be read
  std::optional<Error> lost_; // told when all that came before it has been taken
  bool released_ = false;     // after it was lost, everything that was pressed

  mutable std::mutex serving_guard_; // never taken while nothing is plugged or pulled
  std::vector<ServingControl> serving_;
  std::vector<std::string> complaints_;
  std::atomic<std::uint64_t> changes_{0};
};

} // namespace octascope::hal::linux_backend

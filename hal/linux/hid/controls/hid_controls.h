// All known pedals, knobs and pucks that are plugged in, combined by control_board.h.
//
// The leading device, the first of known_controls(), determines the profile. A control that is
// plugged in later is added immediately: pressed switches are reported as released, and all
// switches and knobs are renumbered. When one is unplugged, all of them fail as
// hal::ControlInput::read() says; after close() and open() the remaining ones work again.
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
  ControlBoard::Place place; // the numbers of its switches and knobs
};

// Threads: as hal::ControlInput; serving(), complaints() and changes() from any thread.
class HidControls final : public ControlInput {
public:
  // `clock` is borrowed, must outlive this and must run on CLOCK_MONOTONIC. `models`: the devices
  // to open, in order of precedence; learned models may precede the listed ones.
  explicit HidControls(Clock& clock, std::vector<ControlModel> models = listed_control_models());
  ~HidControls() override;

  // The leading control first; empty while none is open. For choosing a profile.
  std::vector<ServingControl> serving() const;
  // One for each known control that is plugged in but could not be opened: reason and remedy.
  std::vector<std::string> complaints() const;
  // Increases whenever serving() changes.
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
                std::vector<Error>& refused, std::optional<Error>& not_yet);
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
  bool held_back_ = false;    // there was no room for everything that could be read
  std::optional<Error> lost_; // returned after all earlier events
  bool released_ = false;     // after the loss, everything was reported as released

  mutable std::mutex serving_guard_; // locked by read() only when something is plugged in
  std::vector<ServingControl> serving_;
  std::vector<std::string> complaints_;
  std::atomic<std::uint64_t> changes_{0};
};

} // namespace octascope::hal::linux_backend

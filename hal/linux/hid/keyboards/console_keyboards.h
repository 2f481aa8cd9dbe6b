// Keyboards on the console, without a window system: only those that the configuration lists by
// vendor and product, since an unknown keyboard must not control the microscope. Each is grabbed,
// so that it does not type into the console as well.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/key_source.h"
#include "hal/linux/hid/keyboards/keyboard_decoder.h"
#include "hal/linux/hid/ports/evdev_file.h"
#include "hal/linux/system/device_watch.h"

namespace octascope::hal::linux_backend {

// A keyboard that is plugged in while the display is open works immediately. When it is unplugged,
// its held keys are reported as released. One that cannot be opened is retried every two seconds.
class ConsoleKeyboards final : public KeySource {
public:
  // `clock` is borrowed and must outlive this. `listed`: "046d:c31c", in lower case.
  ConsoleKeyboards(Clock& clock, std::vector<std::string> listed);

  // The nodes that are being read.
  std::vector<std::string> serving() const;
  // One for each listed keyboard that is plugged in but could not be opened: reason and remedy.
  const std::vector<std::string>& complaints() const { return complaints_; }

private:
  struct Keyboard {
    EvdevFile file;
    KeyboardDecoder decoder;
  };

  void do_attend(bool ours) override;
  std::size_t do_poll_events(std::span<DisplayEvent> events) override;

  void look_for_changes(bool one_is_gone);
  void look_for_keyboards();
  bool is_listed(const std::string& usb) const;
  bool read(Keyboard& keyboard); // false: it is gone
  void let_go(Keyboard& keyboard);

  Clock& clock_;
  const std::vector<std::string> listed_;
  bool ours_ = false;
  std::optional<DeviceWatch> watch_;
  std::vector<Keyboard> keyboards_;
  std::deque<DisplayEvent> told_; // not yet polled
  std::vector<std::string> complaints_;
  TimePoint looked_;
};

} // namespace octascope::hal::linux_backend

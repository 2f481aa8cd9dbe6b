#include "firmware-host/commands/devices/devices_learn.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/configuration/control_device_file.h"
#include "firmware-host/run/stop_signal.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/linux/hid/learning/learning_session.h"
#include "hal/linux/monotonic_clock.h"

namespace octascope::firmware_host {

namespace {

using hal::linux_backend::HidNode;
using hal::linux_backend::LearningSession;
using namespace std::chrono_literals;

constexpr hal::Duration look_every = 200ms;
constexpr hal::Duration settling = 500ms; // a device's files come one after the other

std::vector<HidNode> nodes_of(std::string_view usb) {
  std::vector<HidNode> nodes = hal::linux_backend::survey_hid();
  std::erase_if(nodes, [&](const HidNode& node) {
    return hal::linux_backend::usb_id(node.vendor, node.product) != usb;
  });
  return nodes;
}

enum class Typed : std::uint8_t { nothing, a_line, the_end };

// What waits on standard input; no byte after the line is taken.
Typed typed() {
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  constexpr int most_letters = 4096; // at a time: a signal may have come
  for (int i = 0; i<most_letters&& ::poll(&input, 1, 0)> 0; ++i) {
    char letter = 0;
    if (::read(STDIN_FILENO, &letter, 1) <= 0)
      return Typed::the_end;
    if (letter == '\n')
      return Typed::a_line;
  }
  return Typed::nothing;
}

// Vendor and product of the next device that is plugged in. An Error where that is no longer waited
// for.
hal::Result<std::string> wait_for_new_device(const LearnOptions& options, hal::Clock& clock,
                                             StopSignal& stop) {
  std::vector<HidNode> known = hal::linux_backend::survey_hid();
  for (;;) {
    const Typed said = options.reads_input ? typed() : Typed::nothing;
    if (stop.requested() || said == Typed::a_line)
      return hal::fail(hal::ErrorCode::absent, "given up before a device was plugged in");
    if (said == Typed::the_end)
      return hal::fail(
          hal::ErrorCode::absent,
          "the input has ended, expected somebody at a terminal who plugs a device in: "
          "start it there, or name one that is plugged in, as --device 1234:5678");
    clock.sleep_for(look_every);
    std::vector<HidNode> now = hal::linux_backend::survey_hid();
    for (const HidNode& node : now)
      if (std::ranges::find(known, node) == known.end()) {
        clock.sleep_for(settling);
        return hal::linux_backend::usb_id(node.vendor, node.product);
      }
    known = std::move(now); // one that was pulled out is new when it comes back
  }
}

// Until it is quiet, a signal comes or the device goes. Somebody at a terminal has all the time before
// the first switch.
void listen(LearningSession& session, const LearnOptions& options, hal::Clock& clock,
            StopSignal& stop) {
  const bool attended = ::isatty(STDIN_FILENO) != 0;
  hal::TimePoint last = clock.now();
  while (!stop.requested()) {
    const auto lines = session.listen(50ms);
    if (!lines) {
      warn("{}\n", lines.error().message);
      return;
    }
    for (const std::string& line : *lines)
      say("  {}\n", line);
    if (!lines->empty())
      last = clock.now();
    std::fflush(stdout);
    if ((session.learned() || !attended) && clock.now() - last > hal::from_seconds(options.quiet_s))
      return;
  }
}

bool write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out{file};
  out << text;
  out.close();
  if (!out)
    warn("{}: not written; is its folder there, and may you write to it?\n", file.string());
  return static_cast<bool>(out);
}

int write_files(const hal::linux_backend::ControlModel& model, const LearnOptions& options) {
  const std::string device = options.out.string() + ".device.toml";
  const std::string profile = options.out.string() + ".profile.toml";
  if (!write(device, control_device_text(model)) || !write(profile, first_profile_text(model)))
    return exit_failed;
  say("{} switches learned. Say in the configuration:\n[controls]\ndevice = \"{}\"\n"
      "file = \"{}\"\nand give each switch its action in {}.\n",
      model.switches, device, profile, profile);
  return exit_done;
}

} // namespace

int learn_control(const LearnOptions& options) {
  StopSignal stop;
  hal::linux_backend::MonotonicClock clock;
  std::string usb = options.usb;
  if (usb.empty()) {
    say("Plug the new device in now, or pull it out and put it in again. {} gives up.\n",
        options.reads_input ? "Enter" : "Ctrl+C");
    std::fflush(stdout);
    auto found = wait_for_new_device(options, clock, stop);
    if (!found)
      return complain("devices --learn", found.error());
    usb = std::move(*found);
  }
  auto session = LearningSession::listen_to(nodes_of(usb));
  if (!session) {
    warn("{}: {}\n", usb, session.error().message);
    return exit_failed;
  }
  say("Listening to {}. Press each switch and let it go, one after the other, the left one "
      "first. Ctrl+C ends it, or {} s without a press.\n",
      usb, options.quiet_s);
  std::fflush(stdout);
  listen(*session, options, clock, stop);
  const auto model = session->learned();
  if (!model) {
    warn("{}: no switch was learned, expected at least one to be pressed and let go "
         "alone; try again\n",
         usb);
    return exit_failed;
  }
  return write_files(*model, options);
}

} // namespace octascope::firmware_host

// Where the picture goes: a KMS output, a development window, or an offscreen surface.
//
// A display brings a GLES 3 context of its own. It says nothing about what is drawn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "hal/clock.h"
#include "hal/device.h"
#include "hal/result.h"

namespace octascope::hal {

struct DisplayConfig {
  int width = 1280; // of the drawn picture in pixels; a display with one mode only may ignore them
  int height = 720;
  double refresh_hz = 60; // a wish, as above
  bool fullscreen = false;
  std::string title = "octascope";
};

// One picture reached the glass (or the memory, offscreen).
struct Flip {
  TimePoint completed;
  std::uint64_t sequence = 0; // counts completed flips since open()
};

enum class DisplayEventKind : std::uint8_t { close_requested, resized, key_pressed, key_released };

// Keys that have no ASCII code. Letters and digits are reported by their ASCII codes (lower case);
// other keys are not reported.
enum class Key : std::uint16_t {
  escape = 27,
  space = 32,
  left = 256,
  right,
  up,
  down,
  page_up,
  page_down,
  home,
  end,
  tab,
  enter,
  f1,
};

struct DisplayEvent {
  DisplayEventKind kind = DisplayEventKind::close_requested;
  std::uint16_t key = 0; // a Key or an ASCII code, for key events
  bool repeated = false; // a key held down
  bool shift = false;
  TimePoint time;
};

// Threads: bound to the thread that calls open() (the render thread). state() is free.
class Display : public Device {
public:
  // absent → ready, with the context current on the calling thread.
  Result<> open(const DisplayConfig& config) { return do_open(config); }

  // The drawable's size in pixels now. May change with a `resized` event.
  int width() const { return do_width(); }
  int height() const { return do_height(); }

  // How often a new picture can be shown.
  Duration refresh_period() const { return do_refresh_period(); }

  // Makes what was drawn visible, waits until it is, and until the next may be drawn.
  // ErrorCode::disconnected: the output is gone, the state is `failed` and the context lost: forget
  // every GL name, close() and open() again.
  Result<Flip> present() { return do_present(); }

  // Never waits; returns the number of events written, oldest first.
  std::size_t poll_events(std::span<DisplayEvent> events) { return do_poll_events(events); }

  // Any state → absent; the context is gone.
  void close() { do_close(); }

private:
  virtual Result<> do_open(const DisplayConfig& config) = 0;
  virtual int do_width() const = 0;
  virtual int do_height() const = 0;
  virtual Duration do_refresh_period() const = 0;
  virtual Result<Flip> do_present() = 0;
  virtual std::size_t do_poll_events(std::span<DisplayEvent> events) = 0;
  virtual void do_close() = 0;
};

} // namespace octascope::hal

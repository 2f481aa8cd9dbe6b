// An image output: a KMS output, a development window or an offscreen surface.
//
// A display owns a GLES 3 context. It does not define what is drawn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hal/clock.h"
#include "hal/device.h"
#include "hal/result.h"

namespace octascope::hal {

struct DisplayConfig {
  int width = 1280; // of the image in pixels; a display with only one mode may ignore these
  int height = 720;
  double refresh_hz = 60; // preferred, not guaranteed
  bool fullscreen = false;
  std::string title = "octascope";
};

// One image became visible on screen (or complete in memory, offscreen).
struct Flip {
  TimePoint completed;
  std::uint64_t sequence = 0; // number of completed flips since open()
  TimePoint submitted{};      // handed to the output
};

// The buffer into which the next image is drawn. A display that cannot say leaves it as it is.
struct BackBuffer {
  std::uint64_t image = 0; // the number of the next image that is handed over; 0: not known
  std::uint64_t holds = 0; // that of the image that the buffer still holds; 0: not known
};

enum class DisplayEventKind : std::uint8_t { close_requested, resized, key_pressed, key_released };

// Named keys. Letters and digits are reported by their ASCII codes (lower case); other keys are not
// reported.
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
  bool repeated = false; // auto-repeat of a held key
  bool shift = false;
  TimePoint time;
};

// Threads: bound to the thread that calls open() (the render thread). state() may be called from
// any thread.
class Display : public Device {
public:
  // absent → ready, with the GL context current on the calling thread.
  Result<> open(const DisplayConfig& config);

  // The drawable's current size in pixels. May change with a `resized` event.
  int width() const { return do_width(); }
  int height() const { return do_height(); }

  // The shortest time between two images.
  Duration refresh_period() const { return do_refresh_period(); }

  // When the image after the last one can become visible, for an output that shows images once per
  // refresh period and waits for that; also whole periods later. Empty for one that shows an image as
  // soon as it is presented, and until the first was.
  std::optional<TimePoint> next_refresh() const { return do_next_refresh(); }

  // To be asked before an image is drawn. What the buffer holds may be drawn over in part only.
  BackBuffer back_buffer() { return do_back_buffer(); }

  // Shows what was drawn; waits until it is visible and the next image may be drawn.
  // ErrorCode::disconnected: the output is gone, the state is `failed` and the GL context is lost
  // with all its objects: close() and open() again.
  Result<Flip> present() { return do_present(); }

  // Never waits; returns the number of events written, oldest first.
  std::size_t poll_events(std::span<DisplayEvent> events) { return do_poll_events(events); }

  // Any state → absent; destroys the GL context.
  void close() { do_close(); }

private:
  virtual Result<> do_open(const DisplayConfig& config) = 0;
  virtual int do_width() const = 0;
  virtual int do_height() const = 0;
  virtual Duration do_refresh_period() const = 0;
  virtual std::optional<TimePoint> do_next_refresh() const { return std::nullopt; }
  virtual BackBuffer do_back_buffer() { return {}; }
  virtual Result<Flip> do_present() = 0;
  virtual std::size_t do_poll_events(std::span<DisplayEvent> events) = 0;
  virtual void do_close() = 0;
};

} // namespace octascope::hal

// A render loop on fakes: volumes, knobs, microscope pictures and losses come when the test says,
// on a time axis that only the test and the display's refreshes move.
#pragma once

#include <array>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "firmware-host/run/render_loop.h"
#include "hal/linux/monotonic_clock.h"
#include "pipeline/acquisition/volume_thread.h"
#include "pipeline/scan/scan_plan.h"
#include "sim/clock/virtual_clock.h"
#include "sim/devices/offscreen_display.h"
#include "tests/support/devices/fake_devices.h"
#include "tests/ui/support/scene.h"
#include "ui/layout/layout.h"

namespace octascope::tests {

// Keeps what reached the glass, and lets drawing take time on the virtual axis.
class GlassDisplay final : public hal::Display {
public:
  explicit GlassDisplay(sim::VirtualClock& clock) : clock_(clock), inner_(clock) {}

  sim::OffscreenDisplay& cable() { return inner_; }

  // What drawing costs; called between a frame's beginning and its end.
  std::function<hal::Duration()> cost;

  // It shows an image at the next refresh, as a monitor does; else as soon as it is presented.
  bool refreshes = false;

  // What a frame is drawn over has a spot of another colour in its corner, so that one that is drawn as a
  // whole is told from one of which parts are: when those were completed.
  bool spoils = false;
  std::vector<hal::TimePoint> whole_frames;

  // Another console is in front: what is presented is seen by nobody.
  bool covered = false;
  // Opening it fails for this reason.
  std::optional<hal::Error> refusal;

  int frames = 0;
  pipeline::Image picture; // of the last frame
  hal::TimePoint completed;

private:
  std::string_view do_backend() const override { return inner_.backend(); }
  bool do_simulated() const override { return true; }
  hal::Result<> do_open(const hal::DisplayConfig& config) override {
    if (refusal)
      return tl::make_unexpected(*refusal);
    return inner_.open(config);
  }
  int do_width() const override { return inner_.width(); }
  int do_height() const override;
  hal::Duration do_refresh_period() const override { return inner_.refresh_period(); }
  std::optional<hal::TimePoint> do_next_refresh() const override;
  hal::BackBuffer do_back_buffer() override;
  hal::Result<hal::Flip> do_present() override;
  std::size_t do_poll_events(std::span<hal::DisplayEvent>) override;
  void do_close() override { inner_.close(); }

  sim::VirtualClock& clock_;
  sim::OffscreenDisplay inner_;
  mutable int sizes_asked_ = 0; // in this turn
  std::uint64_t last_flip_ = 0;
};

class FakeControls final : public hal::ControlInput {
public:
  void send(const std::vector<hal::ControlEvent>& events);

private:
  std::string_view do_backend() const override { return "fake"; }
  bool do_simulated() const override { return true; }
  hal::Result<> do_open() override;
  hal::Result<std::size_t> do_read(std::span<hal::ControlEvent> events,
                                   hal::Duration timeout) override;
  void do_close() override { set_state(hal::DeviceState::absent); }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<hal::ControlEvent> queue_;
};

// Sends the one picture that it is given, once.
class FakeScope final : public hal::ScopeCamera {
public:
  void send(const hal::ScopeFrame& frame);

private:
  std::string_view do_backend() const override { return "fake"; }
  bool do_simulated() const override { return true; }
  hal::Result<> do_open(const hal::ScopeCameraConfig&) override;
  hal::Result<> do_start() override;
  hal::Result<std::optional<hal::ScopeFrame>> do_wait_frame(hal::Duration timeout) override;
  void do_release(int) override {}
  void do_stop() override { set_state(hal::DeviceState::ready); }
  void do_close() override { set_state(hal::DeviceState::absent); }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<hal::ScopeFrame> next_;
};

// What volumes hold.
enum class Tissue : std::uint8_t { usual, reversed };

// Skips where no offscreen context can be made.
class LoopStage : public testing::Test {
protected:
  LoopStage();
  void SetUp() override;
  void TearDown() override;

  // Switch 0 freezes, 1 finds the window, 2 keeps a picture; knob 0 moves it, knob 1 turns the volume.
  static ui::ControlProfile profile();
  static pipeline::ScanPlan plan();

  // Makes and opens a loop that begins with `view`; or one of other volumes, with what all have.
  void start(ui::ViewState view);
  static firmware_host::RenderLoopSetup setup();
  void open(firmware_host::RenderLoopSetup setup, pipeline::VolumeFeed& volumes,
            const pipeline::Acquisition* acquisition, pipeline::ScopeThread* scope);

  // One round of the loop; if it drew nothing, a refresh passes all the same.
  void turn();
  void turn_until(hal::TimePoint time);
  // What drawing costs from now on: so much for the volume at full quality where something of its picture
  // differs from the last one, and the rest of a frame. `anew` is told at which quality each such was drawn.
  void draw_for(hal::Duration full, hal::Duration rest,
                std::function<void(const ui::DrawQuality&)> anew = {});
  // Until the picture would not get any better.
  void rest();

  // Turns while the time of a volume passes, and then one comes. It is not in a frame yet.
  void send_volume(Tissue tissue);
  // B-scans of a volume that begins with number 0, as they come: turns until the last was exposed,
  // and waits until all are finished that can be. They are not in a frame yet.
  void send_b_scans(Tissue tissue, int from, int to);
  hal::TimePoint exposed(int b_scan) const { return pulsed_ + b_scan * plan().frame_period(); }
  // After a pause, or a camera that was unplugged: the next volume can come.
  void resume_sweeps();
  void send_controls(const std::vector<hal::ControlEvent>& events);
  void turn_knob(std::uint8_t knob, int detents);
  void press_freeze();
  void send_scope_picture();

  const ui::ViewState& view() const { return loop_->actions().state(); }
  ui::Layout layout() const;

  int kept_pictures_ = 0;
  sim::VirtualClock clock_;
  sim::VirtualClock
      sweep_clock_; // of trigger and volumes; moved to the other's time by send_volume()
  hal::linux_backend::MonotonicClock real_clock_; // of the fakes' threads
  GlassDisplay display_{clock_};
  FakeCamera camera_;
  FakeTrigger trigger_{sweep_clock_};
  FakeControls controls_;
  FakeScope scope_;
  const ScopePicture scope_picture_{64, 48};
  const std::array<pipeline::Volume, 2> tissues_;
  pipeline::FaultLog faults_;
  firmware_host::PictureProof proof_;
  pipeline::Wakeup arrived_, news_;
  std::unique_ptr<pipeline::Acquisition> acquisition_;
  std::unique_ptr<pipeline::VolumeThread> volumes_;
  std::unique_ptr<pipeline::ControlThread> control_thread_;
  std::unique_ptr<pipeline::ScopeThread> scope_thread_;
  std::unique_ptr<firmware_host::VesselDisplay> vessels_; // null: none
  std::unique_ptr<firmware_host::RenderLoop> loop_;
  hal::Duration longest_turn_ = std::chrono::milliseconds{40};

private:
  void await(std::string_view what, const std::function<bool()>& came);
  void await_news();

  void deliver(Tissue tissue, int b_scan);

  std::size_t next_pulse_ = 0;
  hal::TimePoint pulsed_; // the volume of which B-scans are sent
  std::uint64_t sequence_ = 0;
};

} // namespace octascope::tests

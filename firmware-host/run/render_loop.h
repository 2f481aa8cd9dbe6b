// The render thread's work: newest volume → texture → frame → flip, and what hands and feet did.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "firmware-host/run/status_writer.h"
#include "firmware-host/supervision/picture_proof.h"
#include "firmware-host/vessels/vessel_display.h"
#include "hal/clock.h"
#include "hal/control_input.h"
#include "hal/display.h"
#include "pipeline/acquisition/acquisition.h"
#include "pipeline/acquisition/volume_feed.h"
#include "pipeline/controls/control_thread.h"
#include "pipeline/controls/scope_thread.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/duration_statistics.h"
#include "pipeline/threads/retry_delay.h"
#include "pipeline/threads/wakeup.h"
#include "ui/controls/legend_lines.h"
#include "ui/controls/view_controller.h"
#include "ui/layout/scan_field.h"
#include "ui/pacing/governor.h"
#include "ui/renderer.h"
#include "ui/scene/ray_trial.h"
#include "ui/status/freshness.h"
#include "ui/status/status.h"
#include "ui/transfer/auto_window.h"
#include "ui/transfer/transfer_set.h"

namespace octascope::firmware_host {

// Everything is borrowed and outlives the loop.
struct RenderLoopParts {
  hal::Display& display;
  hal::Clock& clock;
  pipeline::VolumeFeed& volumes;
  const pipeline::Acquisition* acquisition; // null: the volumes come from no camera
  pipeline::ScopeThread* scope;             // null: there is no scope camera
  pipeline::ControlThread& controls;
  pipeline::FaultLog& faults;
  pipeline::Wakeup& news; // posted by the three threads above
  // A picture that the surgeon asked for; called on the render thread, so it must not take long.
  // False: it could not be kept.
  std::function<bool(pipeline::Image)> keep_picture;
  // Begins a recording or ends the one that is on; what to say of it. Empty: there are none.
  std::function<std::string_view()> record = {};
  // Keys that stand for the simulated pedal; empty where the pedal is real.
  std::function<void(const hal::ControlEvent&)> simulated_control;
  pipeline::ThreadSetup threads;    // of those that help drawing
  VesselDisplay* vessels = nullptr; // null: no vessels
  PictureProof* proof = nullptr;    // null: nobody asks whether the picture is true
};

struct RenderLoopSetup {
  hal::DisplayConfig display;
  ui::ViewState view;
  ui::TransferSet transfers; // what view.transfer and view.colour_map choose from
  ui::ControlProfile controls;
  bool window_from_first_volume = true; // else the view's
  // What an earlier run had set; reset_view goes back to `view`.
  std::optional<ui::ViewState> restored_view;
  bool window_restored = false; // so the first volume decides only over what to go back to
  ui::FreshnessLimits freshness;
  int b_scans = 80;
  int lines_per_frame = 379;
  std::optional<ui::ScanField> scan_field;
  HostStatus host; // to begin with
};

struct FrameStatistics {
  pipeline::DurationStatistics upload;
  pipeline::DurationStatistics draw;
  pipeline::DurationStatistics latency;
  pipeline::DurationStatistics control; // pedal or knob → end of the first frame that shows it
  std::uint64_t frames_drawn = 0;
  std::uint64_t frames_missed = 0;
  std::uint64_t volumes_taken = 0;             // out of the triple buffer
  std::uint64_t volumes_displayed = 0;         // of those, in a frame that reached the glass
  std::optional<hal::TimePoint> first_picture; // of a volume
  std::optional<ui::RayTrial> rays;            // where there was something to choose
};

// Bound to one thread, the render thread. The display may vanish and return at any time.
class RenderLoop {
public:
  RenderLoop(const RenderLoopParts& parts, RenderLoopSetup setup);
  ~RenderLoop();

  // Opens the display unless it is open; an Error here is final (there is nothing to show anything
  // on).
  hal::Result<> open();

  // One round: input, newest volume, a frame if something changed. Waits at most one refresh.
  // False once somebody asked to quit.
  bool turn();

  // Has the newest volume that was published been in a frame?
  bool shows_newest() const {
    return volume_ != nullptr && !undisplayed_last_line_ && !parts_.volumes.has_newer();
  }

  // Draws the newest state and returns the picture. Empty when the display is gone.
  std::optional<pipeline::Image> picture();

  const ui::ViewActions& actions() const { return controller_.actions(); }
  const FrameStatistics& statistics() const { return statistics_; }
  const ui::Status& status() const { return status_writer_.status(); }
  RunCounters counters() const; // up to now
  // Once all threads have ended: with what is never taken any more, and rates over all of the run.
  RunCounters final_counters(hal::Duration lasted) const;

  // What the display says of it from the next frame on.
  void tell(const HostStatus& host) { status_writer_.tell(host); }

  ui::ViewActions& editable_actions() { return controller_.actions(); }

  // Other functions and colour maps to choose from; the picture is drawn anew. The view's indices
  // are the caller's to bring into line.
  void change_transfers(ui::TransferSet transfers);
  void change_veil(hal::Duration veil_after) { setup_.freshness.veil_after = veil_after; }

  // Another pedal or knob leads.
  void change_controls(ui::ControlProfile profile);

  // Of the newest frame's volume.
  const ui::DrawQuality& quality() const { return quality_; }

private:
  ui::FrameBudget frame_budget() const;
  ui::DrawQuality choose_quality();
  void choose_ray_backend();
  void show_levels();
  bool handle_input();
  void answer(const ui::ControlRequests& requests);
  void find_window();
  void keep_picture();
  void take_volume();
  void take_scope_picture();
  void update_status();
  void draw_if_changed();
  void flip_done(const hal::Flip& flip, hal::TimePoint begin);
  void lose_display(const hal::Error& error);
  void prove_picture(const hal::Flip& flip);
  void look_for_display(const hal::Error& error, hal::TimePoint now);
  hal::Result<> open_display();
  hal::Result<> show_again();
  void set_first_window(const ui::DisplayWindow& window);
  void show_scope_picture();
  bool display_ready();

  RenderLoopParts parts_;
  RenderLoopSetup setup_;
  ui::Legend legend_; // of the profile
  const ui::Legend key_legend_;
  StatusWriter status_writer_{legend_, key_legend_};
  ui::ViewController controller_;
  std::unique_ptr<ui::Renderer> renderer_; // null while the display is gone
  bool software_ = false;                  // the processor draws
  ui::Governor governor_;
  ui::DrawQuality quality_;
  bool rays_tried_ = false;
  std::optional<ui::RayBackend> rays_; // the faster one, once it is known
  std::uint64_t levels_of_ = 0;        // of which volume the histogram is
  std::optional<ui::ViewState> drawn_view_;
  ui::Liveness drawn_liveness_ = ui::Liveness::waiting;
  const pipeline::Volume* volume_ = nullptr;          // the newest taken, ours until the next take
  const hal::ScopeFrame* scope_picture_ = nullptr;    // likewise
  std::optional<hal::TimePoint> undisplayed_control_; // of the oldest event not shown yet
  std::optional<hal::TimePoint> undisplayed_last_line_; // of a volume that no frame has shown yet
  bool volume_undisplayed_ = false;         // no frame has shown volume_ yet, however long it takes
  std::uint64_t last_flip_ = 0;             // its number, of this opening of the display
  std::optional<hal::TimePoint> presented_; // last time, whether it was seen or not
  std::optional<hal::TimePoint> display_lost_; // empty while it is there
  bool picture_wanted_ = false;                // by a key or a pedal: the next frame is kept
  pipeline::RetryDelay retry_;
  FrameStatistics statistics_;
};

} // namespace octascope::firmware_host

// The render thread's work: newest volume → texture → frame → flip, and the input of pedal, knob
// and keys.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "firmware-host/ledger/passage.h"
#include "firmware-host/ledger/shown_quality.h"
#include "firmware-host/ledger/timing_history.h"
#include "firmware-host/ledger/trace.h"
#include "firmware-host/run/shown_volume.h"
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
#include "pipeline/scan/scan_plan.h"
#include "pipeline/threads/duration_statistics.h"
#include "pipeline/threads/retry_delay.h"
#include "pipeline/threads/wakeup.h"
#include "ui/controls/legend_lines.h"
#include "ui/controls/view_controller.h"
#include "ui/layout/scan_field.h"
#include "ui/pacing/governor.h"
#include "ui/pacing/late_start.h"
#include "ui/renderer.h"
#include "ui/scene/ray_trial.h"
#include "ui/status/freshness.h"
#include "ui/status/status.h"
#include "ui/transfer/auto_window.h"
#include "ui/transfer/transfer_set.h"

namespace octascope::firmware_host {

// Everything is borrowed and must outlive the loop.
struct RenderLoopParts {
  hal::Display& display;
  hal::Clock& clock;
  pipeline::VolumeFeed& volumes;
  const pipeline::Acquisition* acquisition; // null: the volumes do not come from a camera
  pipeline::ScopeThread* scope;             // null: there is no microscope camera
  pipeline::ControlThread& controls;
  pipeline::FaultLog& faults;
  pipeline::Wakeup& news; // posted by the three threads above
  // Keeps a picture that the surgeon took. Called on the render thread, so it must be quick. False:
  // it could not be kept.
  std::function<bool(pipeline::Image)> keep_picture;
  // Begins a recording or ends the present one; returns the text to show. Empty: no recordings.
  std::function<std::string_view()> record = {};
  // Keys that stand for the simulated pedal; empty where the pedal is real.
  std::function<void(const hal::ControlEvent&)> simulated_control;
  pipeline::ThreadSetup threads;    // for threads that help drawing
  VesselDisplay* vessels = nullptr; // null: no vessels
  PictureProof* proof = nullptr;    // null: nobody asks for proof
  Trace* trace = nullptr;           // null: nobody asks for one
};

struct RenderLoopSetup {
  hal::DisplayConfig display;
  ui::ViewState view;
  ui::TransferSet transfers; // indexed by view.transfer and view.colour_map
  ui::ControlProfile controls;
  bool window_from_first_volume = true; // else the view's
  // Settings of an earlier run; reset_view goes back to `view`.
  std::optional<ui::ViewState> restored_view;
  bool window_restored = false; // the first volume then sets only what reset_view goes back to
  ui::FreshnessLimits freshness;
  pipeline::VolumeGeometry geometry = pipeline::ScanPlan{}.geometry(); // of the volumes to come
  int lines_per_frame = 379;
  std::optional<ui::ScanField> scan_field;
  ui::ScanOrientation orientation;
  HostStatus host; // initial
};

struct FrameStatistics {
  pipeline::DurationStatistics upload;
  pipeline::DurationStatistics draw;
  pipeline::DurationStatistics latency;
  StageStatistics stages;               // of it, for volumes from the pipeline
  pipeline::DurationStatistics control; // pedal or knob → end of the first frame that shows it
  ShownQuality quality;
  std::uint64_t frames_drawn = 0;
  std::uint64_t frames_missed = 0;
  std::uint64_t volumes_taken = 0;             // from the triple buffer
  std::uint64_t volumes_displayed = 0;         // of those, shown in a frame that reached the glass
  std::optional<hal::TimePoint> first_picture; // that showed a volume
  std::optional<ui::RayTrial> rays;            // if there was a choice
};

// Bound to one thread, the render thread. The display may vanish and return at any time.
class RenderLoop {
public:
  RenderLoop(const RenderLoopParts& parts, RenderLoopSetup setup);
  ~RenderLoop();

  // Opens the display unless it is open. An Error is final: there is nothing to show anything on, or
  // it cannot show the volumes to come.
  hal::Result<> open();

  // One round: input, newest volume, and a frame if something changed. Waits at most one refresh.
  // False once quitting is requested.
  bool turn();

  // Whether the newest published volume has been in a frame.
  bool shows_newest() const {
    return volume_.whole() != nullptr && !undisplayed_last_line_ && !parts_.volumes.has_newer();
  }

  // Draws the newest state and returns the picture; empty if the display is gone.
  std::optional<pipeline::Image> picture();

  const ui::ViewActions& actions() const { return controller_.actions(); }
  const FrameStatistics& statistics() const { return statistics_; }
  const ui::Status& status() const { return status_writer_.status(); }
  RunCounters counters() const; // up to now
  // After all threads have ended: includes volumes never taken, with rates over the whole run.
  RunCounters final_counters(hal::Duration lasted) const;

  // Sets what the display says about the host from the next frame on.
  void tell(const HostStatus& host) { status_writer_.tell(host); }

  ui::ViewActions& editable_actions() { return controller_.actions(); }

  // Replaces the functions and colour maps to choose from and redraws. The caller adapts the view's
  // indices.
  void change_transfers(ui::TransferSet transfers);
  void change_orientation(const ui::ScanOrientation& orientation) {
    status_writer_.orient(orientation);
  }
  void change_veil(hal::Duration veil_after) { setup_.freshness.veil_after = veil_after; }

  // Replaces the profile when another pedal or knob leads.
  void change_controls(ui::ControlProfile profile);

  // Of the trees traced in the volumes; empty where none are.
  std::optional<LiveTreeThread::Counters> traced_trees() const {
    return parts_.vessels != nullptr ? parts_.vessels->traced() : std::nullopt;
  }

  // Of all lines that were shown so far.
  pipeline::DurationSummary line_latency() const { return volume_.line_latency(); }

  // Of the newest frame's volume picture.
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
  bool casts_rays() const;
  bool draws_parts() const;
  void take_volume();
  void note_taken(const pipeline::Volume& newest, hal::TimePoint begin);
  void take_scope_picture();
  void update_status();
  hal::TimePoint free_again(hal::TimePoint now) const;
  bool awaits_volume() const;
  bool is_to_be_whole() const;
  bool volume_comes_soon() const;
  void draw_if_changed();
  void flip_done(const hal::Flip& flip, hal::TimePoint begin);
  void note_passage();
  void lose_display(const hal::Error& error);
  void prove_picture(const hal::Flip& flip);
  void look_for_display(const hal::Error& error, hal::TimePoint now);
  hal::Result<> open_display();
  hal::Result<> show_again();
  void report_flow_refusal();
  void set_first_window(const ui::DisplayWindow& window);
  void show_scope_picture();
  void wait_to_begin();
  std::optional<hal::TimePoint> next_refresh() const;
  bool display_ready();

  RenderLoopParts parts_;
  RenderLoopSetup setup_;
  ui::Legend legend_; // of the profile
  const ui::Legend key_legend_;
  TimingHistory timing_{setup_.geometry.b_scans};
  StatusWriter status_writer_{legend_, key_legend_, timing_.timing()};
  ui::ViewController controller_;
  std::unique_ptr<ui::Renderer> renderer_; // null while the display is gone
  bool software_ = false;                  // GL draws on the processor
  ui::Governor governor_;
  ui::DrawQuality quality_;
  bool rays_tried_ = false;
  std::optional<ui::RayBackend> rays_; // the faster one, once known
  std::uint64_t levels_of_ = 0;        // the volume that the histogram is of
  std::optional<ui::ViewState> drawn_view_;
  ui::Liveness drawn_liveness_ = ui::Liveness::waiting;
  ShownVolume volume_{parts_.volumes, setup_.geometry};
  bool flow_refusal_reported_ = false;
  const hal::ScopeFrame* scope_picture_ = nullptr;    // the newest taken, valid until the next take
  std::optional<hal::TimePoint> undisplayed_control_; // time of the oldest event not shown yet
  std::optional<hal::TimePoint> undisplayed_last_line_; // of a volume not shown yet
  bool volume_undisplayed_ = false; // the newest whole one has not been in a frame yet
  Showing showing_;                 // of the newest whole one, so far
  ui::LateStart late_start_;
  hal::TimePoint turn_began_{};
  std::optional<hal::TimePoint> drawn_whole_;  // not in parts
  std::uint64_t last_flip_ = 0;                // its number since this opening of the display
  std::optional<hal::TimePoint> presented_;    // time of the last presentation, seen or not
  std::optional<hal::TimePoint> last_free_;    // when the display gave the renderer free after it
  std::optional<hal::TimePoint> display_lost_; // empty while it is present
  bool picture_wanted_ = false;                // by key or pedal: keep the next frame
  pipeline::RetryDelay retry_;
  FrameStatistics statistics_;
};

} // namespace octascope::firmware_host

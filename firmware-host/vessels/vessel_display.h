// The vessel tree of the running display: loads it, or has it traced in the live flow, places it in the volume, limits its detail to
// what the frame rate allows, moves it with the knob and saves its registration.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "firmware-host/outputs/registration_writer.h"
#include "firmware-host/vessels/live_tree_display.h"
#include "firmware-host/vessels/vessel_follower.h"
#include "firmware-host/vessels/vessel_loader.h"
#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/vessels/registration.h"
#include "ui/controls/view_actions.h"
#include "ui/pacing/governor.h"
#include "ui/renderer.h"
#include "ui/status/status.h"
#include "ui/vessels/hybrid/detail_governor.h"

namespace octascope::firmware_host {

struct VesselDisplaySetup {
  std::filesystem::path file; // empty: none
  std::optional<std::filesystem::path> registration_file;
  std::optional<pipeline::Registration> registration; // none: the tree is not registered
  pipeline::PatientEye operated;                      // the eye in the picture
  bool live = false; // trees are traced in the volumes; drawn where there is no file
  pipeline::ThreadSetup threads{};
};

class VesselDisplay;
struct RunOptions;

// The tree that the options name, loaded beside the display, or trees traced in the flow that the volumes
// come with (`live`); null without either. An Error if a
// named registration cannot be used, since a tree in the wrong place would mislead.
// ErrorCode::invalid_argument if the registration names another subject or eye than `operated`.
// Everything borrowed must outlive it.
hal::Result<std::unique_ptr<VesselDisplay>>
make_vessel_display(const RunOptions& options, bool live, pipeline::PatientEye operated,
                    hal::Clock& clock, pipeline::FaultLog& faults, pipeline::Wakeup& news,
                    const pipeline::ThreadSetup& threads);

// Bound to the render thread. Everything borrowed must outlive it.
class VesselDisplay {
public:
  VesselDisplay(VesselDisplaySetup setup, hal::Clock& clock, pipeline::FaultLog& faults,
                pipeline::Wakeup& news);

  // Takes what was loaded, traced or written meanwhile; `renderer` is null while the display is gone,
  // `shown` until there is a whole volume.
  void advance(ui::Renderer* renderer, ui::ViewActions& actions, const pipeline::Volume* shown);
  // After the frame: has vessels traced in what it showed.
  void trace(const pipeline::Volume* shown, const ui::ViewState& view);

  // Shows the tree again with a new renderer.
  hal::Result<> show_again(ui::Renderer& renderer);

  // Saves the tree's place including the view's nudge; reports when it is written.
  void keep_registration(const pipeline::VolumeGeometry& geometry, ui::ViewActions& actions);

  // Writes the traced tree that is drawn, if one is, into `folder`; says when it is written.
  void keep_tree(const std::filesystem::path& folder);
  // Of the trees traced; empty where none are.
  std::optional<LiveTreeThread::Counters> traced() const;

  // The level of detail for the frame that begins now; `moved`: the view differs from the last
  // frame's.
  float detail_px(hal::TimePoint now, bool moved);
  // Whether, in that frame, they shade what lies close behind them.
  bool occluded() const { return governor_.occluded(at_rest_); }
  // Call after each frame; the vessels get a share of `budget`.
  void note(const ui::Renderer::VesselReport& report, hal::Duration budget);

  const ui::VesselStatus& status() const { return status_; }

  // One line for the surgeon; empty: nothing to say.
  const std::string& notice(hal::TimePoint now) const;

private:
  void take_loaded(ui::Renderer* renderer, ui::ViewActions& actions);
  void show_live(ui::Renderer* renderer, ui::ViewActions& actions, const pipeline::Volume* shown);
  void follow(ui::Renderer* renderer, const pipeline::Volume* shown, bool frozen);
  void take_place(FollowedVessels found);
  bool is_followed() const { return followed_ && followed_->place.volume_from_tree; }
  void say_place(bool was_known);
  // Where the tree from the file is drawn, empty: nobody knows.
  std::optional<pipeline::RigidTransform> drawn_place() const;
  void describe_place();
  void take_kept_tree();
  void take_written(ui::Renderer* renderer, ui::ViewActions& actions);
  void say(std::string notice);
  hal::Result<> show(ui::Renderer& renderer) const;
  ui::PlacedVessels placed() const;
  pipeline::PatientEye whose_vessels() const;

  VesselDisplaySetup setup_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  pipeline::Wakeup& news_;
  std::optional<VesselLoader> loader_;
  std::optional<LoadedVessels> loaded_;
  std::optional<LiveTreeDisplay> live_;
  std::optional<VesselFollower> follower_;  // of the tree from the file, where trees are traced
  std::optional<FollowedVessels> followed_; // what it said last
  hal::Duration place_age_{};               // of its registration, while it is followed
  RegistrationWriter keeper_{"."};
  pipeline::RigidTransform kept_; // what is being written
  ui::VesselNudge kept_nudge_;    // the nudge included in it
  ui::DetailGovernor governor_{{}};
  std::optional<hal::TimePoint> moved_at_;
  bool at_rest_ = true;
  ui::VesselStatus status_;
  std::string notice_;
  hal::TimePoint notice_until_{};
};

} // namespace octascope::firmware_host

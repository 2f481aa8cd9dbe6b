// The vessel tree of the running display: loaded beside it, placed in the volume, drawn no more
// finely than frames allow, moved by the knob and kept.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "firmware-host/outputs/registration_writer.h"
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
  std::filesystem::path file;
  std::optional<std::filesystem::path> registration_file;
  std::optional<pipeline::Registration> registration; // none: the tree's place is not known
  pipeline::PatientEye operated;                      // the eye in the picture
};

class VesselDisplay;
struct RunOptions;

// The tree that the options name, loaded beside the display; null where they name none. A tree in a
// wrong place would mislead: without its registration, where one is named, an Error. So would
// another patient's tree: ErrorCode::invalid_argument where its registration says another subject
// or eye than `operated`. Everything borrowed outlives it.
hal::Result<std::unique_ptr<VesselDisplay>>
make_vessel_display(const RunOptions& options, pipeline::PatientEye operated, hal::Clock& clock,
                    pipeline::FaultLog& faults, pipeline::Wakeup& news);

// Bound to the render thread. Everything borrowed outlives it.
class VesselDisplay {
public:
  VesselDisplay(VesselDisplaySetup setup, hal::Clock& clock, pipeline::FaultLog& faults,
                pipeline::Wakeup& news);

  // Takes what was loaded or written meanwhile; `renderer` is null while the display is gone.
  void advance(ui::Renderer* renderer, ui::ViewActions& actions);

  // A new renderer shows what the lost one did.
  hal::Result<> show_again(ui::Renderer& renderer);

  // Keeps where the tree lies with the view's nudge; says so when it is written.
  void keep_registration(const pipeline::VolumeGeometry& geometry, ui::ViewActions& actions);

  // How finely to draw the frame that begins now; `moved`: the view differs from the last frame's.
  float detail_px(hal::TimePoint now, bool moved);
  // After a frame; a share of `budget` is the vessels'.
  void note(const ui::Renderer::VesselReport& report, hal::Duration budget);

  const ui::VesselStatus& status() const { return status_; }

  // One line for the surgeon while there is something to say; empty: nothing.
  const std::string& notice(hal::TimePoint now) const;

private:
  void take_loaded(ui::Renderer* renderer, ui::ViewActions& actions);
  void take_written(ui::Renderer* renderer, ui::ViewActions& actions);
  void say(std::string notice);
  hal::Result<> show(ui::Renderer& renderer) const;
  ui::PlacedVessels placed() const;
  pipeline::PatientEye whose_vessels() const;

  VesselDisplaySetup setup_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  VesselLoader loader_;
  std::optional<LoadedVessels> loaded_;
  RegistrationWriter keeper_{"."};
  pipeline::RigidTransform kept_; // what is being written
  ui::VesselNudge kept_nudge_;    // which made it
  ui::DetailGovernor governor_{{}};
  std::optional<hal::TimePoint> moved_at_;
  bool at_rest_ = true;
  ui::VesselStatus status_;
  std::string notice_;
  hal::TimePoint notice_until_{};
};

} // namespace octascope::firmware_host

// The state of the machine for the heads-up display. Plain data, filled in by the host.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/clock.h"
#include "hal/device.h"
#include "pipeline/faults/fault.h"
#include "pipeline/vessels/tree.h"
#include "pipeline/volume/eye.h"
#include "ui/controls/legend_lines.h"
#include "ui/status/axis_words.h"
#include "ui/status/freshness.h"
#include "ui/status/timing.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

struct DeviceStatus {
  pipeline::Device device{};
  std::string_view backend; // "v4l2", "sim" …: must be a literal
  hal::DeviceState state = hal::DeviceState::absent;
  bool operator==(const DeviceStatus&) const = default;
};

struct Losses {
  std::uint64_t lines = 0;
  std::uint64_t b_scans = 0;
  std::uint64_t volumes = 0;
  bool any() const { return lines != 0 || b_scans != 0 || volumes != 0; }
  bool operator==(const Losses&) const = default;
};

// A tree traced in the flow of the live volume (docs/ANGIOGRAPHY.md).
struct TracedTreeStatus {
  static constexpr hal::Duration old_after = std::chrono::seconds{3};      // is marked from then on
  static constexpr hal::Duration removed_after = std::chrono::seconds{10}; // is not drawn any more

  enum class State : std::uint8_t { shown, refused, removed };
  State state = State::refused;
  hal::Duration age{}; // of the flow that it was traced in
  std::uint64_t vessels = 0;
  double length_mm = 0; // of all together
  std::string refusal;  // a few words; empty unless refused
  bool operator==(const TracedTreeStatus&) const = default;
};

// How a tree from a file is kept over what flows in the live volume (docs/ANGIOGRAPHY.md).
struct FollowedTreeStatus {
  // Since it was registered last; in between, only shifts are followed.
  static constexpr hal::Duration old_after = std::chrono::seconds{3}; // is marked from then on
  static constexpr hal::Duration unregistered_after = std::chrono::seconds{10};
  static constexpr hal::Duration removed_after = std::chrono::seconds{30}; // its place is given up

  enum class State : std::uint8_t {
    looking, // for its place
    followed,
    unmatched, // it has too little of the vessels that flow
    removed,   // it was followed, and could not be registered for too long
  };
  State state = State::looking;
  double overlap = 0;  // while followed: of the vessels that flow, those that it has
  hal::Duration age{}; // while followed, or removed: of the flow that it was registered in last
  bool operator==(const FollowedTreeStatus&) const = default;
};

// The vessel tree shown in the volume.
struct VesselStatus {
  enum class State : std::uint8_t { none, loading, shown, failed };
  State state = State::none;
  float progress = 0;                // of loading, 0…1
  bool registered = false;           // to the volume; else its place in the picture has no meaning
  std::optional<double> residual_mm; // of the registration; empty: it is not from points
  std::array<bool, pipeline::vessel_branch_count> branches{}; // the branches that it has
  SegmentCounts account;                                      // of the last frame that drew it
  std::optional<TracedTreeStatus> traced; // empty: the tree is from a file, or there is none yet
  std::optional<FollowedTreeStatus> followed; // empty: its place is not looked for
  bool operator==(const VesselStatus&) const = default;
};

// A recording that is shown instead of the live volume.
struct ReplayStatus {
  std::string recorded; // local date and time of the shown volume; empty: none shown yet
  bool operator==(const ReplayStatus&) const = default;
};

// Whether the configuration in use is the requested one.
enum class ConfigurationState : std::uint8_t {
  own,
  last_good, // an older one, because the requested one is unusable
  built_in,  // the program's own: scale and calibration may belong to another device
};

// A recording is in progress.
struct RecordingStatus {
  bool on = false;
  hal::Duration lasted{};
  std::uint64_t not_kept = 0;          // volumes and raw frames: the disk was too slow
  std::optional<hal::Duration> room{}; // until the disk is full; empty: not known yet
  bool operator==(const RecordingStatus&) const = default;
};

// B-scans are shown as they come ("rolling").
struct RollingStatus {
  bool possible = true; // else whole volumes are shown: of an iso-surface, and of a recording
  struct Seam {         // ages of what was exposed last on either side of it
    hal::Duration newer{};
    hal::Duration older{};
    bool operator==(const Seam&) const = default;
  };
  std::optional<Seam> seam; // empty: all is of one volume
  bool operator==(const RollingStatus&) const = default;
};

struct Status {
  static constexpr std::size_t most_devices = 8;

  hal::TimePoint now; // of this frame; reference for ages and echoes

  double volumes_per_s = 0;       // that were acquired
  double shown_volumes_per_s = 0; // of those, in a frame that reached the glass
  double lines_per_s = 0;
  double frames_per_s = 0;
  // Camera timestamp of a volume's last line → first frame that shows it. Empty: none measured.
  std::optional<double> latency_p50_ms;
  std::optional<double> latency_p95_ms;
  Losses losses;

  std::array<DeviceStatus, most_devices> devices;
  std::size_t device_count = 0; // used entries of `devices`

  // As somebody said it for this very run, or for the recording that is replayed.
  pipeline::Eye eye = pipeline::Eye::not_said;
  std::string subject; // likewise; empty: not said
  ScanOrientation orientation;
  std::string time_of_day; // "14:05"

  std::optional<ReplayStatus> replay; // empty: the volumes are live
  bool simulated = false;             // any part of the picture is simulated
  std::string source_description;     // "phantom eye, loop of 2.3 s"; short

  ConfigurationState configuration = ConfigurationState::own;
  bool another_camera = false; // not the camera of the calibration

  Freshness freshness;
  int missing_b_scans = 0;                // of the shown volume
  std::optional<RollingStatus> rolling{}; // empty: whole volumes are asked for
  int saturated_lines = 0;

  // Set while the volume is drawn at reduced quality: the share of full quality.
  std::optional<float> reduced_quality;

  VesselStatus vessels;

  RecordingStatus recording;

  // Of pedal and knob, and of the keys; null: nothing to show. They must outlive every draw().
  const Legend* legend = nullptr;
  const Legend* key_legend = nullptr;

  // Of the last volumes; null, or without any: the volumes do not come from a camera. As the legends.
  const Timing* timing = nullptr;

  std::string notice; // one line for the surgeon; empty: none
};

} // namespace octascope::ui

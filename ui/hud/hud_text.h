// The texts of the heads-up display. Pure: equal texts look the same, so the renderer compares them
// to decide whether to redraw.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "pipeline/volume/volume.h"
#include "ui/hud/echo.h"
#include "ui/status/status.h"
#include "ui/view/fixed_text.h"
#include "ui/view/segment_counts.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

enum class BadgeKind : std::uint8_t {
  replay,
  whose,
  simulated,
  waiting,
  stale,
  veiled,
  frozen,
  configuration,
  calibration,
  unregistered,
  incomplete
};

struct Badge {
  BadgeKind kind = BadgeKind::waiting;
  FixedText<48> text;
  bool operator==(const Badge&) const = default;
};

enum class Tone : std::uint8_t { normal, quiet, warning };

struct StatusCell {
  std::string_view label;
  FixedText<48> value;
  Tone tone = Tone::normal;
  bool operator==(const StatusCell&) const = default;
};

struct Caption {
  FixedText<32> title;
  FixedText<64> note; // at the other end of the line
  Tone note_tone = Tone::quiet;
  bool operator==(const Caption&) const = default;
};

// What the colours of vessels mean, and where their segments went.
struct VesselMarks {
  bool shown = false;
  bool registered = false;
  VesselColouring colouring = VesselColouring::branch;
  std::array<bool, pipeline::vessel_branch_count> branches{};
  std::optional<SegmentCounts> account; // where it is asked for
  bool operator==(const VesselMarks&) const = default;
};

// What the renderer shows.
struct ShownPictures {
  bool volume = false;
  pipeline::VolumeGeometry geometry;
  pipeline::BScanState b_scan = pipeline::BScanState::missing; // the one in the panel
  bool scope = false;
  std::optional<hal::TimePoint> scope_time;
};

struct HudText {
  // One per kind, and two for incomplete volumes; a replay is never recorded.
  static constexpr std::size_t most_badges = 8;

  // Lines, frames and volumes a second: dropped in this order if the bar has no room.
  static constexpr std::array<std::size_t, 3> dispensable_cells{1, 2, 0};

  std::array<Badge, most_badges> badges;
  std::size_t badge_count = 0;
  std::array<StatusCell, 8> cells; // one without a label is absent
  Caption volume;                  // where it is not the large picture
  Caption b_scan;
  Caption en_face;
  Caption scope;
  bool scope_stale = false;
  Liveness liveness = Liveness::waiting;
  ParameterEcho echo;
  bool window_changing = false;            // the echo is of the window
  const Legend* legend = nullptr;          // null: hidden; owned by the host, see Status
  Action selected = Action::window_offset; // what the knob turns, for the legend
  std::array<DeviceStatus, Status::most_devices> devices;
  std::size_t device_count = 0;
  FixedText<64> reduced; // the reduced level of detail of the volume and its vessels; empty: full
  VesselMarks vessels;
  FixedText<96> source;
  FixedText<160> notice;
  bool operator==(const HudText&) const = default;
};

HudText compose_hud_text(const ViewState& view, const Status& status, const ShownPictures& shown);

} // namespace octascope::ui

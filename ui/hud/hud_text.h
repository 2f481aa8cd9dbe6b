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

// The legend of the vessel colours, how the vessels were registered, and the segment counts.
struct VesselMarks {
  bool shown = false;
  bool registered = false;
  FixedText<40> registration; // how good it is; empty: there is none
  VesselColouring colouring = VesselColouring::branch;
  std::array<bool, pipeline::vessel_branch_count> branches{}; // that are named
  std::optional<SegmentCounts> account;                       // if requested
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
  // One per kind, and two of kind incomplete; replay and recording exclude each other.
  static constexpr std::size_t most_badges = 8;

  // Lines, frames and volumes per second: dropped in this order if the bar is too narrow.
  static constexpr std::array<std::size_t, 3> dispensable_cells{1, 2, 0};

  std::array<Badge, most_badges> badges;
  std::size_t badge_count = 0;
  std::array<StatusCell, 8> cells; // unused if the label is empty
  Caption volume;                  // if it is not the large picture
  Caption b_scan;
  Caption crossed;
  Caption en_face;
  Caption scope;
  bool scope_stale = false;
  Liveness liveness = Liveness::waiting;
  ParameterEcho echo;
  bool window_changing = false;            // the echo is about the window
  const Legend* legend = nullptr;          // null: hidden; owned by the host, see Status
  Action selected = Action::window_offset; // what the knob controls, for the legend
  std::array<DeviceStatus, Status::most_devices> devices;
  std::size_t device_count = 0;
  FixedText<64> reduced; // reduced quality of the volume or its vessels; empty: full quality
  VesselMarks vessels;
  FixedText<96> source;
  FixedText<160> notice;
  bool operator==(const HudText&) const = default;
};

HudText compose_hud_text(const ViewState& view, const Status& status, const ShownPictures& shown);

} // namespace octascope::ui

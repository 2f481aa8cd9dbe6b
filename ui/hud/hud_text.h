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
  simulated,
  waiting,
  stale,
  veiled,
  frozen,
  configuration,
  calibration,
  unregistered,
  incomplete,
  cut,    // quiet: what is missing is missing on request
  rolling // quiet: as it was asked for
};

struct Badge {
  BadgeKind kind = BadgeKind::waiting;
  FixedText<48> text;
  bool operator==(const Badge&) const = default;
};

enum class Tone : std::uint8_t { normal, quiet, warning };

// A figure of the machine, in the engineer's strip.
struct StatusCell {
  std::string_view label;
  FixedText<48> value;
  Tone tone = Tone::normal;
  bool operator==(const StatusCell&) const = default;
};

// Something that is wrong, or not ready yet, at the right end of the status bar.
struct Trouble {
  enum class Sign : std::uint8_t { absent, failed, lost, loading };
  Sign sign = Sign::absent;
  FixedText<40> words;
  bool operator==(const Trouble&) const = default;
};

struct Caption {
  FixedText<32> title;
  FixedText<64> note;    // at the other end of the line
  FixedText<16> deepest; // a bar of the hues of depths, and what the last one means; empty: none
  Tone note_tone = Tone::quiet;
  bool operator==(const Caption&) const = default;
};

// The legend of the vessel colours, how the vessels were registered, and the segment counts.
struct VesselMarks {
  bool flow = false;  // is shown
  bool shown = false; // the tree is
  bool registered = false;
  FixedText<40> registration; // how good it is; empty: there is none
  VesselColouring colouring = VesselColouring::branch;
  std::array<bool, pipeline::vessel_branch_count> branches{}; // that are named
  std::optional<SegmentCounts> account;                       // if requested
  FixedText<96> tree;    // traced in the live flow: its age; or why there is none
  bool tree_old = false; // is to be marked
  bool operator==(const VesselMarks&) const = default;
};

// What flows, as far as it is shown.
struct FlowShown {
  bool shown = false;
  bool refused = false; // it should be, and this GL cannot draw it
  bool late = false;    // not on the surface, whose mesh comes too late for it
  pipeline::FlowState b_scan = pipeline::FlowState::none; // of the one in the panel
  int told = 0;                                           // B-scans, of the volume
  int left_out = 0;                                       // likewise, as they moved
  double deepest_mm = 0; // below the surface: the last hue; 0: nothing flows
  bool in_scope = false; // in the microscope's picture, too
  int none = 0;          // B-scans that came, and of which nothing was asked or a sweep was missing
};

// What the renderer shows.
struct ShownPictures {
  bool volume = false;
  pipeline::VolumeGeometry geometry;
  pipeline::BScanState b_scan = pipeline::BScanState::missing; // the one in the panel
  bool scope = false;
  std::optional<hal::TimePoint> scope_time;
  bool vessels_left_out = false; // the thinnest, of a flat picture
  FlowShown flow;
};

struct HudText {
  // One per kind, and two of kind incomplete.
  static constexpr std::size_t most_badges = 10;
  static constexpr std::size_t most_troubles = Status::most_devices + 8;

  // Lines, frames and volumes per second: dropped in this order if the strip is too narrow.
  static constexpr std::array<std::size_t, 3> dispensable_figures{1, 2, 0};

  std::array<Badge, most_badges> badges;
  std::size_t badge_count = 0;
  FixedText<16> eye;
  FixedText<8> time_of_day;
  FixedText<16> recording; // empty: none is on
  std::array<Trouble, most_troubles> troubles;
  std::size_t trouble_count = 0;
  // Said quietly at the bar's top, as far as there is room: whose it is, the room on the disk, how
  // finely it is drawn, what the volumes are. A notice takes the place of the last two.
  std::array<FixedText<96>, 4> facts;
  FixedText<160> notice;
  std::array<StatusCell, 7> figures; // unused if the label is empty
  bool figures_shown = false;
  const Timing* timing = nullptr; // null: no diagram; owned by the host, see Status
  std::uint64_t timed_volume = 0; // its newest: another one, another diagram
  Caption volume;                 // if it is not the large picture
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
  VesselMarks vessels;
  AxisEnds ends;
  AxisLabels labels;
  std::int64_t page = 0; // of the legend and of a notice that needs two: the next one every few s
  bool operator==(const HudText&) const = default;
};

HudText compose_hud_text(const ViewState& view, const Status& status, const ShownPictures& shown);

} // namespace octascope::ui

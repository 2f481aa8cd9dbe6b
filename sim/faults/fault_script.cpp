#include "sim/faults/fault_script.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/files/config_document.h"

namespace octascope::sim {

using pipeline::ConfigDocument;
using pipeline::ConfigTable;

namespace {

constexpr double longest_s = 1e6;
constexpr double shortest_s = 1e-4;

constexpr std::array line_camera_kinds{FaultKind::unplug,           FaultKind::dropped_frames,
                                       FaultKind::corrupted_frames, FaultKind::wrong_size,
                                       FaultKind::late_frames,      FaultKind::stuck_sequence,
                                       FaultKind::saturation};
constexpr std::array galvo_trigger_kinds{FaultKind::unplug, FaultKind::missed_pulses};
constexpr std::array control_input_kinds{FaultKind::unplug, FaultKind::bounce,
                                         FaultKind::stuck_switch};
constexpr std::array scope_camera_kinds{FaultKind::unplug};
constexpr std::array display_kinds{FaultKind::lost};

constexpr bool can_be_counted(FaultKind kind) {
  return kind != FaultKind::unplug && kind != FaultKind::bounce &&
         kind != FaultKind::stuck_switch && kind != FaultKind::lost;
}

hal::Duration duration_of(ConfigTable& table, std::string_view key) {
  return table.has(key) ? hal::from_seconds(table.number(key, 0, {shortest_s, longest_s}))
                        : hal::Duration{};
}

hal::Duration milliseconds_of(ConfigTable& table, std::string_view key, double fallback,
                              double highest) {
  return hal::from_seconds(table.number(key, fallback, {0, highest}) * 1e-3);
}

void require(ConfigTable& table, std::string_view key) {
  if (!table.has(key))
    table.complain(fmt::format("{} is missing, expected in every fault", key));
}

void read_device_and_kind(ConfigTable& table, ScriptedFault& fault) {
  require(table, "device");
  require(table, "kind");
  require(table, "at_s");
  fault.device = static_cast<FaultDevice>(table.choice(
      "device", 0, {"line_camera", "galvo_trigger", "control_input", "scope_camera", "display"}));
  fault.kind = static_cast<FaultKind>(table.choice(
      "kind", 0,
      {"unplug", "dropped_frames", "corrupted_frames", "wrong_size", "late_frames",
       "stuck_sequence", "saturation", "missed_pulses", "bounce", "stuck_switch", "lost"}));
  const auto kinds = kinds_of(fault.device);
  if (std::find(kinds.begin(), kinds.end(), fault.kind) == kinds.end()) {
    std::vector<std::string_view> names;
    for (const FaultKind kind : kinds)
      names.push_back(to_string(kind));
    table.complain(fmt::format("kind is '{}', expected for the {} one of \"{}\"",
                               to_string(fault.kind), to_string(fault.device),
                               fmt::join(names, "\", \"")));
  }
}

void read_times(ConfigTable& table, ScriptedFault& fault) {
  fault.at = hal::from_seconds(table.number("at_s", 0, {0, longest_s}));
  fault.duration = duration_of(table, "duration_s");
  fault.repeat = duration_of(table, "repeat_s");
  if (can_be_counted(fault.kind)) {
    fault.count =
        static_cast<std::uint64_t>(table.has("count") ? table.integer("count", 1, {1, 1e9}) : 0);
    if (!table.has("duration_s") && !table.has("count"))
      table.complain("has no end, expected duration_s, count, or both");
    fault.every = table.integer("every", 1, {1, 1e6});
    fault.probability = table.number("probability", 1, {0, 1});
    fault.seed = static_cast<std::uint64_t>(table.integer("seed", 1, {0, 2e9}));
  } else if (!table.has("duration_s")) {
    table.complain("duration_s is missing, expected for this kind of fault");
  }
  if (fault.repeat > hal::Duration{} && fault.repeat <= fault.duration)
    table.complain(fmt::format("repeat_s is {}, expected more than duration_s, {}",
                               hal::to_seconds(fault.repeat), hal::to_seconds(fault.duration)));
}

void read_parameters(ConfigTable& table, ScriptedFault& fault) {
  switch (fault.kind) {
  case FaultKind::unplug:
    if (fault.device == FaultDevice::line_camera)
      fault.comes_back_as = table.text("comes_back_as", "");
    break;
  case FaultKind::late_frames: fault.late_by = milliseconds_of(table, "late_ms", 20, 60e3); break;
  case FaultKind::wrong_size:
    fault.size_share = table.number("size_share", 0.5, {0, 2});
    if (fault.size_share == 1)
      table.complain("size_share is 1, which is the right size; expected less or more");
    break;
  case FaultKind::saturation: fault.line_share = table.number("line_share", 0.25, {0, 1}); break;
  case FaultKind::bounce:
    fault.switch_index = table.has("switch") ? table.integer("switch", 0, {0, 2}) : -1;
    fault.bounces = table.integer("bounces", 6, {1, 100});
    fault.bounce_spread = milliseconds_of(table, "bounce_ms", 4, 100);
    break;
  case FaultKind::stuck_switch:
    fault.switch_index = table.integer("switch", 0, {0, 2});
    fault.stuck_pressed = table.boolean("pressed", true);
    break;
  default: break;
  }
}

hal::Result<FaultScript> read_script(const ConfigDocument& document) {
  FaultScript script;
  ConfigTable root = document.root();
  for (ConfigTable& table : root.tables("fault")) {
    ScriptedFault fault;
    read_device_and_kind(table, fault);
    read_times(table, fault);
    read_parameters(table, fault);
    script.faults.push_back(fault);
  }
  HAL_CHECK(document.finish());
  return script;
}

} // namespace

std::string_view to_string(FaultDevice device) {
  switch (device) {
  case FaultDevice::line_camera: return "line_camera";
  case FaultDevice::galvo_trigger: return "galvo_trigger";
  case FaultDevice::control_input: return "control_input";
  case FaultDevice::scope_camera: return "scope_camera";
  case FaultDevice::display: return "display";
  }
  return "unknown device";
}

std::string_view to_string(FaultKind kind) {
  switch (kind) {
  case FaultKind::unplug: return "unplug";
  case FaultKind::dropped_frames: return "dropped_frames";
  case FaultKind::corrupted_frames: return "corrupted_frames";
  case FaultKind::wrong_size: return "wrong_size";
  case FaultKind::late_frames: return "late_frames";
  case FaultKind::stuck_sequence: return "stuck_sequence";
  case FaultKind::saturation: return "saturation";
  case FaultKind::missed_pulses: return "missed_pulses";
  case FaultKind::bounce: return "bounce";
  case FaultKind::stuck_switch: return "stuck_switch";
  case FaultKind::lost: return "lost";
  }
  return "unknown fault";
}

std::span<const FaultKind> kinds_of(FaultDevice device) {
  switch (device) {
  case FaultDevice::line_camera: return line_camera_kinds;
  case FaultDevice::galvo_trigger: return galvo_trigger_kinds;
  case FaultDevice::control_input: return control_input_kinds;
  case FaultDevice::scope_camera: return scope_camera_kinds;
  case FaultDevice::display: return display_kinds;
  }
  return {};
}

std::string describe(const ScriptedFault& fault) {
  std::string words = fmt::format("{} {} at {} s", to_string(fault.device), to_string(fault.kind),
                                  hal::to_seconds(fault.at));
  if (fault.duration > hal::Duration{})
    words += fmt::format(" for {} s", hal::to_seconds(fault.duration));
  if (fault.count > 0)
    words += fmt::format(" {} times", fault.count);
  if (fault.repeat > hal::Duration{})
    words += fmt::format(" every {} s", hal::to_seconds(fault.repeat));
  return words;
}

hal::Result<FaultScript> FaultScript::load(const std::filesystem::path& file) {
  return ConfigDocument::load(file).and_then(read_script);
}

hal::Result<FaultScript> FaultScript::parse(std::string_view text,
                                            const std::filesystem::path& name) {
  return ConfigDocument::parse(text, name).and_then(read_script);
}

} // namespace octascope::sim

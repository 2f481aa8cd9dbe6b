#include "sim/faults/fault_script.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/files/config_document.h"

namespace octascope::sim {

using pipeline::ConfigDocument;
using pipeline::ConfigTable;
using pipeline::Device;
using pipeline::Fault;

namespace {

constexpr double longest_s = 1e6;
constexpr double shortest_s = 1e-4;

constexpr std::array scriptable{
    // The line camera may come back as another one of its kind: comes_back_as.
    ScriptableFault{gone(Device::line_camera), "unplug", false},
    // Made by the hardware, never delivered: a gap in the sequence.
    ScriptableFault{Fault::dropped_frames, "dropped_frames", true},
    // Flagged by the driver, its bytes scrambled.
    ScriptableFault{Fault::corrupted_frame, "corrupted_frames", true},
    // size_share of the bytes are delivered.
    ScriptableFault{Fault::wrong_size, "wrong_size", true},
    // Handed out late_ms late; its times stay true.
    ScriptableFault{Fault::late_frame, "late_frames", true},
    // Carries the sequence number of the frame before.
    ScriptableFault{Fault::stuck_sequence, "stuck_sequence", true},
    // line_share of the lines at full scale.
    ScriptableFault{Fault::saturation, "saturation", true},

    ScriptableFault{gone(Device::galvo_trigger), "unplug", false},
    // Made by the driver, never seen by the scanner.
    ScriptableFault{Fault::missed_pulse, "missed_pulses", true},

    ScriptableFault{gone(Device::control_input), "unplug", false},
    // Each change of a contact bounces `bounces` times within bounce_ms.
    ScriptableFault{Fault::bounce, "bounce", false},
    // The contact of `switch` stays closed (or open, with pressed = false).
    ScriptableFault{Fault::stuck_switch, "stuck_switch", false},

    ScriptableFault{gone(Device::scope_camera), "unplug", false},

    ScriptableFault{gone(Device::display), "lost", false},
};

const ScriptableFault& row_of(Fault fault) {
  return *std::ranges::find(scriptable, fault, &ScriptableFault::fault);
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
    table.complain("{} is missing, expected in every fault", key);
}

void read_device_and_kind(ConfigTable& table, ScriptedFault& fault) {
  require(table, "device");
  require(table, "kind");
  require(table, "at_s");
  const auto device = static_cast<Device>(
      table.choice("device", 0,
                   {facts_of(Device::line_camera).key, facts_of(Device::galvo_trigger).key,
                    facts_of(Device::control_input).key, facts_of(Device::scope_camera).key,
                    facts_of(Device::display).key}));
  const std::string kind = table.text("kind", "");
  std::vector<std::string_view> kinds;
  for (const ScriptableFault& known : scriptable) {
    if (facts_of(known.fault).device != device)
      continue;
    if (known.kind == kind) {
      fault.kind = known.fault;
      return;
    }
    kinds.push_back(known.kind);
  }
  table.complain("kind is '{}', expected for the {} one of \"{}\"", kind, facts_of(device).key,
                 fmt::join(kinds, "\", \""));
}

void read_times(ConfigTable& table, ScriptedFault& fault) {
  fault.at = hal::from_seconds(table.number("at_s", 0, {0, longest_s}));
  fault.duration = duration_of(table, "duration_s");
  fault.repeat = duration_of(table, "repeat_s");
  if (row_of(fault.kind).counted) {
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
    table.complain("repeat_s is {}, expected more than duration_s, {}",
                   hal::to_seconds(fault.repeat), hal::to_seconds(fault.duration));
}

void read_parameters(ConfigTable& table, ScriptedFault& fault) {
  if (fault.kind == gone(Device::line_camera))
    fault.comes_back_as = table.text("comes_back_as", "");
  switch (fault.kind) {
  case Fault::late_frame: fault.late_by = milliseconds_of(table, "late_ms", 20, 60e3); break;
  case Fault::wrong_size:
    fault.size_share = table.number("size_share", 0.5, {0, 2});
    if (fault.size_share == 1)
      table.complain("size_share is 1, which is the right size; expected less or more");
    break;
  case Fault::saturation: fault.line_share = table.number("line_share", 0.25, {0, 1}); break;
  case Fault::bounce:
    fault.switch_index = table.has("switch") ? table.integer("switch", 0, {0, 2}) : -1;
    fault.bounces = table.integer("bounces", 6, {1, 100});
    fault.bounce_spread = milliseconds_of(table, "bounce_ms", 4, 100);
    break;
  case Fault::stuck_switch:
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

std::span<const ScriptableFault> scriptable_faults() {
  return scriptable;
}

std::string describe(const ScriptedFault& fault) {
  std::string words = fmt::format("{} {} at {} s", facts_of(fault.kind).device_key(),
                                  row_of(fault.kind).kind, hal::to_seconds(fault.at));
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

#include "sim/devices/control_script.h"

#include <algorithm>

#include "pipeline/files/config_document.h"

namespace octascope::sim {

using hal::ControlKind;
using pipeline::ConfigDocument;
using pipeline::ConfigTable;

namespace {

constexpr double longest_s = 1e6;
constexpr int most_detents = 1000; // in one event; a hand does not turn more between two reports
constexpr int axis_limit = 1000;

ScriptedControl read_event(ConfigTable& table) {
  ScriptedControl event;
  const int named = table.has("switch") + table.has("knob") + table.has("axis");
  if (named != 1)
    table.complain("names {} controls, expected exactly one of switch, knob, axis", named);
  if (!table.has("time_s") || !table.has("value"))
    table.complain("time_s or value is missing, expected both in every event");
  event.at = hal::from_seconds(table.number("time_s", 0, {0, longest_s}));
  const int a_switch = table.integer("switch", 0, {0, switch_count - 1});
  const int knob = table.integer("knob", 0, {0, knob_count - 1});
  const int axis = table.integer("axis", 0, {0, axis_count - 1});
  if (table.has("axis")) {
    event.kind = ControlKind::axis;
    event.index = static_cast<std::uint8_t>(axis);
    event.value = table.integer("value", 0, {-axis_limit, axis_limit});
  } else if (table.has("knob")) {
    event.kind = ControlKind::knob;
    event.index = static_cast<std::uint8_t>(knob);
    event.value = table.integer("value", 0, {-most_detents, most_detents});
  } else {
    event.index = static_cast<std::uint8_t>(a_switch);
    event.value = table.integer("value", 0, {0, 1});
  }
  return event;
}

hal::Result<ControlScript> read_script(const ConfigDocument& document) {
  ControlScript script;
  ConfigTable root = document.root();
  for (ConfigTable& table : root.tables("event"))
    script.events.push_back(read_event(table));
  std::ranges::stable_sort(script.events, [](const ScriptedControl& a, const ScriptedControl& b) {
    return a.at < b.at;
  });
  if (root.has("repeat_s")) {
    script.repeat = hal::from_seconds(root.number("repeat_s", 1, {1e-3, longest_s}));
    if (!script.events.empty() && script.events.back().at >= script.repeat)
      root.complain("repeat_s is {}, expected more than the last event's time_s, {}",
                    hal::to_seconds(script.repeat), hal::to_seconds(script.events.back().at));
  }
  HAL_CHECK(document.finish());
  return script;
}

} // namespace

bool is_plausible(const hal::ControlEvent& event) {
  switch (event.kind) {
  case ControlKind::pedal_switch:
    return event.index < switch_count && (event.value == 0 || event.value == 1);
  case ControlKind::knob: return event.index < knob_count;
  case ControlKind::axis:
    return event.index < axis_count && event.value >= -axis_limit && event.value <= axis_limit;
  }
  return false;
}

hal::Result<ControlScript> ControlScript::load(const std::filesystem::path& file) {
  return ConfigDocument::load(file).and_then(read_script);
}

hal::Result<ControlScript> ControlScript::parse(std::string_view text,
                                                const std::filesystem::path& name) {
  return ConfigDocument::parse(text, name).and_then(read_script);
}

std::optional<hal::Duration> ControlScriptCursor::next_time() const {
  if (next_ == script_.events.size())
    return std::nullopt;
  return round_began_ + script_.events[next_].at;
}

const ScriptedControl& ControlScriptCursor::take() {
  const ScriptedControl& event = script_.events[next_++];
  if (next_ == script_.events.size() && script_.repeat > hal::Duration{}) {
    next_ = 0;
    round_began_ += script_.repeat;
  }
  return event;
}

} // namespace octascope::sim

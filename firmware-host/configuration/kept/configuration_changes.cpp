#include "firmware-host/configuration/kept/configuration_changes.h"

#include <algorithm>
#include <tuple>

namespace octascope::firmware_host {

namespace {

constexpr int compared_places = 256;

bool same_window(const std::optional<ui::DisplayWindow>& a,
                 const std::optional<ui::DisplayWindow>& b) {
  const auto numbers = [](const auto& window) {
    return window ? std::tuple{true, window->offset_db, window->size_db}
                  : std::tuple{false, 0.0F, 0.0F};
  };
  return numbers(a) == numbers(b);
}

// Its name is on the screen, its size is the scale's. Of those that are not on the microscope
// nothing is used.
bool same_lens(const std::optional<Objective>& a, const std::optional<Objective>& b) {
  if (a.has_value() != b.has_value())
    return false;
  return !a || (a->name == b->name && a->a_mm == b->a_mm && a->b_mm == b->b_mm);
}

auto scheduling_of(const Configuration& c) {
  return std::tie(c.workers, c.worker_cores, c.neighbour_weights.before, c.neighbour_weights.here,
                  c.neighbour_weights.after, c.flow);
}

// What of the controls is opened once; their profile is changed as they are used.
auto control_devices_of(const Configuration& c) {
  return std::tie(c.devices.control_device, c.devices.keyboards);
}

bool same_devices(const DeviceConfig& a, DeviceConfig b) {
  b.control_device = a.control_device;
  b.keyboards = a.keyboards;
  return a == b;
}

auto screen_of(const Configuration& c) {
  return std::tie(c.width, c.height, c.fullscreen);
}

auto twins_of(const Configuration& c) {
  return std::tie(c.phantom, c.loop_volumes, c.galvo_lag_us, c.tissue_motion, c.faults, c.controls);
}

bool same_curves(const ui::TransferFunction& a, const ui::TransferFunction& b, float u) {
  return a.curve.opacity(u) == b.curve.opacity(u) &&
         (!a.colours || a.colours->at(u) == b.colours->at(u));
}

} // namespace

std::vector<std::string> changes_for_a_restart(const Configuration& used,
                                               const Configuration& next) {
  std::vector<std::string> sections;
  const auto compare = [&](bool same, const char* section) {
    if (!same)
      sections.emplace_back(section);
  };
  compare(used.plan == next.plan && used.depth_spacing_said == next.depth_spacing_said, "[scan]");
  compare(same_lens(used.objective, next.objective), "[microscope]");
  compare(used.calibration == next.calibration, "[calibration]");
  compare(scheduling_of(used) == scheduling_of(next), "[pipeline]");
  compare(same_devices(used.devices, next.devices), "[devices]");
  compare(screen_of(used) == screen_of(next), "[display] size");
  compare(control_devices_of(used) == control_devices_of(next), "[controls] devices");
  compare(used.metrics == next.metrics, "[observation]");
  compare(used.recording_folder == next.recording_folder, "[recordings]");
  compare(twins_of(used) == twins_of(next), "[sim]");
  return sections;
}

bool same_transfers(const ui::TransferSet& a, const ui::TransferSet& b) {
  return std::ranges::equal(a.functions(), b.functions(), [](const auto& one, const auto& other) {
    if (one.name != other.name || one.colours.has_value() != other.colours.has_value())
      return false;
    for (int i = 0; i <= compared_places; ++i)
      if (!same_curves(one, other, static_cast<float>(i) / compared_places))
        return false;
    return true;
  });
}

ui::ViewState with_changes(const ui::ViewState& view, const Configuration& used,
                           const Configuration& next) {
  const LookConfiguration& old_look = used.look;
  const LookConfiguration& look = next.look;
  ui::ViewState changed = view;
  const auto name = [](const LookConfiguration& of, int transfer) {
    return of.transfers.functions()[static_cast<std::size_t>(transfer)].name;
  };
  const bool transfer_changed = name(old_look, old_look.transfer) != name(look, look.transfer);
  changed.transfer =
      transfer_changed
          ? look.transfer
          : look.transfers.function_named(name(old_look, view.transfer)).value_or(look.transfer);
  if (old_look.colour_map != look.colour_map)
    changed.colour_map = look.colour_map;
  if (old_look.technique != look.technique)
    changed.technique = look.technique;
  if (old_look.opacity != look.opacity)
    changed.opacity = look.opacity;
  if (old_look.rolling != look.rolling)
    changed.rolling = look.rolling;
  if (!same_window(used.window, next.window) && next.window) {
    changed.window_offset_db = next.window->offset_db;
    changed.window_size_db = next.window->size_db;
  }
  return changed;
}

} // namespace octascope::firmware_host

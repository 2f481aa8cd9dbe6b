// Objective-lens presets: what changes with the lens on the microscope.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/files/config_document.h"
#include "pipeline/scan/scan_plan.h"
#include "ui/transfer/auto_window.h"

namespace octascope::firmware_host {

// One [[objective]]. Empty fields leave the rest of the configuration unchanged.
struct Objective {
  std::string name;
  std::optional<double> a_mm; // length of the scan along a B-scan …
  std::optional<double> b_mm; // … and from the first B-scan to the last
  std::optional<std::filesystem::path> calibration;
  std::optional<ui::DisplayWindow> window;

  // Sets the spacings that give this scan size; the counts stay.
  void scale(pipeline::ScanPlan& plan) const;
};

// The range of window offsets that any part of the configuration may set.
inline constexpr pipeline::NumberRange window_offset_range_db{-40, 88};
inline constexpr pipeline::NumberRange window_size_range_db{1, 128};

// window_offset_db and window_size_db: both or neither.
std::optional<ui::DisplayWindow> read_window(pipeline::ConfigTable& table);

// Reports errors to the document.
std::vector<Objective> read_objectives(pipeline::ConfigTable root);

// The one that [microscope] objective names; empty if there are no presets. With presets it must be
// named: the wrong one would give the wrong scale.
std::optional<Objective> chosen_objective(pipeline::ConfigTable microscope,
                                          const std::vector<Objective>& objectives);

} // namespace octascope::firmware_host

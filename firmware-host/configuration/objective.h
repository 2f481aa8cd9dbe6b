// Objective-lens presets: what changes with the lens that is on the microscope.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/files/config_document.h"
#include "pipeline/scan/scan_plan.h"
#include "ui/transfer/auto_window.h"

namespace octascope::firmware_host {

// One [[objective]]. What is empty stays as the rest of the configuration has it.
struct Objective {
  std::string name;
  std::optional<double> a_mm; // length of the scan along a B-scan …
  std::optional<double> b_mm; // … and from the first B-scan to the last
  std::optional<std::filesystem::path> calibration;
  std::optional<ui::DisplayWindow> window;

  // The spacings that make the scan so large; the counts stay.
  void scale(pipeline::ScanPlan& plan) const;
};

// The range of the display window that any part of the configuration may give.
inline constexpr pipeline::NumberRange window_offset_range_db{-40, 88};
inline constexpr pipeline::NumberRange window_size_range_db{1, 128};

// window_offset_db and window_size_db: both or neither.
std::optional<ui::DisplayWindow> read_window(pipeline::ConfigTable& table);

// Complains to the document about what is wrong.
std::vector<Objective> read_objectives(pipeline::ConfigTable root);

// The one that [microscope] objective names; nothing where there is no preset. With presets it has
// to be said which: the wrong one would give the wrong scale.
std::optional<Objective> chosen_objective(pipeline::ConfigTable microscope,
                                          const std::vector<Objective>& objectives);

} // namespace octascope::firmware_host

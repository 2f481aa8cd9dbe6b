// What the tests of the whole program share: scenes that cost little, reports, pictures.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "pipeline/files/png_image.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/pictures/picture_counts.h"
#include "tests/support/program/program_run.h"
#include "ui/canvas/palette.h"
#include "ui/layout/layout.h"

namespace octascope::tests {

// A configuration that any machine keeps up with, sanitized and busy: 20 B-scans of 24 short lines
// in 200 ms.
inline constexpr int small_b_scans = 20;
inline constexpr int small_a_scans = 24;
std::filesystem::path write_small_configuration(const ScratchFolder& folder);

// The pictures of small_run().
inline constexpr int small_width = 640;
inline constexpr int small_height = 360;

// As run_octascope(); a failed test where it does not end well.
ProgramResult run_well(std::vector<std::string> arguments,
                       WallClock::duration most = std::chrono::seconds{120});

// As run_octascope(); returns what it said. Failed tests where it was not refused with this exit
// status, in one line on stderr alone, or where anything was written into the folder.
std::string run_refused(const ScratchFolder& folder, std::vector<std::string> arguments,
                        int exit_status = 1);

// `run` on twins with that configuration, offscreen, and these options more.
std::vector<std::string> small_run(const ScratchFolder& folder, std::vector<std::string> more);

// The report that a run left; an empty object, and a failed test, where there is none.
nlohmann::json read_report(const std::filesystem::path& file);

// `said` has all that is in `expected`, objects likewise; numbers to 1e-9.
void expect_all(const nlohmann::json& said, const nlohmann::json& expected);

// The entry of `faults` with this device and kind; null if there is none.
nlohmann::json find_fault(const nlohmann::json& report, std::string_view device,
                          std::string_view kind);

// Nothing was lost, unless a machine that was busy with something else was late.
void expect_nothing_lost(const nlohmann::json& report);

// The snapshot that a run left; empty, and a failed test, where there is none.
pipeline::Image read_snapshot(const std::filesystem::path& file);

ui::Layout layout_of(const pipeline::Image& picture);
ui::Rect badge_row(const pipeline::Image& picture);  // top of the view
ui::Rect notice_row(const pipeline::Image& picture); // left end of the notice line

// Names of all that lies in a folder, in order.
std::vector<std::string> listing(const std::filesystem::path& folder);

} // namespace octascope::tests

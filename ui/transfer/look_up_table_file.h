// Look-up tables for transfer functions, from files.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "hal/result.h"
#include "ui/transfer/transfer_table.h"

namespace octascope::ui {

// 2 to 4096 entries, evenly spread over the display window from its offset to its upper end.
struct LookUpTable {
  std::vector<float> opacities;                                   // 0…1
  std::optional<std::vector<TransferTable::Colour>> colours = {}; // of the same number
};

// Reads, by the name's ending:
// - a PNG strip (.png), along its longer side, from the left or from the top; its rows across are
//   all the same. Grey means opacity; RGB means colour, with the window's own ramp as opacity; RGB
//   with transparency means both.
// - text (any other name): a line an entry, `opacity` or `red, green, blue, opacity`, all from 0 to
//   1; pipeline/files/text_curve.h has the rest.
// An Error names file and line, what was found, what was expected and what to do.
hal::Result<LookUpTable> read_look_up_table(const std::filesystem::path& file);

} // namespace octascope::ui

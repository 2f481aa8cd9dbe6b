// Reads look-up tables for transfer functions from files.
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
  std::optional<std::vector<TransferTable::Colour>> colours = {}; // as many as opacities
};

// The extension selects the format:
// - .png: a strip along its longer side, from the left or from the top, constant across. Grey is
//   opacity; RGB is colour, with the window's own ramp as opacity; with transparency it is both. An
//   entry is a pixel's value / 255, or with 16 bits / 65535, whatever the file says about colour.
// - any other: text, one entry per line, `opacity` or `red, green, blue, opacity`, all from 0 to 1;
//   for the syntax see pipeline/files/text_curve.h.
// The error names file and line, what was found, what was expected and what to do.
hal::Result<LookUpTable> read_look_up_table(const std::filesystem::path& file);

} // namespace octascope::ui

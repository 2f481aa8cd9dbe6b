// What pedal and knob have set, as it outlives a run: technique, window, layout and the like; not
// where the eye is, nor whether the picture is frozen.
//
//   [settings]                    # only what differs from the configuration
//   technique = "shaded"
//   [configured]                  # what the configuration said then
//   technique = "rays"
//
// A setting counts for as long as the configuration still says what it said then: whoever edits the
// configuration wants to see what it says.
#pragma once

#include <filesystem>
#include <string>

#include "hal/result.h"
#include "ui/transfer/transfer_set.h"
#include "ui/view/view_state.h"

namespace octascope::firmware_host {

// What a run begins with, by the configuration.
struct ConfiguredView {
  ui::ViewState view;
  bool automatic_window = false; // what suits the first volume, so that `view` cannot say it
  ui::TransferSet transfers;     // what view.transfer and view.colour_map choose from
};

struct RestoredView {
  ui::ViewState view;
  bool window = false; // was restored, too
};

// The file's text for what `state` has otherwise than `configured`.
std::string settings_text(const ConfiguredView& configured, const ui::ViewState& state);

// Strict as every file of ours. What it names that is no longer there (a transfer function) is left
// as configured.
hal::Result<RestoredView> read_settings(const std::filesystem::path& file,
                                        const ConfiguredView& configured);

} // namespace octascope::firmware_host

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
  bool automatic_window = false; // chosen for the first volume; `view` cannot express that
  ui::TransferSet transfers;     // indexed by view.transfer and view.colour_map
};

struct RestoredView {
  ui::ViewState view;
  bool window = false; // whether the window was restored, too
};

// The file's text for the values of `state` that differ from `configured`.
std::string settings_text(const ConfiguredView& configured, const ui::ViewState& state);

// Strict, like every file of ours. A named choice that no longer exists (a transfer function) stays
// as configured.
hal::Result<RestoredView> read_settings(const std::filesystem::path& file,
                                        const ConfiguredView& configured);

} // namespace octascope::firmware_host

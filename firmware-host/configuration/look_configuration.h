// What the configuration says about how a volume looks: [[transfer]] and parts of [display].
#pragma once

#include "pipeline/files/config_document.h"
#include "ui/transfer/transfer_set.h"
#include "ui/view/technique.h"
#include "ui/view/view_state.h"

namespace octascope::firmware_host {

// How the display begins; the defaults are ViewState's.
struct LookConfiguration {
  ui::TransferSet transfers; // the built-in ones and those of [[transfer]]
  int transfer = 0;          // indices into `transfers`
  int colour_map = 0;
  ui::Technique technique = ui::ViewState{}.technique;
  float opacity = ui::ViewState{}.opacity;
  bool rolling = false; // each B-scan is shown as it comes
};

// Reports errors to the document. Reads the files of look-up tables.
LookConfiguration read_look(pipeline::ConfigTable root, pipeline::ConfigTable display);

} // namespace octascope::firmware_host

// octascope render: one picture of one volume, without a display.
#pragma once

#include <optional>

#include <CLI/App.hpp>

#include "hal/result.h"
#include "pipeline/files/png_image.h"
#include "pipeline/volume/volume.h"
#include "ui/transfer/auto_window.h"
#include "ui/transfer/transfer_set.h"
#include "ui/view/draw_quality.h"
#include "ui/view/vessel_placement.h"
#include "ui/view/view_state.h"

namespace octascope::firmware_host {

struct RenderOptions {
  // The window is ignored; everything else is as on the display.
  ui::ViewState view;
  std::optional<ui::DisplayWindow> window; // empty: chosen for the volume
  ui::TransferSet transfers;               // indexed by the view
  int width = 1280;
  int height = 720;
  ui::DrawQuality quality = ui::full_quality;
  std::optional<ui::PlacedVessels> vessels; // borrowed
};

// The volume alone on the display's background, with its scale, RGB. Opens its own offscreen GL
// context and closes it again; none may be current on this thread. ErrorCode::invalid_argument: the
// request cannot be drawn. ErrorCode::unsupported: this machine has no offscreen GL.
hal::Result<pipeline::Image> render_volume(const pipeline::Volume& volume,
                                           const RenderOptions& options);

// As add_run_command().
void add_render_command(CLI::App& program, int& exit_status);

} // namespace octascope::firmware_host

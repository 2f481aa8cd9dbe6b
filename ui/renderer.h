// Draws the whole display into the bound framebuffer: volume, panels and heads-up display.
#pragma once

#include <memory>
#include <optional>

#include "hal/clock.h"
#include "hal/result.h"
#include "hal/scope_camera.h"
#include "pipeline/files/png_image.h"
#include "pipeline/threads/worker_pool.h"
#include "pipeline/volume/volume.h"
#include "ui/hud/fonts.h"
#include "ui/hud/window_histogram.h"
#include "ui/layout/scan_field.h"
#include "ui/status/status.h"
#include "ui/transfer/transfer_set.h"
#include "ui/view/draw_quality.h"
#include "ui/view/segment_counts.h"
#include "ui/view/vessel_placement.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Threads: bound to the thread and the GLES 3 context that were current in create(); destroyed
// there too. If the context is lost (Display::present() says disconnected), destroy it, open the
// display again and create a new one.
//
// A volume's picture is kept and redrawn only when the volume, the view or the window changes, so a
// frame that changes only the heads-up display costs little. After the first frame of a size, only
// the GL driver allocates.
class Renderer {
public:
  // `threads` sets up the threads that help drawing, named in VolumePainter::create(). The typeface
  // stays borrowed. ErrorCode::unsupported: this GL cannot compile our shaders.
  static hal::Result<std::unique_ptr<Renderer>> create(const TransferSet& transfers = {},
                                                       const pipeline::ThreadSetup& threads = {},
                                                       const Typeface& typeface = inter());
  ~Renderer();

  // Copies the volume before it returns and shows it from the next draw() on. On an error (see
  // VolumeTexture::upload()) the last volume stays.
  hal::Result<> show_volume(const pipeline::Volume& volume);

  // Copies the frame before it returns. `field` is the outline of the OCT scan. The picture is
  // marked stale by its time.
  hal::Result<> show_scope_picture(const hal::ScopeFrame& frame,
                                   const std::optional<ScanField>& field);
  // Shows vessels in the volume from the next draw() on. The tree stays borrowed until another is
  // shown or the renderer is destroyed; `clock`, which measures the cost of drawing it, outlives
  // the renderer. ErrorCode::unsupported: this processor cannot draw vessels.
  hal::Result<> show_vessels(const PlacedVessels& vessels, const hal::Clock& clock);
  // Of the last draw().
  struct VesselReport {
    SegmentCounts account;
    hal::Duration cost{}; // 0: they were not drawn
  };
  VesselReport vessel_report() const;

  void forget_scope_picture(); // when the camera is gone

  // The histogram of levels in the volume, shown while the window is changed.
  void show_levels(const LevelShares& shares);

  // Draws everything into the bound framebuffer of width × height pixels.
  hal::Result<> draw(const ViewState& view, const Status& status, int width, int height,
                     const DrawQuality& quality = {});

  // Draws the volume alone over the whole of the bound framebuffer, with a scale bar and, if the
  // view has it, the wire-frame box. ErrorCode::invalid_argument: no volume was shown, or the size
  // is empty.
  hal::Result<> draw_volume_alone(const ViewState& view, int width, int height,
                                  const DrawQuality& quality = full_quality);

  // Waits until everything needed for a picture of that view and quality is ready, such as a mesh.
  // (The running display does not wait.) `volume` is the one shown last.
  hal::Result<> prepare(const pipeline::Volume& volume, const ViewState& view,
                        const DrawQuality& quality = full_quality);

  // Whether the last draw() redrew the volume's picture, which is most of a frame's cost.
  bool drew_volume() const;

  // Waits until everything is drawn.
  void finish() const;

  // Whether the processor casts the volume's rays at that quality; valid from the first volume on.
  // GL draws all other techniques.
  bool casts_rays(const DrawQuality& quality = {}) const;

  // False if draw() would repeat its last picture to the pixel.
  bool needs_redraw(const ViewState& view, const Status& status, int width, int height,
                    const DrawQuality& quality = {}) const;

  // Whether the view needs data not computed for the shown volume: then call show_volume() with it
  // again.
  bool wants_volume(const ViewState& view) const;

  // The content of the bound framebuffer; waits for the drawing. Allocates: for snapshots.
  pipeline::Image read_back(int width, int height) const;

private:
  struct Parts;
  explicit Renderer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

} // namespace octascope::ui

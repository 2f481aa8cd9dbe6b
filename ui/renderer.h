// Draws the whole display: volume, panels and heads-up display, into the framebuffer that is
// bound.
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
// there too. When the context is lost (Display::present() says disconnected), destroy it, open the
// display again and create a new one.
//
// A volume's picture is kept and drawn again only when the volume, the view or the window changes,
// so a frame that changes nothing but the heads-up display costs little. After the first frame of a
// size nothing of ours is allocated.
class Renderer {
public:
  // `threads` sets up the threads that help drawing: VolumePainter::create() names them.
  // The typeface stays borrowed. ErrorCode::unsupported: this GL cannot compile our shaders.
  static hal::Result<std::unique_ptr<Renderer>> create(const TransferSet& transfers = {},
                                                       const pipeline::ThreadSetup& threads = {},
                                                       const Typeface& typeface = inter());
  ~Renderer();

  // Copies the volume before it returns and shows it from the next draw() on. On an error the last
  // volume stays: VolumeTexture::upload() lists them.
  hal::Result<> show_volume(const pipeline::Volume& volume);

  // Copies the frame before it returns. `field` outlines what the OCT scans. The picture is marked
  // stale by its time.
  hal::Result<> show_scope_picture(const hal::ScopeFrame& frame,
                                   const std::optional<ScanField>& field);
  // From the next draw() on, in the volume. The tree stays borrowed until another is shown or the
  // renderer is destroyed; `clock`, which measures what drawing it costs, outlives the renderer.
  // ErrorCode::unsupported: this processor cannot draw vessels.
  hal::Result<> show_vessels(const PlacedVessels& vessels, const hal::Clock& clock);
  // Of the last draw().
  struct VesselReport {
    SegmentCounts account;
    hal::Duration cost{}; // 0: no picture of them was made
  };
  VesselReport vessel_report() const;

  void forget_scope_picture(); // the camera is gone

  // Shown while the window is being changed: how often each level occurs in the volume.
  void show_levels(const LevelShares& shares);

  // Draws everything into the bound framebuffer of width × height pixels.
  hal::Result<> draw(const ViewState& view, const Status& status, int width, int height,
                     const DrawQuality& quality = {});

  // Draws the volume alone over the whole of the bound framebuffer: with a scale bar, and with
  // the wire-frame box where the view has it. ErrorCode::invalid_argument: no volume was shown, or
  // the size is nothing.
  hal::Result<> draw_volume_alone(const ViewState& view, int width, int height,
                                  const DrawQuality& quality = full_quality);

  // Waits until everything that a picture of that view and quality needs is ready, such as a mesh.
  // (The running display does not wait.) `volume` is the one that was shown last.
  hal::Result<> prepare(const pipeline::Volume& volume, const ViewState& view,
                        const DrawQuality& quality = full_quality);

  // Whether the last draw() made the volume's picture anew, which is most of what a frame costs.
  bool drew_volume() const;

  // Waits until everything is drawn.
  void finish() const;

  // Whether the processor casts the volume's rays with that quality; from the first volume on.
  // Other techniques than rays are drawn by GL.
  bool casts_rays(const DrawQuality& quality = {}) const;

  // False when draw() would make the picture that it made last, to the pixel.
  bool needs_redraw(const ViewState& view, const Status& status, int width, int height,
                    const DrawQuality& quality = {}) const;

  // The view needs data that was not computed for the shown volume: call show_volume() with it
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

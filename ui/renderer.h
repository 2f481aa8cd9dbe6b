// Draws the whole display into the bound framebuffer: the volume, the panels and the heads-up
// display.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "hal/clock.h"
#include "hal/display.h"
#include "hal/result.h"
#include "hal/scope_camera.h"
#include "pipeline/files/png_image.h"
#include "pipeline/threads/worker_pool.h"
#include "pipeline/volume/volume.h"
#include "ui/canvas/fonts.h"
#include "ui/hud/window_histogram.h"
#include "ui/layout/scan_field.h"
#include "ui/status/status.h"
#include "ui/transfer/transfer_set.h"
#include "ui/view/draw_quality.h"
#include "ui/view/segment_counts.h"
#include "ui/view/vessel_placement.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Threads: create() binds it to the current thread and GLES 3 context; destroy it there too. When
// the context is lost (Display::present() says disconnected), destroy it, open the display again
// and create a new one.
//
// The volume's picture is kept and redrawn only when the volume, the view or the window changes, and
// of a frame only what differs from what its buffer holds (ui/damage). Allocates nothing of its own after the
// first frame of a size.
class Renderer {
public:
  // `threads` sets up the drawing threads that VolumePainter::create() names. The typeface is
  // borrowed for the renderer's lifetime. ErrorCode::unsupported: this GL cannot compile the
  // shaders.
  static hal::Result<std::unique_ptr<Renderer>> create(const TransferSet& transfers = {},
                                                       const pipeline::ThreadSetup& threads = {},
                                                       const Typeface& typeface = inter());
  ~Renderer();

  // Copies the volume before it returns; the next draw() shows it. After an error (see
  // VolumeTexture::upload()) the previous volume stays.
  hal::Result<> show_volume(const pipeline::Volume& volume);

  // The same where the volume, which has an occupancy, differs from the one shown last in these
  // B-scans alone: only what depends on them is renewed. One of them may be the seam between two
  // volumes (pipeline/acquisition/rolling_volume.h). What lies where in the tissue, for the flat
  // pictures, is found anew when the last B-scan is renewed.
  hal::Result<> renew_volume(const pipeline::Volume& volume,
                             std::span<const pipeline::BScanRange> changed);

  // Copies what it can of a volume that is going to be shown, so that showing it takes less: of the first
  // `finished` B-scans, which stay as they are; none of the others is read. `number`: what will be its
  // VolumeMetadata::index. `shown` must be the volume shown last.
  void bring_ahead(const pipeline::Volume& coming, std::uint64_t number, int finished,
                   const pipeline::Volume& shown);

  // Copies the frame before it returns. `field` is the outline of the OCT scan. The frame's time
  // decides when the picture is marked stale.
  hal::Result<> show_scope_picture(const hal::ScopeFrame& frame,
                                   const std::optional<ScanField>& field);
  // The next draw() shows the vessels in the volume. The tree is borrowed until another one is
  // shown or the renderer is destroyed. `clock` measures the drawing cost and must outlive the
  // renderer. ErrorCode::unsupported: this processor cannot draw vessels.
  hal::Result<> show_vessels(const PlacedVessels& vessels, const hal::Clock& clock);
  // Of the last draw().
  struct VesselReport {
    SegmentCounts account;
    hal::Duration cost{}; // 0: no picture of the vessels was drawn
  };
  VesselReport vessel_report() const;

  void forget_scope_picture(); // the camera is gone

  // Shows the histogram of the volume's levels while the window is being changed.
  void show_levels(const LevelShares& shares);

  // Draws everything into the bound framebuffer of width × height pixels. Of a buffer that holds an
  // image that was drawn here before, only what is different by now is drawn over: all pixels are
  // then as if everything had been drawn. By default nothing is taken to be there.
  hal::Result<> draw(const ViewState& view, const Status& status, int width, int height,
                     const DrawQuality& quality = {}, const hal::BackBuffer& buffer = {});

  // Draws only the volume over the whole bound framebuffer, with a scale bar and, if the view has
  // it, the wire-frame box. ErrorCode::invalid_argument: no volume was shown, or the size is empty.
  hal::Result<> draw_volume_alone(const ViewState& view, int width, int height,
                                  const DrawQuality& quality = full_quality);

  // Waits until everything needed for a picture of that view and quality is ready, such as a mesh.
  // (The live display does not wait.) `volume` must be the one shown last.
  hal::Result<> prepare(const pipeline::Volume& volume, const ViewState& view,
                        const DrawQuality& quality = full_quality);

  // Whether the last draw() redrew the volume's picture, which is most of a frame's cost.
  bool drew_volume() const;

  // Waits until the GPU has finished drawing.
  void finish() const;

  // Whether the processor casts the rays at that quality; known once a volume was shown. GL draws
  // all other techniques.
  bool casts_rays(const DrawQuality& quality = {}) const;

  // False if draw() would produce exactly the picture that it produced last.
  bool needs_redraw(const ViewState& view, const Status& status, int width, int height,
                    const DrawQuality& quality = {}) const;

  // Compiles what that view of a volume with flow is drawn with, which show_volume() would do. Where this GL
  // cannot, what flows is not drawn, and the display says so.
  void prepare_flow(const ViewState& view);
  // Why not; empty: it can, as far as was tried.
  const std::optional<hal::Error>& flow_refusal() const;

  // What volumes are going to be seen with: show_volume() computes what that needs. draw() does
  // it, too, for the next one.
  void expect(const ViewState& view);

  // Copies and computes what drawing that view at that quality needs of the shown volume and is not
  // there yet; `volume` must be the one shown last. From the first call on, show_volume() and
  // renew_volume() leave out what is not drawn, and it must be called before each draw().
  hal::Result<> complete(const pipeline::Volume& volume, const ViewState& view,
                         const DrawQuality& quality = {});

  // The content of the bound framebuffer. Waits for the drawing and allocates: for snapshots.
  pipeline::Image read_back(int width, int height) const;

private:
  struct Parts;
  explicit Renderer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

} // namespace octascope::ui

// The volume that the display shows: the newest whole one or, in the mode "rolling", what is finished of the
// one in the making over it.
#pragma once

#include <optional>

#include "firmware-host/ledger/line_latency.h"
#include "hal/result.h"
#include "pipeline/acquisition/rolling_volume.h"
#include "pipeline/acquisition/volume_feed.h"
#include "ui/renderer.h"
#include "ui/view/view_state.h"

namespace octascope::firmware_host {

// Threads: the render thread's. Allocates when it is made, never afterwards.
class ShownVolume {
public:
  // Borrows `volumes`, whose volumes have that geometry.
  ShownVolume(pipeline::VolumeFeed& volumes, const pipeline::VolumeGeometry& geometry);

  // The newest that was taken, valid until the next take(); null while there is none.
  const pipeline::Volume* whole() const { return whole_; }
  bool rolls() const { return rolling_; }
  // Not to be called while there is no whole one.
  const pipeline::Volume& shown() const { return rolling_ ? rolling_volume_->volume() : *whole_; }
  // Empty: all is of one volume.
  std::optional<pipeline::RollingVolume::Seam> seam() const {
    return rolling_ ? rolling_volume_->seam() : std::nullopt;
  }

  // A turn without a display: what will be shown again stays as it is.
  void keep(const ui::ViewState& view) {
    rolling_ = rolling_ && may_roll(view);
    volumes_.expect(pipeline::Showing::nothing);
  }

  // Takes the newest, unless the view is frozen, and returns it; null if none has come.
  const pipeline::Volume* take(const ui::ViewState& view);

  // Whether show() has anything to do after the last take().
  bool has_news() const { return whole_ != nullptr && (newest_ != nullptr || rolled_ || rolling_); }

  // Gives the renderer what it lacks since the last take().
  hal::Result<> show(ui::Renderer& renderer, const ui::ViewState& view);
  // Between two frames. Gives the renderer, which has drawn what it was given, what is finished of the next
  // whole one, unless B-scans are shown as they come or none is going to be shown.
  void bring_ahead(ui::Renderer& renderer, const ui::ViewState& view);
  // What a frame of that view needs of it and was not given so far, right before it is drawn.
  hal::Result<> complete(ui::Renderer& renderer, const ui::ViewState& view,
                         const ui::DrawQuality& quality);
  // All of it, to a renderer that has nothing; does nothing while there is no volume.
  hal::Result<> show_again(ui::Renderer& renderer);

  // A frame with what was shown waits for its flip.
  void note_drawn() { volumes_.note_drawn(); }
  // A frame with it was seen then.
  void flipped(hal::TimePoint seen) { line_latency_.flipped(seen); }
  // The display is gone: what it was given was not seen.
  void forget_unseen() { line_latency_.forget(); }
  // Of all lines that were shown so far.
  pipeline::DurationSummary line_latency() const { return line_latency_.summary(); }

private:
  bool may_roll(const ui::ViewState& view) const;
  hal::Result<> give(ui::Renderer& renderer, const ui::ViewState& view);
  hal::Result<> show_whole(ui::Renderer& renderer);
  hal::Result<> show_b_scans(ui::Renderer& renderer, const pipeline::Volume* taken, int kept_clear);

  pipeline::VolumeFeed& volumes_;
  const pipeline::Volume* whole_ = nullptr;
  const pipeline::Volume* newest_ = nullptr;              // of the last take()
  std::optional<pipeline::RollingVolume> rolling_volume_; // empty: no B-scans come by themselves
  bool rolling_ = false;                                  // it is shown, not whole_
  bool rolled_ = false;                                   // before the last take()
  bool renewable_ = false; // the renderer holds all of it but for its changes
  bool given_ = true;      // what the last show() was to give
  LineLatency line_latency_;
};

} // namespace octascope::firmware_host

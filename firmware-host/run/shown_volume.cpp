#include "firmware-host/run/shown_volume.h"

#include <utility>

namespace octascope::firmware_host {

ShownVolume::ShownVolume(pipeline::VolumeFeed& volumes, const pipeline::VolumeGeometry& geometry)
    : volumes_{volumes}, line_latency_{geometry.b_scans} {
  if (volumes.lends())
    rolling_volume_.emplace(geometry, volumes.has_flow());
}

// What is frozen is whole, and so is what an iso-surface is made of.
bool ShownVolume::may_roll(const ui::ViewState& view) const {
  return rolling_volume_ && view.rolling && !view.frozen &&
         view.technique != ui::Technique::surface;
}

const pipeline::Volume* ShownVolume::take(const ui::ViewState& view) {
  rolled_ = std::exchange(rolling_, may_roll(view));
  volumes_.expect(view.frozen ? pipeline::Showing::nothing
                  : rolling_  ? pipeline::Showing::rolling
                              : pipeline::Showing::whole);
  newest_ = view.frozen ? nullptr : volumes_.take_newest();
  if (newest_ != nullptr)
    whole_ = newest_;
  return newest_;
}

void ShownVolume::bring_ahead(ui::Renderer& renderer, const ui::ViewState& view) {
  if (!volumes_.lends() || whole_ == nullptr || rolling_ || !given_ || view.frozen)
    return;
  const auto making = volumes_.borrow_after(whole_->metadata.index);
  if (!making)
    return;
  int finished = 0;
  for (const auto& progress : making->progress) {
    if (progress.load(std::memory_order_acquire) != pipeline::BScanProgress::finished)
      break;
    ++finished;
  }
  renderer.bring_ahead(*making->volume, making->number, finished, *whole_);
  volumes_.give_back();
}

// What could not be given, complete() tries again as a whole: the renderer may hold another one.
hal::Result<> ShownVolume::show(ui::Renderer& renderer, const ui::ViewState& view) {
  const auto result = give(renderer, view);
  given_ = result.has_value();
  return result;
}

hal::Result<> ShownVolume::complete(ui::Renderer& renderer, const ui::ViewState& view,
                                    const ui::DrawQuality& quality) {
  if (whole_ == nullptr)
    return {};
  if (!given_)
    HAL_CHECK(show_again(renderer));
  return renderer.complete(shown(), view, quality);
}

hal::Result<> ShownVolume::give(ui::Renderer& renderer, const ui::ViewState& view) {
  if (rolling_)
    return show_b_scans(renderer, rolled_ ? newest_ : whole_, view.b_scan);
  return newest_ != nullptr || rolled_ ? show_whole(renderer) : hal::Result<>{};
}

hal::Result<> ShownVolume::show_again(ui::Renderer& renderer) {
  renewable_ = false;
  if (whole_ != nullptr)
    HAL_CHECK(renderer.show_volume(shown()));
  given_ = true;
  return {};
}

hal::Result<> ShownVolume::show_whole(ui::Renderer& renderer) {
  renewable_ = false;
  HAL_CHECK(renderer.show_volume(*whole_));
  line_latency_.show(*whole_, {0, whole_->geometry.b_scans});
  return {};
}

// `taken`: the last whole volume, unless it was taken before.
hal::Result<> ShownVolume::show_b_scans(ui::Renderer& renderer, const pipeline::Volume* taken,
                                        int kept_clear) {
  if (taken != nullptr)
    rolling_volume_->take(*taken);
  if (const auto making = volumes_.borrow_after(whole_->metadata.index)) {
    rolling_volume_->follow(*making, kept_clear);
    volumes_.give_back();
  }
  const auto changes = rolling_volume_->take_changes();
  if (!changes.empty())
    volumes_.note_begun();
  HAL_CHECK(std::exchange(renewable_, false)
                ? renderer.renew_volume(rolling_volume_->volume(), changes)
                : renderer.show_volume(rolling_volume_->volume()));
  renewable_ = true;
  for (const pipeline::BScanRange& range : changes)
    line_latency_.show(rolling_volume_->volume(), range);
  return {};
}

} // namespace octascope::firmware_host

#include "ui/damage/picture_changes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace octascope::ui {

namespace {

// Where a B-scan lies among so many pixels along the slow axis, with those beside it, which it is
// interpolated with.
std::pair<int, int> span_of(int b, int b_scans, const Section& shown, int pixels) {
  const auto most = static_cast<float>(pixels);
  const auto place = [&](int at) {
    const float share = static_cast<float>(at) / static_cast<float>(b_scans);
    return (share - shown.from) / shown.length() * most;
  };
  return {static_cast<int>(std::clamp(std::floor(place(b - 1)) - 1, 0.0F, most)),
          static_cast<int>(std::clamp(std::ceil(place(b + 2)) + 1, 0.0F, most))};
}

} // namespace

void PictureChanges::note(const pipeline::BScanRange& changed, int b_scans) {
  changed_.resize(static_cast<std::size_t>(b_scans), 1);
  projected_.resize(changed_.size(), 1);
  std::fill(changed_.begin() + changed.from, changed_.begin() + changed.to, std::uint8_t{1});
}

void PictureChanges::note_projection(std::span<const std::uint8_t> rows) {
  for (std::size_t b = 0; b < std::min(rows.size(), projected_.size()); ++b)
    projected_[b] |= rows[b];
}

// The last is not meant.
bool PictureChanges::any_changed(int from, int to) const {
  const int count = static_cast<int>(changed_.size());
  const auto at = [&](int b) { return changed_.begin() + std::clamp(b, 0, count); };
  return std::find(at(from), at(to), 1) != at(to);
}

void PictureChanges::compare(const PictureSources& now, Damage& damage) {
  const PictureSources& was = before_;
  const auto renew = [&](const Rect& old, const Rect& rect, bool all) {
    if (!all && old == rect)
      return;
    damage.add(old);
    damage.add(rect);
  };
  const bool cut = now.geometry != was.geometry || now.crop != was.crop;
  const bool window =
      now.window_offset_db != was.window_offset_db || now.window_size_db != was.window_size_db;
  renew(was.view, now.view, false);
  renew(was.scope, now.scope,
        now.scope_uploads != was.scope_uploads || now.scope_stale != was.scope_stale ||
            now.flow_in_scope != was.flow_in_scope ||
            (now.flow_in_scope != 0 && now.deepest_flow != was.deepest_flow));
  const bool flow = now.flow != was.flow;
  renew(was.b_scan, now.b_scan,
        cut || window || flow || now.b_scan_index != was.b_scan_index ||
            any_changed(now.b_scan_index - 1, now.b_scan_index + 2));
  renew(was.crossed, now.crossed, cut || window || flow || now.a_scan_index != was.a_scan_index);
  renew(was.en_face, now.en_face,
        cut || flow || (now.flow && now.deepest_flow != was.deepest_flow));
  const auto shown = [&](std::size_t b, int pixels) {
    return span_of(static_cast<int>(b), static_cast<int>(changed_.size()), now.crop.b, pixels);
  };
  for (std::size_t b = 0; b < changed_.size(); ++b) {
    if (changed_[b] != 0 && !now.crossed.empty()) {
      const auto [from, to] = shown(b, now.crossed.width);
      damage.add({now.crossed.x + from, now.crossed.y, to - from, now.crossed.height});
    }
    if ((changed_[b] != 0 || projected_[b] != 0) && !now.en_face.empty()) {
      const auto [from, to] = shown(b, now.en_face.height);
      damage.add({now.en_face.x, now.en_face.y + from, now.en_face.width, to - from});
    }
  }
  std::ranges::fill(changed_, std::uint8_t{0});
  std::ranges::fill(projected_, std::uint8_t{0});
  before_ = now;
}

} // namespace octascope::ui

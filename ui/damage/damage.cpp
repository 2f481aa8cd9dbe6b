#include "ui/damage/damage.h"

#include <algorithm>

namespace octascope::ui {

void Damage::begin(int width, int height) {
  width_ = width;
  height_ = height;
  across_ = (width + damage_tile - 1) / damage_tile;
  down_ = (height + damage_tile - 1) / damage_tile;
  tiles_.assign(index(0, down_), 0);
  left_.resize(tiles_.size());
  rects_.clear();
  rects_.reserve(most_rects);
}

void Damage::add(const Rect& rect) {
  const int left = std::max(rect.x, 0) / damage_tile;
  const int top = std::max(rect.y, 0) / damage_tile;
  const int right = std::min((rect.right() + damage_tile - 1) / damage_tile, across_);
  const int bottom = std::min((rect.bottom() + damage_tile - 1) / damage_tile, down_);
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x)
      add_tile(x, y);
}

void Damage::add_tiles(std::span<const std::uint8_t> tiles) {
  for (std::size_t i = 0; i < tiles_.size(); ++i)
    tiles_[i] |= tiles[i];
}

void Damage::add_everything() {
  std::ranges::fill(tiles_, std::uint8_t{1});
}

bool Damage::empty() const {
  return std::ranges::find(tiles_, 1) == tiles_.end();
}

bool Damage::row_is_set(int left, int right, int y) const {
  const auto from = left_.begin() + static_cast<std::ptrdiff_t>(index(left, y));
  return std::all_of(from, from + (right - left), [](std::uint8_t set) { return set != 0; });
}

// The widest from that tile on, and of these the highest.
Rect Damage::take_rect(int x, int y) {
  int right = x + 1;
  while (right < across_ && left_[index(right, y)] != 0)
    ++right;
  int bottom = y + 1;
  while (bottom < down_ && row_is_set(x, right, bottom))
    ++bottom;
  for (int row = y; row < bottom; ++row)
    std::fill_n(left_.begin() + static_cast<std::ptrdiff_t>(index(x, row)), right - x,
                std::uint8_t{0});
  return {x * damage_tile, y * damage_tile, std::min(right * damage_tile, width_) - x * damage_tile,
          std::min(bottom * damage_tile, height_) - y * damage_tile};
}

void cut_out(std::vector<Rect>& rects, const Rect& hole) {
  for (std::size_t i = 0, count = rects.size(); i < count;) {
    const Rect rect = rects[i];
    const Rect gone = common(rect, hole);
    if (gone.empty()) {
      ++i;
      continue;
    }
    rects[i] = rects[--count]; // what is behind `count` has no part of the hole
    rects[count] = rects.back();
    rects.pop_back();
    for (const Rect& left : {Rect{rect.x, rect.y, rect.width, gone.y - rect.y},
                             Rect{rect.x, gone.bottom(), rect.width, rect.bottom() - gone.bottom()},
                             Rect{rect.x, gone.y, gone.x - rect.x, gone.height},
                             Rect{gone.right(), gone.y, rect.right() - gone.right(), gone.height}})
      if (!left.empty())
        rects.push_back(left);
  }
}

std::span<const Rect> Damage::rects() {
  rects_.clear();
  std::ranges::copy(tiles_, left_.begin());
  for (int y = 0; y < down_; ++y)
    for (int x = 0; x < across_; ++x) {
      if (left_[index(x, y)] == 0)
        continue;
      if (rects_.size() == most_rects) {
        rects_.assign(1, {0, 0, width_, height_});
        return rects_;
      }
      rects_.push_back(take_rect(x, y));
    }
  return rects_;
}

} // namespace octascope::ui

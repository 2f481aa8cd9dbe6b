// A part of a picture, as tiles of it: what is to be drawn anew.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ui/layout/layout.h"

namespace octascope::ui {

inline constexpr int damage_tile = 32; // pixels each way

// Threads: one at a time. Allocates when the size grows.
class Damage {
public:
  // Nothing of a picture of that size.
  void begin(int width, int height);

  void add(const Rect& rect);                                // what of it lies within the picture
  void add(const Damage& other) { add_tiles(other.tiles_); } // of the same size
  void add_tile(int x, int y) { tiles_[index(x, y)] = 1; }
  void add_everything();

  bool empty() const;
  int width() const { return width_; }
  int height() const { return height_; }
  int tiles_across() const { return across_; }
  int tiles_down() const { return down_; }

  // Rectangles that hold all of it and do not overlap. Of very many pieces: one, the whole picture.
  // Valid until the next call.
  std::span<const Rect> rects();

private:
  static constexpr std::size_t most_rects = 64;

  void add_tiles(std::span<const std::uint8_t> tiles);
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(x);
  }
  bool row_is_set(int left, int right, int y) const;
  Rect take_rect(int x, int y);

  int width_ = 0;
  int height_ = 0;
  int across_ = 0;
  int down_ = 0;
  std::vector<std::uint8_t> tiles_; // [row][column]: 1 if it is part of it
  std::vector<std::uint8_t> left_;  // the same, of what rects() has not taken yet
  std::vector<Rect> rects_;
};

// Takes `hole` out of rectangles that do not overlap.
void cut_out(std::vector<Rect>& rects, const Rect& hole);

} // namespace octascope::ui

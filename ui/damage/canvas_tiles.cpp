#include "ui/damage/canvas_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <imgui.h>

namespace octascope::ui {

struct Corners {
  std::array<ImVec2, 3> at;
};

namespace {

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15; // 2^64 / the golden ratio
  hash = (hash ^ value) * odd;
  return hash ^ (hash >> 29);
}

std::uint64_t mixed(std::uint64_t hash, const ImDrawVert& vertex) {
  std::array<std::uint64_t, 3> words{};
  static_assert(sizeof(vertex) <= sizeof(words));
  std::memcpy(words.data(), &vertex, sizeof(vertex));
  for (const std::uint64_t word : words)
    hash = mixed(hash, word);
  return hash;
}

std::uint64_t hash_of(const ImDrawCmd& command) {
  std::array<std::uint64_t, 2> clip{};
  static_assert(sizeof(command.ClipRect) == sizeof(clip));
  std::memcpy(clip.data(), &command.ClipRect, sizeof(clip));
  const auto texture = reinterpret_cast<std::uintptr_t>(command.GetTexID());
  return mixed(mixed(mixed(1, clip[0]), clip[1]), texture);
}

Rect pixels_of(const ImVec4& clip) {
  const auto left = static_cast<int>(std::floor(clip.x));
  const auto top = static_cast<int>(std::floor(clip.y));
  return {left, top, static_cast<int>(std::ceil(clip.z)) - left,
          static_cast<int>(std::ceil(clip.w)) - top};
}

// How far a triangle reaches along x between two heights; nothing if it is not there.
struct Span {
  float from = std::numeric_limits<float>::max();
  float to = std::numeric_limits<float>::lowest();
  void add(float x) {
    from = std::min(from, x);
    to = std::max(to, x);
  }
};

Span span_between(const Corners& corners, float top, float bottom) {
  Span span;
  for (std::size_t i = 0; i < 3; ++i) {
    const ImVec2& a = corners.at[i];
    const ImVec2& b = corners.at[(i + 1) % 3];
    if (a.y >= top && a.y <= bottom)
      span.add(a.x);
    for (const float y : {top, bottom})
      if ((a.y < y) != (b.y < y))
        span.add(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
  }
  return span;
}

int tile_of(float pixel, int most) {
  const float within = std::clamp(pixel, 0.0F, static_cast<float>(most * damage_tile));
  return std::min(static_cast<int>(within) / damage_tile, most - 1);
}

} // namespace

void CanvasTiles::begin(int width, int height) {
  comparable_ = width == width_ && height == height_;
  width_ = width;
  height_ = height;
  across_ = (width + damage_tile - 1) / damage_tile;
  down_ = (height + damage_tile - 1) / damage_tile;
  std::swap(tiles_, before_);
  tiles_.assign(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_), 0);
}

// With a pixel to spare: a rasteriser rounds corners to parts of one.
void CanvasTiles::add_triangle(const Corners& corners, std::uint64_t hash, const Rect& clip) {
  const auto& [a, b, c] = corners.at;
  const float top = std::max(std::min({a.y, b.y, c.y}) - 1, static_cast<float>(clip.y));
  const float bottom = std::min(std::max({a.y, b.y, c.y}) + 1, static_cast<float>(clip.bottom()));
  const auto left = static_cast<float>(clip.x);
  const auto right = static_cast<float>(clip.right());
  if (top > bottom)
    return;
  for (int y = tile_of(top, down_); y <= tile_of(bottom, down_); ++y) {
    const auto row = static_cast<float>(y * damage_tile);
    const Span span = span_between(corners, row - 1, row + damage_tile + 1);
    const float from = std::max(span.from - 1, left);
    const float to = std::min(span.to + 1, right);
    if (from > to)
      continue;
    for (int x = tile_of(from, across_); x <= tile_of(to, across_); ++x) {
      std::uint64_t& tile = tiles_[static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) +
                                   static_cast<std::size_t>(x)];
      tile = mixed(tile, hash);
    }
  }
}

void CanvasTiles::add(const Canvas& canvas) {
  const ImDrawList& list = canvas.list();
  for (const ImDrawCmd& command : list.CmdBuffer) {
    const std::uint64_t state = hash_of(command);
    const Rect clip = pixels_of(command.ClipRect);
    const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
    for (unsigned i = 0; i + 2 < command.ElemCount; i += 3, index += 3) {
      std::uint64_t hash = state;
      Corners corners;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const ImDrawVert& vertex = list.VtxBuffer.Data[index[corner]];
        corners.at[corner] = vertex.pos;
        hash = mixed(hash, vertex);
      }
      add_triangle(corners, hash, clip);
    }
  }
  for (std::uint64_t& tile : tiles_) // what follows is drawn over pictures
    tile = mixed(tile, 0);
}

void CanvasTiles::compare(Damage& damage) {
  if (!comparable_) {
    damage.add_everything();
    return;
  }
  for (int y = 0; y < down_; ++y)
    for (int x = 0; x < across_; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) +
                             static_cast<std::size_t>(x);
      if (tiles_[at] != before_[at])
        damage.add_tile(x, y);
    }
}

} // namespace octascope::ui

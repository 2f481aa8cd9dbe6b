#include "ui/dither/dither_mask.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace octascope::ui {

namespace {

constexpr std::size_t cells = std::tuple_size_v<DitherMask>;

std::size_t cell_at(int x, int y) {
  constexpr unsigned last = dither_size - 1;
  return (static_cast<std::size_t>(static_cast<unsigned>(y) & last)) * dither_size +
         (static_cast<unsigned>(x) & last);
}

// Points on a torus, and how crowded each place is.
class Pattern {
public:
  Pattern() {
    constexpr double sigma = 1.5; // Ulichney's
    for (int y = 0; y < dither_size; ++y)
      for (int x = 0; x < dither_size; ++x) {
        const double dx = std::min(x, dither_size - x);
        const double dy = std::min(y, dither_size - y);
        spread_[cell_at(x, y)] = std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
      }
  }

  bool has(std::size_t cell) const { return set_[cell]; }
  void put(std::size_t cell, bool point) {
    set_[cell] = point;
    const int left = static_cast<int>(cell % dither_size);
    const int top = static_cast<int>(cell / dither_size);
    for (int y = 0; y < dither_size; ++y)
      for (int x = 0; x < dither_size; ++x)
        crowd_[cell_at(left + x, top + y)] +=
            point ? spread_[cell_at(x, y)] : -spread_[cell_at(x, y)];
  }
  // Of the points, the one in the thickest crowd; of the other places, the emptiest.
  std::size_t tightest_cluster() const { return extreme(true, 1); }
  std::size_t largest_void() const { return extreme(false, -1); }

private:
  std::size_t extreme(bool of_points, double sign) const {
    std::size_t best = cells;
    for (std::size_t i = 0; i < cells; ++i)
      if (set_[i] == of_points && (best == cells || sign * crowd_[i] > sign * crowd_[best]))
        best = i;
    return best;
  }

  std::array<bool, cells> set_{};
  std::array<double, cells> crowd_{};
  std::array<double, cells> spread_{};
};

// A tenth of the places, moved from clusters to voids until they lie evenly.
Pattern even_pattern() {
  constexpr std::size_t points = cells / 10;
  Pattern pattern;
  std::uint32_t random = 1;
  for (std::size_t placed = 0; placed < points;) {
    random = random * 1664525U + 1013904223U; // the constants of Numerical Recipes
    const std::size_t cell = random >> 22U;
    if (pattern.has(cell))
      continue;
    pattern.put(cell, true);
    ++placed;
  }
  static_assert(cells == 1U << 10U, "the random number's upper bits are a cell");
  for (std::size_t turn = 0; turn < cells; ++turn) {
    const std::size_t from = pattern.tightest_cluster();
    pattern.put(from, false);
    const std::size_t to = pattern.largest_void();
    pattern.put(to, true);
    if (to == from)
      break;
  }
  return pattern;
}

DitherMask make_mask() {
  DitherMask mask{};
  const auto value = [](std::size_t rank) {
    return (static_cast<float>(rank) + 0.5F) / static_cast<float>(cells);
  };
  Pattern falling = even_pattern();
  Pattern rising = falling;
  std::size_t points = 0;
  for (std::size_t i = 0; i < cells; ++i)
    points += falling.has(i) ? 1U : 0U;
  for (std::size_t rank = points; rank-- > 0;) {
    const std::size_t cell = falling.tightest_cluster();
    falling.put(cell, false);
    mask[cell] = value(rank);
  }
  for (std::size_t rank = points; rank < cells; ++rank) {
    const std::size_t cell = rising.largest_void();
    rising.put(cell, true);
    mask[cell] = value(rank);
  }
  return mask;
}

} // namespace

const DitherMask& dither_mask() {
  static const DitherMask mask = make_mask();
  return mask;
}

} // namespace octascope::ui

#include "ui/panels/tissue_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace octascope::ui {

namespace {

constexpr std::uint32_t counts_above_noise = 12; // 6 dB: the maxima of noise bricks hardly differ
constexpr double smallest_gap_mm = 0.3;
constexpr int steps = 16; // of a crop along an extent
constexpr int fewest_steps = 4;
constexpr std::size_t depth_sampling = 4; // of so many columns, one counts for the depths
constexpr std::size_t level_sampling = 8; // of so many B-scans, one tells what noise is
constexpr float margin = 0.02F;           // around the tissue, of the extent
constexpr int most_apart = 4;             // bricks along depth: beyond, it is an edge and no slope

// The lowest level of a brick with tissue. Noise is the lowest peak of the brick's highest levels
// that stands out and has a quarter of the highest peak's height.
std::uint8_t tissue_level(const pipeline::Occupancy& occupancy,
                          std::span<const pipeline::BScanState> states) {
  std::array<std::uint32_t, 256> counts{};
  for (std::size_t b = 0;
       b<states.size(); b += states.size()> 3 * level_sampling ? level_sampling : 1)
    if (has_levels(states[b]))
      for (const std::uint8_t level : occupancy.highest(static_cast<int>(b)))
        ++counts[level];
  counts[0] = 0; // nothing was received there, or nothing is looked at
  const std::uint32_t high = std::max(*std::ranges::max_element(counts) / 4, 1U);
  constexpr std::size_t reach = 6;
  for (std::size_t level = 0; level < counts.size(); ++level) {
    const std::size_t first = level > reach ? level - reach : 0;
    const auto around =
        std::span{counts}.subspan(first, std::min(level + reach + 1, counts.size()) - first);
    if (counts[level] >= high && counts[level] == *std::ranges::max_element(around))
      return static_cast<std::uint8_t>(std::min<std::size_t>(level + counts_above_noise, 255));
  }
  return 255;
}

// The first of the bytes, all 0 or 1, from there on that is `wanted`; `end` if there is none.
std::size_t next_of(const std::uint8_t* bytes, std::size_t from, std::size_t end,
                    std::uint8_t wanted) {
  const std::uint64_t eight_others = wanted == 1 ? 0 : 0x0101010101010101U;
  while (from + 8 <= end) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, bytes + from, 8);
    if (eight != eight_others)
      break;
    from += 8;
  }
  while (from < end && bytes[from] != wanted)
    ++from;
  return from;
}

// A glaring surface has side lobes above it: it begins where it is much brighter, if that is near.
std::size_t past_side_lobes(const std::uint8_t* column, std::size_t first, std::size_t end) {
  constexpr std::size_t reach = 5;
  constexpr int much = 20; // 10 dB
  std::size_t brightest = first;
  for (std::size_t k = first; k < std::min(first + reach, end); ++k)
    if (column[k] > column[brightest])
      brightest = k;
  return brightest < end && column[brightest] > column[first] + much ? brightest : first;
}

// The outermost entries that have at least `least`, as a section in whole steps.
Section section_of(std::span<const std::uint32_t> counts, double least) {
  const auto has = [&](std::uint32_t count) { return count >= least; };
  const auto first = std::ranges::find_if(counts, has);
  if (first == counts.end())
    return {};
  const auto last = std::find_if(counts.rbegin(), counts.rend(), has).base();
  const auto size = static_cast<float>(counts.size());
  int from = static_cast<int>(
      std::floor((static_cast<float>(first - counts.begin()) / size - margin) * steps));
  int to = static_cast<int>(
      std::ceil((static_cast<float>(last - counts.begin()) / size + margin) * steps));
  from = std::clamp(from, 0, steps);
  to = std::clamp(to, from, steps);
  const int lacking = std::max(fewest_steps - (to - from), 0);
  from = std::max(from - lacking, 0);
  to = std::min(std::max(to, from + fewest_steps), steps);
  return {static_cast<float>(from) / steps, static_cast<float>(to) / steps};
}

Section united(const Section& a, const Section& b) {
  return {std::min(a.from, b.from), std::max(a.to, b.to)};
}

Crop united(const Crop& a, const Crop& b) {
  return {united(a.depth, b.depth), united(a.a, b.a), united(a.b, b.b)};
}

} // namespace

void TissueMap::update(const pipeline::Occupancy& occupancy,
                       std::span<const pipeline::BScanState> states) {
  if (occupancy.geometry() != geometry_) {
    geometry_ = occupancy.geometry();
    bricks_ = occupancy.bricks();
    changed_.clear(); // all of it
    rows_ = (geometry_.b_scans + (1 << pipeline::brick_b_shift) - 1) >> pipeline::brick_b_shift;
    const std::size_t columns =
        static_cast<std::size_t>(rows_) * static_cast<std::size_t>(bricks_.a);
    found_.resize(columns);
    along_.resize(columns);
    median_.resize(columns);
    smoothed_.resize(columns);
    at_depth_.resize(static_cast<std::size_t>(bricks_.depth));
    is_tissue_.resize(at_depth_.size());
    at_a_.resize(static_cast<std::size_t>(bricks_.a));
    at_b_.resize(static_cast<std::size_t>(rows_));
  }
  for (auto* counts : {&at_depth_, &at_a_, &at_b_})
    std::ranges::fill(*counts, 0U);
  const std::uint8_t level_before = level_;
  level_ = tissue_level(occupancy, states);
  const bool all_changed = level_ != level_before || changed_.size() != at_b_.size();
  changed_.assign(at_b_.size(), all_changed ? 1 : 0);
  for (int row = 0; row < rows_; ++row)
    find_begins(occupancy, row);
  smooth();
  find_extents(states);
}

// Loops over single bytes that a compiler makes vectors of, then looks at eight at once.
void TissueMap::find_begins(const pipeline::Occupancy& occupancy, int row) {
  const std::size_t depths = at_depth_.size();
  const double brick_mm = geometry_.depth_spacing_um * (1 << pipeline::brick_depth_shift) * 1e-3;
  const auto gap = static_cast<std::size_t>(std::max(std::ceil(smallest_gap_mm / brick_mm), 2.0));
  const std::span<const std::uint8_t> highest = occupancy.highest(row << pipeline::brick_b_shift);
  std::uint8_t* const tissue = is_tissue_.data();
  for (std::size_t a = 0; a < at_a_.size(); ++a) {
    const std::uint8_t* const column = highest.data() + a * depths;
    std::uint16_t count = 0;
    for (std::size_t k = 0; k < depths; ++k) {
      const std::uint8_t has = column[k] >= level_ ? 1 : 0;
      tissue[k] = has;
      count = static_cast<std::uint16_t>(count + has);
    }
    at_a_[a] += count;
    at_b_[static_cast<std::size_t>(row)] += count;
    if ((a + static_cast<std::size_t>(row)) % depth_sampling == 0)
      for (std::size_t k = 0; k < depths; ++k)
        at_depth_[k] += tissue[k];
    const std::size_t first = past_side_lobes(column, next_of(tissue, 0, depths, 1), depths);
    std::size_t behind = depths;
    for (std::size_t end = next_of(tissue, first, depths, 0); end < depths;) {
      const std::size_t next = next_of(tissue, end, depths, 1);
      if (next < depths && next - end >= gap) {
        behind = next;
        break;
      }
      end = next_of(tissue, next, depths, 0);
    }
    const bool has_gap = behind < depths;
    found_[static_cast<std::size_t>(row) * at_a_.size() + a] = {
        static_cast<std::uint16_t>(has_gap ? behind : first), has_gap};
  }
}

// The median of three medians of three: what stands alone is noise, or an edge's own.
void TissueMap::smooth() {
  const auto place = [&](int row, int a) {
    return static_cast<std::size_t>(std::clamp(row, 0, rows_ - 1) * bricks_.a +
                                    std::clamp(a, 0, bricks_.a - 1));
  };
  const auto middle = [](const Found& one, const Found& two, const Found& three) {
    const auto [low, high] = one.brick < two.brick ? std::pair{one, two} : std::pair{two, one};
    return three.brick < low.brick ? low : three.brick < high.brick ? three : high;
  };
  for (int row = 0; row < rows_; ++row)
    for (int a = 0; a < bricks_.a; ++a)
      along_[place(row, a)] =
          middle(found_[place(row, a - 1)], found_[place(row, a)], found_[place(row, a + 1)]);
  for (int row = 0; row < rows_; ++row)
    for (int a = 0; a < bricks_.a; ++a)
      median_[place(row, a)] =
          middle(along_[place(row - 1, a)], along_[place(row, a)], along_[place(row + 1, a)]);
  for (int row = 0; row < rows_; ++row)
    for (int a = 0; a < bricks_.a; ++a) {
      Brick brick = interpolated(row, a);
      brick.even = is_even(row, a);
      if (brick != smoothed_[place(row, a)])
        changed_[static_cast<std::size_t>(row)] = 1;
      smoothed_[place(row, a)] = brick;
    }
}

bool TissueMap::is_even(int row, int a) const {
  const auto at = [&](int each_row, int each) {
    return median_[static_cast<std::size_t>(std::clamp(each_row, 0, rows_ - 1) * bricks_.a +
                                            std::clamp(each, 0, bricks_.a - 1))];
  };
  const Found here = at(row, a);
  bool even = true;
  for (int i = 0; i < 9; ++i) {
    const Found beside = at(row + i / 3 - 1, a + i % 3 - 1);
    even &=
        beside.behind_gap == here.behind_gap && std::abs(beside.brick - here.brick) <= most_apart;
  }
  return even;
}

TissueMap::Around TissueMap::around(int b, int a) const {
  // Its own brick and the nearer of the two beside it, and that one's share.
  struct Pair {
    int own, other;
    float share;
  };
  const auto pair = [](int at, int size, int count) {
    const int own = at / size;
    const int from_middle = 2 * (at % size) + 1 - size; // in half A-scans or B-scans
    return Pair{own, std::clamp(own + (from_middle < 0 ? -1 : 1), 0, count - 1),
                static_cast<float>(std::abs(from_middle)) / static_cast<float>(2 * size)};
  };
  const Pair rows = pair(b, brick_b_scans, rows_);
  const Pair columns = pair(a, brick_a_scans, bricks_.a);
  Around around{};
  for (std::size_t i = 0; i < around.begins.size(); ++i) {
    const bool beside_row = i >= 2, beside_column = i % 2 == 1;
    const int column = beside_column ? columns.other : columns.own;
    const Brick& brick = smoothed_[static_cast<std::size_t>(
        (beside_row ? rows.other : rows.own) * bricks_.a + column)];
    const int within = std::clamp(a - column * brick_a_scans, 0, brick_a_scans - 1);
    around.begins[i] = {brick.depths[static_cast<std::size_t>(within)], brick.behind_gap};
    around.shares[i] = (beside_row ? rows.share : 1 - rows.share) *
                       (beside_column ? columns.share : 1 - columns.share);
  }
  return around;
}

TissueMap::Brick TissueMap::interpolated(int row, int a) const {
  const auto at = [&](int each) {
    return median_[static_cast<std::size_t>(row * bricks_.a + std::clamp(each, 0, bricks_.a - 1))];
  };
  const Found here = at(a);
  Brick brick{{}, here.behind_gap && here.brick < bricks_.depth, false};
  for (int k = 0; k < brick_a_scans; ++k) {
    const int from_middle = 2 * k + 1 - brick_a_scans; // in half A-scans
    const int apart = at(a + (from_middle < 0 ? -1 : 1)).brick - here.brick;
    int depth = here.brick << pipeline::brick_depth_shift;
    if (std::abs(apart) <= most_apart)
      depth += (apart << pipeline::brick_depth_shift) * std::abs(from_middle) / (2 * brick_a_scans);
    brick.depths[static_cast<std::size_t>(k)] =
        static_cast<std::uint16_t>(std::min(depth, geometry_.depths));
  }
  return brick;
}

void TissueMap::find_extents(std::span<const pipeline::BScanState> states) {
  const auto columns = static_cast<double>(found_.size());
  const auto depths = static_cast<double>(bricks_.depth);
  // A missing B-scan is hatched, not left out.
  for (std::size_t b = 0; b < states.size(); ++b)
    if (states[b] == pipeline::BScanState::missing)
      at_b_[b >> pipeline::brick_b_shift] = static_cast<std::uint32_t>(bricks_.per_b_scan());
  constexpr double least_at_depth = 0.002;
  constexpr double least_across = 0.01;
  extents_ = {section_of(at_depth_, std::max(least_at_depth * columns / depth_sampling, 1.0)),
              section_of(at_a_, least_across * depths * rows_),
              section_of(at_b_, least_across * depths * bricks_.a)};
}

void SteadyCrop::follow(const Crop& needed) {
  constexpr int patience = 20;
  constexpr float least_gain = 2.0F / steps;
  const Crop grown = current_ ? united(*current_, needed) : needed;
  if (current_ != grown) {
    current_ = grown;
    volumes_ = 0;
    return;
  }
  widest_ = volumes_ == 0 ? needed : united(widest_, needed);
  if (++volumes_ < patience)
    return;
  volumes_ = 0;
  for (Section Crop::*side : {&Crop::depth, &Crop::a, &Crop::b})
    if (((*current_).*side).length() - (widest_.*side).length() >= least_gain)
      (*current_).*side = widest_.*side;
}

} // namespace octascope::ui

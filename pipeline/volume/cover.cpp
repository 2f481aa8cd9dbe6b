#include "pipeline/volume/cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

constexpr double gap_mm = 0.25;
constexpr double thickest_mm = 1.5;
constexpr double thinnest_mm = 0.2; // less is a bright line: what a background leaves of a reflex
constexpr int least_tissue_bricks = 2; // below the gap
// Of the layers, those with tissue under them. Between the two the cover is lowered by less, so that
// it does not flicker.
constexpr float doubtful_share = 0.25F;
constexpr float certain_share = 0.45F;
constexpr float smallest_field = 0.1F; // of all columns
constexpr int strong_counts = 24;      // 12 dB above the layers' middle
constexpr int smoothing = 3;           // columns and B-scans to either side
constexpr double bridged_mm = 3;       // at most

using Counts = std::array<std::uint32_t, 256>;

int quantile(std::span<const std::uint32_t> counts, double share) {
  const double rank = share * std::accumulate(counts.begin(), counts.end(), 0.0);
  double sum = 0;
  std::size_t level = 0;
  while (level + 1 < counts.size() && (sum += counts[level]) <= rank)
    ++level;
  return static_cast<int>(level);
}

// Between two columns so many steps apart.
struct Bridge {
  int steps;
  float end;
};

// The level that a brick's brightest voxel exceeds where there is more than noise. The lowest high
// peak of their histogram is the noise's; its lower side shows how far it spreads.
std::uint8_t tissue_level(const Occupancy& occupancy) {
  constexpr std::size_t reach = 8; // counts to either side that a peak stands out from
  Counts counts{};
  for (int b = 0; b < occupancy.geometry().b_scans; ++b)
    for (const std::uint8_t level : occupancy.highest(b))
      ++counts[level];
  counts[0] = 0; // missing B-scans
  const std::uint32_t high = std::max(*std::ranges::max_element(counts) / 4, 1U);
  for (std::size_t noise = 1; noise < counts.size(); ++noise) {
    const std::size_t first = noise > reach ? noise - reach : 0;
    const auto around =
        std::span{counts}.subspan(first, std::min(noise + reach + 1, counts.size()) - first);
    if (counts[noise] < high || counts[noise] < *std::ranges::max_element(around))
      continue;
    const int spread = static_cast<int>(noise) - quantile(std::span{counts}.first(noise + 1), 0.33);
    return static_cast<std::uint8_t>(std::min(static_cast<int>(noise) + 3 * spread + 4, 255));
  }
  return 255;
}

constexpr std::uint8_t byte_of(int value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0, 255));
}

constexpr std::uint8_t least_0(std::uint8_t from, std::uint8_t taken) {
  return static_cast<std::uint8_t>(std::max(from, taken) - taken);
}

// max(level - by, 2 * level - strong), but at most the level and at least 1 of what is not 0. In bytes
// alone, of which a register holds most; `beyond`: what of `strong` is no byte.
OCTASCOPE_CPU_CLONES
void lower(const std::uint8_t* from, std::size_t count, std::uint8_t by, std::uint8_t strong,
           std::uint8_t beyond, std::uint8_t* __restrict to) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t level = from[i];
    const std::uint8_t below = least_0(strong, level);
    const auto to_strong =
        static_cast<std::uint8_t>(below + std::min(beyond, static_cast<std::uint8_t>(255 - below)));
    to[i] =
        std::max({least_0(level, by), least_0(level, to_strong), std::min(level, std::uint8_t{1})});
  }
}

} // namespace

std::optional<Cover::Layer> Cover::layer_in(std::span<const std::uint8_t> column,
                                            std::uint8_t tissue) const {
  const int bricks = static_cast<int>(column.size());
  const auto is_tissue = [&](int z) { return column[static_cast<std::size_t>(z)] > tissue; };
  const double brick_mm = (1 << brick_depth_shift) * geometry_.depth_spacing_um / 1e3;
  Layer layer{0, 0, false};
  int z = 0;
  double mm = 0;
  for (; mm < thinnest_mm && z < bricks; mm = (layer.end - layer.first) * brick_mm) {
    layer.first = z;
    while (layer.first < bricks && !is_tissue(layer.first))
      ++layer.first;
    layer.end = z = layer.first;
    for (; z < bricks && z - layer.end < gap_bricks_; ++z)
      if (is_tissue(z))
        layer.end = z + 1;
  }
  if (mm < thinnest_mm || mm > thickest_mm || z - layer.end < gap_bricks_)
    return std::nullopt;
  for (int run = 0; z < bricks && !layer.covers; ++z) {
    run = is_tissue(z) ? run + 1 : 0;
    layer.covers = run >= least_tissue_bricks;
  }
  return layer;
}

void Cover::find(const Occupancy& occupancy) {
  geometry_ = occupancy.geometry();
  columns_ = occupancy.bricks().a;
  const double brick_mm = (1 << brick_depth_shift) * geometry_.depth_spacing_um / 1e3;
  gap_bricks_ = std::max(static_cast<int>(std::ceil(gap_mm / brick_mm)), 2);
  const std::uint8_t tissue = tissue_level(occupancy);
  const auto depth = static_cast<std::size_t>(occupancy.bricks().depth);
  found_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(geometry_.b_scans),
                {});
  Counts brightest{}; // of the layers' bricks
  std::size_t layers = 0;
  std::size_t covers = 0;
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const auto a = i % static_cast<std::size_t>(columns_);
    const int b = static_cast<int>(i / static_cast<std::size_t>(columns_));
    const auto column = occupancy.highest(b).subspan(a * depth, depth);
    const auto layer = layer_in(column, tissue);
    if (!layer)
      continue;
    for (int z = layer->first; z < layer->end; ++z)
      ++brightest[column[static_cast<std::size_t>(z)]];
    ++layers;
    covers += layer->covers ? 1U : 0U;
    found_[i] = {(static_cast<float>(layer->end) + static_cast<float>(gap_bricks_) / 2) *
                     (1 << brick_depth_shift),
                 1};
  }
  const auto of = [](std::size_t part, std::size_t all) {
    return static_cast<float>(part) / static_cast<float>(std::max<std::size_t>(all, 1));
  };
  share_ =
      of(layers, found_.size()) < smallest_field
          ? 0
          : std::clamp((of(covers, layers) - doubtful_share) / (certain_share - doubtful_share),
                       0.0F, 1.0F);
  strong_ = quantile(brightest, 0.5) + strong_counts;
  if (empty())
    return;
  bridge();
  smooth();
}

// Where an instrument is too near to the layer to leave a gap, the layer goes on between its two sides:
// else a stripe of it would stay opaque, and look like another instrument.
void Cover::bridge() {
  smoothed_ = found_; // as they were told apart
  const double column_mm = (1 << brick_a_shift) * geometry_.a_spacing_um / 1e3;
  const auto across = [&](int b, int a, bool over_b_scans) -> std::optional<Bridge> {
    const int most =
        static_cast<int>(bridged_mm / (over_b_scans ? geometry_.b_spacing_um / 1e3 : column_mm));
    const auto nearest = [&](int direction) -> std::optional<Bridge> {
      for (int steps = 1; steps <= most; ++steps) {
        const int at_b = over_b_scans ? b + direction * steps : b;
        const int at_a = over_b_scans ? a : a + direction * steps;
        if (at_b < 0 || at_b >= geometry_.b_scans || at_a < 0 || at_a >= columns_)
          return std::nullopt;
        const Column& column = smoothed_[static_cast<std::size_t>(at_b * columns_ + at_a)];
        if (column.weight > 0)
          return Bridge{steps, column.end};
      }
      return std::nullopt;
    };
    const auto before = nearest(-1);
    const auto after = before ? nearest(1) : std::nullopt;
    if (!after || before->steps + after->steps > most)
      return std::nullopt;
    const int steps = before->steps + after->steps;
    return Bridge{steps, std::lerp(before->end, after->end,
                                   static_cast<float>(before->steps) / static_cast<float>(steps))};
  };
  for (std::size_t i = 0; i < found_.size(); ++i) {
    if (found_[i].weight > 0)
      continue;
    const int a = static_cast<int>(i) % columns_;
    const int b = static_cast<int>(i) / columns_;
    const auto along = across(b, a, false);
    const auto over = across(b, a, true);
    if (along || over)
      found_[i] = {
          along && (!over || along->steps * column_mm < over->steps * geometry_.b_spacing_um / 1e3)
              ? along->end
              : over->end,
          1};
  }
}

// Where more than half of the neighbours have a layer, all of it is lowered.
void Cover::smooth() {
  smoothed_.resize(found_.size());
  const auto row = [&](int b) {
    return std::span{found_}.subspan(
        static_cast<std::size_t>(columns_) *
            static_cast<std::size_t>(std::clamp(b, 0, geometry_.b_scans - 1)),
        static_cast<std::size_t>(columns_));
  };
  constexpr float neighbours = (2 * smoothing + 1) * (2 * smoothing + 1);
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const int a = static_cast<int>(i) % columns_;
    const int b = static_cast<int>(i) / columns_;
    Column sum;
    for (int near_b = b - smoothing; near_b <= b + smoothing; ++near_b)
      for (int near_a = a - smoothing; near_a <= a + smoothing; ++near_a) {
        const Column& near =
            row(near_b)[static_cast<std::size_t>(std::clamp(near_a, 0, columns_ - 1))];
        sum.end += near.end;
        sum.weight += near.weight;
      }
    smoothed_[i] = sum.weight > 0
                       ? Column{sum.end / sum.weight, std::min(2 * sum.weight / neighbours, 1.0F)}
                       : Column{};
  }
}

Cover::Column Cover::at(int b, float a) const {
  const float column = (a + 1) / (1 << brick_a_shift) - 0.5F;
  const int left = std::clamp(static_cast<int>(column), 0, columns_ - 1);
  const auto near = [&](int side) {
    return smoothed_[static_cast<std::size_t>(b) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(std::min(side, columns_ - 1))];
  };
  const Column l = near(left);
  const Column r = near(left + 1);
  const float share = std::clamp(column - static_cast<float>(left), 0.0F, 1.0F);
  return {std::lerp(l.weight > 0 ? l.end : r.end, r.weight > 0 ? r.end : l.end, share),
          std::lerp(l.weight, r.weight, share)};
}

float Cover::share_at(const std::array<float, 3>& place_mm) const noexcept {
  if (empty())
    return 0;
  const auto voxel = [&](std::size_t axis, double spacing_um) {
    return static_cast<float>(static_cast<double>(place_mm[axis]) * 1e3 / spacing_um) - 0.5F;
  };
  const auto b = static_cast<int>(std::lround(voxel(2, geometry_.b_spacing_um)));
  const Column column =
      at(std::clamp(b, 0, geometry_.b_scans - 1), voxel(1, geometry_.a_spacing_um));
  return voxel(0, geometry_.depth_spacing_um) < column.end ? share_ * column.weight : 0;
}

void Cover::weaken(int b, std::span<const std::uint8_t> levels, float counts,
                   std::span<std::uint8_t> to) const noexcept {
  const auto depths = static_cast<std::size_t>(geometry_.depths);
  for (int a = 0; a < geometry_.a_scans; ++a) {
    const std::size_t first = static_cast<std::size_t>(a) * depths;
    const Column column = at(b, static_cast<float>(a));
    const auto end = std::min(static_cast<std::size_t>(column.end), depths);
    lower(levels.data() + first, end,
          byte_of(static_cast<int>(std::lround(counts * share_ * column.weight))), byte_of(strong_),
          byte_of(strong_ - 255), to.data() + first);
    std::copy_n(levels.data() + first + end, depths - end, to.data() + first + end);
  }
}

} // namespace octascope::pipeline

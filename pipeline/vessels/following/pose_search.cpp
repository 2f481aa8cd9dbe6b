#include "pipeline/vessels/following/pose_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "pipeline/vessels/vectors.h"

namespace octascope::pipeline {

namespace {

constexpr double cell_mm = 0.075;
constexpr double turn_step_deg = 7;
constexpr double near_mm = 0.16; // a coarse pose is off by so much at the field's edge
constexpr double near_cosine =
    0.77; // 40 degrees: half a step of turns, and what directions are off
constexpr std::size_t most_samples = 128;
constexpr std::size_t most_candidates = 96;
constexpr int most_score = 255;

// Half of the directions to a cube's neighbours: a vessel has no sign.
constexpr std::size_t directions = 13;
std::array<Point, directions> make_directions() {
  std::array<Point, directions> made{};
  std::size_t count = 0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (z > 0 || (z == 0 && (y > 0 || (y == 0 && x > 0))))
          made[count++] = direction(Point{double(x), double(y), double(z)});
  return made;
}
const std::array<Point, directions> direction_of = make_directions();

std::size_t nearest_direction(const Point& along) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t d = 0; d < directions; ++d)
    if (const double cosine = std::fabs(product(along, direction_of[d])); cosine > most) {
      most = cosine;
      best = d;
    }
  return best;
}

// How near the next planned vessel is, by direction: [direction][z][y][x].
class NearnessGrid {
public:
  NearnessGrid(std::span<const TreeSample> planned, const PointBox& box) : origin_{box.lower} {
    for (std::size_t axis = 0; axis < 3; ++axis)
      cells_[axis] = 2 + static_cast<int>((box.upper[axis] - box.lower[axis]) / cell_mm);
    nearness_.resize(directions * plane() * static_cast<std::size_t>(cells_[2]) + row_padding);
    for (const TreeSample& sample : planned)
      add(sample);
  }

  // Of the cell that `at`, within the box, lies in.
  std::size_t index_of(const Point& at, std::size_t d) const {
    std::array<std::size_t, 3> cell{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      cell[axis] = static_cast<std::size_t>((at[axis] - origin_[axis]) / cell_mm);
    return ((d * static_cast<std::size_t>(cells_[2]) + cell[2]) *
                static_cast<std::size_t>(cells_[1]) +
            cell[1]) *
               static_cast<std::size_t>(cells_[0]) +
           cell[0];
  }
  const std::uint8_t* at(std::size_t index) const { return nearness_.data() + index; }
  std::ptrdiff_t offset(int y, int z) const {
    return (static_cast<std::ptrdiff_t>(z) * cells_[1] + y) * cells_[0];
  }

  static constexpr std::size_t row_padding = 64; // rows are read in blocks

private:
  std::size_t plane() const {
    return static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]);
  }

  void add(const TreeSample& sample) {
    std::array<bool, directions> alike{};
    for (std::size_t d = 0; d < directions; ++d)
      alike[d] = std::fabs(product(sample.along, direction_of[d])) > near_cosine;
    std::array<int, 3> low{}, high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at = (sample.at[axis] - origin_[axis]) / cell_mm;
      low[axis] = std::max(0, static_cast<int>(std::floor(at - near_mm / cell_mm)));
      high[axis] = std::min(cells_[axis] - 1, static_cast<int>(at + near_mm / cell_mm));
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) {
          const Point centre{origin_[0] + (x + 0.5) * cell_mm, origin_[1] + (y + 0.5) * cell_mm,
                             origin_[2] + (z + 0.5) * cell_mm};
          const Point away = difference(centre, sample.at);
          const double share = 1 - product(away, away) / (near_mm * near_mm);
          if (share <= 0)
            continue;
          const auto score = static_cast<std::uint8_t>(most_score * share);
          for (std::size_t d = 0; d < directions; ++d)
            if (alike[d]) {
              std::uint8_t& cell = nearness_[index_of(centre, d)];
              cell = std::max(cell, score);
            }
        }
  }

  Point origin_;
  std::array<int, 3> cells_{};
  std::vector<std::uint8_t> nearness_;
};

std::vector<TreeSample> thinned(std::span<const TreeSample> samples) {
  std::vector<TreeSample> few;
  const std::size_t count = std::min(samples.size(), most_samples);
  for (std::size_t i = 0; i < count; ++i)
    few.push_back(samples[i * samples.size() / count]);
  return few;
}

// Turns on a cubic lattice of rotation vectors, within a ball.
std::vector<Point> turns_within(double reach_deg) {
  const int steps = static_cast<int>(std::ceil(reach_deg / turn_step_deg));
  const double step_rad = turn_step_deg * std::numbers::pi / 180;
  const double farthest = reach_deg / turn_step_deg + 0.5;
  std::vector<Point> turns;
  for (int z = -steps; z <= steps; ++z)
    for (int y = -steps; y <= steps; ++y)
      for (int x = -steps; x <= steps; ++x)
        if (x * x + y * y + z * z <= farthest * farthest)
          turns.push_back({x * step_rad, y * step_rad, z * step_rad});
  return turns;
}

struct Candidate {
  int score = 0;
  Point turn_rad{};
  Point shift_mm{};
};

// The best, kept while more come.
class BestCandidates {
public:
  int least() const { return kept_.size() < most_candidates ? 0 : kept_.front().score; }
  void add(const Candidate& candidate) {
    if (kept_.size() == most_candidates) {
      std::ranges::pop_heap(kept_, std::ranges::greater{}, &Candidate::score);
      kept_.pop_back();
    }
    kept_.push_back(candidate);
    std::ranges::push_heap(kept_, std::ranges::greater{}, &Candidate::score);
  }
  std::vector<Candidate> take() {
    std::ranges::stable_sort(kept_, std::ranges::greater{}, &Candidate::score);
    return std::move(kept_);
  }

private:
  std::vector<Candidate> kept_; // a heap, the worst first
};

// Scores of all shifts, [z][y][x], for one turn.
class ShiftScores {
public:
  explicit ShiftScores(double reach_mm)
      : steps_{static_cast<int>(std::ceil(reach_mm / cell_mm))}, side_{2 * steps_ + 1},
        width_{(side_ + block - 1) / block * block},
        scores_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(side_) *
                static_cast<std::size_t>(side_)) {}

  int steps() const { return steps_; }

  void compute(const NearnessGrid& grid, std::span<const std::size_t> samples) {
    for (int z = -steps_; z <= steps_; ++z)
      for (int y = -steps_; y <= steps_; ++y)
        for (int x = 0; is_within(0, y, z) && x < width_; x += block) {
          std::array<std::uint16_t, block> sums{};
          const std::ptrdiff_t shift = grid.offset(y, z) - steps_ + x;
          for (const std::size_t sample : samples) {
            const std::uint8_t* row = grid.at(sample) + shift;
            for (int i = 0; i < block; ++i)
              sums[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(
                  sums[static_cast<std::size_t>(i)] + row[static_cast<std::size_t>(i)]);
          }
          std::ranges::copy(sums, scores_.begin() + index(x - steps_, y, z));
        }
  }

  // Where all neighbours along the axes are no better, within the reach's ball.
  void add_peaks(const Point& turn_rad, BestCandidates& best) const {
    for (int z = -steps_; z <= steps_; ++z)
      for (int y = -steps_; y <= steps_; ++y)
        for (int x = -steps_; x <= steps_; ++x)
          if (const int score = at(x, y, z);
              score > best.least() && is_within(x, y, z) && is_peak(x, y, z, score))
            best.add({score, turn_rad, {x * cell_mm, y * cell_mm, z * cell_mm}});
  }

private:
  static constexpr int block = 32;

  std::ptrdiff_t index(int x, int y, int z) const {
    return (static_cast<std::ptrdiff_t>(z + steps_) * side_ + y + steps_) * width_ + x + steps_;
  }
  bool is_within(int x, int y, int z) const { return x * x + y * y + z * z <= steps_ * steps_; }
  int at(int x, int y, int z) const {
    if (!is_within(0, y, z) || std::abs(x) > steps_)
      return 0;
    return scores_[static_cast<std::size_t>(index(x, y, z))];
  }
  bool is_peak(int x, int y, int z, int score) const {
    return at(x - 1, y, z) < score && at(x + 1, y, z) <= score && at(x, y - 1, z) < score &&
           at(x, y + 1, z) <= score && at(x, y, z - 1) < score && at(x, y, z + 1) <= score;
  }

  int steps_, side_, width_;
  std::vector<std::uint16_t> scores_;
};

} // namespace

RigidTransform turned_about(const Point& middle, const Point& turn_rad, const Point& shift_mm) {
  const double angle = length(turn_rad);
  const Point axis = direction(turn_rad);
  const double s = std::sin(angle), c = std::cos(angle);
  RigidTransform turned;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      turned.rotation[row][column] = (row == column ? c : 0) + (1 - c) * axis[row] * axis[column];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    turned.rotation[k][j] += s * axis[i];
    turned.rotation[j][k] -= s * axis[i];
  }
  turned.shift_mm = {};
  turned.shift_mm = sum(sum(middle, shift_mm), scaled(turned.apply(middle), -1));
  return turned;
}

std::vector<RigidTransform> search_poses(std::span<const TreeSample> planned,
                                         std::span<const TreeSample> live, const Point& middle,
                                         const PoseReach& reach) {
  const std::vector<TreeSample> few = thinned(live);
  const std::vector<Point> turns = turns_within(reach.turn_deg);
  ShiftScores scores{reach.shift_mm};
  // All that is within reach: where samples may come to lie after any turn, and any shift.
  PointBox box{middle, middle};
  for (const Point& turn : turns) {
    const RigidTransform turned = turned_about(middle, turn, {});
    for (const TreeSample& sample : few) {
      const Point at = turned.apply(sample.at);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min(box.lower[axis], at[axis]);
        box.upper[axis] = std::max(box.upper[axis], at[axis]);
      }
    }
  }
  const NearnessGrid grid{planned, box.grown((scores.steps() + 1) * cell_mm)};

  BestCandidates best;
  std::vector<std::size_t> cells(few.size());
  for (const Point& turn : turns) {
    const RigidTransform turned = turned_about(middle, turn, {});
    for (std::size_t i = 0; i < few.size(); ++i) {
      Point along{};
      for (std::size_t row = 0; row < 3; ++row)
        along[row] = product(turned.rotation[row], few[i].along);
      cells[i] = grid.index_of(turned.apply(few[i].at), nearest_direction(along));
    }
    scores.compute(grid, cells);
    scores.add_peaks(turn, best);
  }
  std::vector<RigidTransform> poses;
  for (const Candidate& candidate : best.take())
    poses.push_back(turned_about(middle, candidate.turn_rad, candidate.shift_mm));
  return poses;
}

} // namespace octascope::pipeline

#include "pipeline/vessels/centrelines/centreline_pieces.h"

#include <algorithm>

namespace octascope::pipeline {
namespace {

// The ways between two points of lines, each once and in one direction.
class PointLinks {
public:
  explicit PointLinks(const Centrelines& lines) : degrees_(lines.positions_mm.size(), 0) {
    std::vector<std::uint8_t> used(lines.positions_mm.size(), 0);
    for (const std::uint64_t point : lines.points)
      shared_ = shared_ || used[point]++ > 0;
    if (!shared_)
      return; // each point has one line
    std::uint64_t begin = 0;
    for (const std::uint64_t end : lines.ends) {
      for (std::uint64_t i = begin + 1; i < end; ++i)
        if (lines.points[i - 1] != lines.points[i])
          links_.push_back(key_of(lines.points[i - 1], lines.points[i]));
      begin = end;
    }
    std::ranges::sort(links_);
    links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
    taken_.assign(links_.size(), false);
    for (const std::uint64_t link : links_) {
      degrees_[link >> 32] = static_cast<std::uint8_t>(std::min(degrees_[link >> 32] + 1, 3));
      auto& other = degrees_[link & 0xFFFFFFFF];
      other = static_cast<std::uint8_t>(std::min(other + 1, 3));
    }
  }

  bool is_fork(std::uint64_t point) const { return degrees_[point] > 2; }

  // False where it was taken before, and from a point to itself.
  bool take(std::uint64_t from, std::uint64_t to) {
    if (from == to)
      return false;
    if (!shared_)
      return true;
    const auto link = static_cast<std::size_t>(std::ranges::lower_bound(links_, key_of(from, to)) -
                                               links_.begin());
    const bool fresh = !taken_[link];
    taken_[link] = true;
    return fresh;
  }

private:
  static std::uint64_t key_of(std::uint64_t a, std::uint64_t b) {
    return std::min(a, b) << 32 | std::max(a, b);
  }

  bool shared_ = false;
  std::vector<std::uint64_t> links_; // both numbers in one, sorted
  std::vector<bool> taken_;
  std::vector<std::uint8_t> degrees_; // 3: or more
};

} // namespace

CentrelinePieces::CentrelinePieces(const Centrelines& lines) {
  PointLinks links{lines};
  points_.reserve(lines.points.size());
  std::uint64_t begin = 0;
  for (const std::uint64_t end : lines.ends) {
    for (std::uint64_t i = begin + 1; i < end; ++i) {
      const std::uint64_t from = lines.points[i - 1];
      const std::uint64_t to = lines.points[i];
      if (!links.take(from, to)) {
        if (from != to)
          end_piece(lines);
        continue;
      }
      const std::uint64_t open = points_.size() - (ends_.empty() ? 0 : ends_.back());
      if (open == 0)
        points_.push_back(from);
      points_.push_back(to);
      if (links.is_fork(to))
        end_piece(lines);
    }
    end_piece(lines);
    begin = end;
  }
}

// What has no length is left out.
void CentrelinePieces::end_piece(const Centrelines& lines) {
  const std::uint64_t begin = ends_.empty() ? 0 : ends_.back();
  const auto piece = std::span{points_}.subspan(begin);
  const bool long_enough = std::ranges::any_of(piece, [&](std::uint64_t point) {
    return lines.positions_mm[point] != lines.positions_mm[piece.front()];
  });
  if (long_enough)
    ends_.push_back(points_.size());
  else
    points_.resize(begin);
}

} // namespace octascope::pipeline

// The ends of lines: which of them lie at the same place, and which on another line.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/vessels/centrelines/centreline_joiner.h"
#include "pipeline/vessels/centrelines/centreline_pieces.h"

namespace octascope::pipeline {

// An end belongs to another line, or to its end, if it is nearer than this part of the smaller
// radius.
inline constexpr double end_within_radii = 0.1;

// End 2·n is where piece n begins, end 2·n + 1 where it ends.
class LineEnds {
public:
  struct OnLine {
    std::uint32_t piece;
    std::uint64_t point; // where the segment begins
    double distance_mm;
    double within_mm; // that point and this place are no farther apart, along the line
  };

  LineEnds(const Centrelines& lines, const CentrelinePieces& pieces, double precision);

  std::size_t groups() const { return on_line_.size(); }
  // Ends at the same place form a group.
  std::uint32_t group_of(std::uint32_t end) const { return group_[end]; }
  // Only determined if groups alone do not join all pieces.
  const std::optional<OnLine>& on_line(std::uint32_t group) const { return on_line_[group]; }
  // Pieces in the file's order, except that a piece on which another one ends comes before it.
  std::vector<std::uint32_t> in_order() const;

private:
  std::uint64_t point_at(std::uint32_t end) const {
    const auto piece = pieces_[end / 2];
    return end % 2 == 0 ? piece.front() : piece.back();
  }
  double reach_of(std::uint64_t point) const;
  void gather_groups();
  bool all_joined() const;
  void find_on_lines();

  const Centrelines& lines_;
  const CentrelinePieces& pieces_;
  double precision_;
  std::vector<std::uint32_t> group_;          // by end
  std::vector<std::uint32_t> representative_; // by group: its first end
  std::vector<std::optional<OnLine>> on_line_;
};

} // namespace octascope::pipeline

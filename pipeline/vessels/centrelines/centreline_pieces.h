// Cuts lines where they share points (the same indices) and drops what is there twice, so that two
// pieces share no points except their ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/vessels/centrelines/centreline_joiner.h"

namespace octascope::pipeline {

class CentrelinePieces {
public:
  explicit CentrelinePieces(const Centrelines& lines);

  std::size_t size() const { return ends_.size(); }
  std::span<const std::uint64_t> operator[](std::size_t piece) const {
    const std::uint64_t begin = piece == 0 ? 0 : ends_[piece - 1];
    return std::span{points_}.subspan(begin, ends_[piece] - begin);
  }

private:
  void end_piece(const Centrelines& lines);

  std::vector<std::uint64_t> points_; // of all pieces, one after the other
  std::vector<std::uint64_t> ends_;   // of each: one past its last
};

} // namespace octascope::pipeline

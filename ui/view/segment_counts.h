// What became of a vessel tree's segments.
#pragma once

#include <cstdint>

namespace octascope::ui {

// Counts of one frame; they add up to the tree's segments.
struct SegmentCounts {
  std::uint64_t drawn = 0;    // by GL
  std::uint64_t splatted = 0; // by the processor, pixel by pixel
  std::uint64_t merged = 0;   // represented by others that were drawn in their place
  std::uint64_t culled = 0;   // outside the picture
  std::uint64_t total() const { return drawn + splatted + merged + culled; }
  bool operator==(const SegmentCounts&) const = default;
};

} // namespace octascope::ui

// Where the segments of a vessel tree went.
#pragma once

#include <cstdint>

namespace octascope::ui {

// Where the segments of one frame went; they add up to the tree's.
struct SegmentCounts {
  std::uint64_t drawn = 0;    // by GL
  std::uint64_t splatted = 0; // by the processor, pixel by pixel
  std::uint64_t merged = 0;   // represented by others that were drawn in their place
  std::uint64_t culled = 0;   // outside the picture
  std::uint64_t total() const { return drawn + splatted + merged + culled; }
  bool operator==(const SegmentCounts&) const = default;
};

} // namespace octascope::ui

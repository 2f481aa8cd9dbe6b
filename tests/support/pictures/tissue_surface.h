// Where the real tissue (data/sd-oct-tissue, 100 × 100 × 1024) begins.
#pragma once

#include <cstddef>
#include <vector>

namespace octascope::tests {

// The mean profile of ten A-scans of B-scan `b` first exceeds −5 dB here, behind the background's
// remains; −1 where it never does.
inline int tissue_surface(const std::vector<float>& levels_db, std::size_t b, std::size_t first_a) {
  for (std::size_t z = 10; z < 500; ++z) {
    float sum = 0;
    for (std::size_t a = first_a; a < first_a + 10; ++a)
      sum += levels_db[(b * 100 + a) * 512 + z];
    if (sum > -50)
      return static_cast<int>(z);
  }
  return -1;
}

} // namespace octascope::tests

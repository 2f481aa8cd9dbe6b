#include "ui/panels/projection.h"

#include <algorithm>

namespace octascope::ui {

void project_maximum(const pipeline::Volume& volume, std::span<std::uint8_t> out) {
  const auto depths = static_cast<std::size_t>(volume.geometry.depths);
  const std::uint8_t* line = volume.levels.data();
  for (std::uint8_t& highest : out) {
    std::uint8_t level = 0; // in a register, so that the loop becomes vector instructions
    for (std::size_t z = 0; z < depths; ++z)
      level = std::max(level, line[z]);
    highest = level;
    line += depths;
  }
}

} // namespace octascope::ui

#include "ui/transfer/visible_levels.h"

#include <algorithm>
#include <cstddef>

namespace octascope::ui {

bool VisibleLevels::empty(int lowest_level, int highest_level) const {
  constexpr int per_level = TransferTable::entries_per_level;
  const int first = std::max(lowest_level * per_level - margin, 0);
  const int last = std::min(highest_level * per_level + margin, TransferTable::entries - 1);
  return before[static_cast<std::size_t>(last) + 1] == before[static_cast<std::size_t>(first)];
}

void find_visible_levels(const TransferTable& transfer, VisibleLevels& levels) {
  std::uint16_t visible = 0;
  for (std::size_t i = 0; i < TransferTable::entries; ++i) {
    levels.before[i] = visible;
    visible = static_cast<std::uint16_t>(visible + (transfer.opacity[i] > 0 ? 1 : 0));
  }
  levels.before[TransferTable::entries] = visible;
}

} // namespace octascope::ui

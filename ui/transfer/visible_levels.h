// Which levels a transfer function shows at all.
#pragma once

#include <array>
#include <cstdint>

#include "ui/transfer/transfer_table.h"

namespace octascope::ui {

struct VisibleLevels {
  // The number of visible entries before each entry: a range without any is empty.
  std::array<std::uint16_t, TransferTable::entries + 1> before{};
  // Adjacent entries that count as well, for users that interpolate between entries.
  int margin = 0;

  bool empty(int lowest_level, int highest_level) const;
};

void find_visible_levels(const TransferTable& transfer, VisibleLevels& levels);

} // namespace octascope::ui

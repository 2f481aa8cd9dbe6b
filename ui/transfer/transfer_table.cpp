#include "ui/transfer/transfer_table.h"

#include <algorithm>
#include <cstddef>

namespace octascope::ui {

void make_window_table(const ViewState& view, TransferTable& table) {
  const WindowRamp window = window_ramp(view);
  for (std::size_t i = 0; i < TransferTable::entries; ++i) {
    const float level = static_cast<float>(i) / TransferTable::entries_per_level;
    const float grey = std::clamp(level / 255 * window.scale + window.offset, 0.0F, 1.0F);
    table.colour[i] = {grey, grey, grey};
    table.opacity[i] = grey * view.opacity;
  }
  table.depths.reset();
  table.window = TransferTable::Window{window, view.opacity};
}

} // namespace octascope::ui

// Closes a window of an X server as the close button of its frame would.
#pragma once

#include <cstdint>
#include <string>

namespace octascope::tests {

// Sends WM_DELETE_WINDOW to `window` of the local X server with this DISPLAY (":5"). Speaks the X
// protocol itself: a window manager, who would send it, is not at hand. Empty, or what failed.
std::string close_window(const std::string& display, std::uint32_t window);

} // namespace octascope::tests

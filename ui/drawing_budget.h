// How finely the volume can be drawn at the pace of live volumes.
#pragma once

namespace octascope::ui {

// The share of the display's resolution, per axis, for the volume's picture. A GPU draws all
// pixels. On the processor, sampling the volume is the cost, and it grows with the pixels: there
// the picture gets about as many as a 640×360 display has, which two cores draw in some 30 ms, and
// is enlarged smoothly. Text, panels and lines are never reduced.
float affordable_resolution(bool software, int width, int height);

} // namespace octascope::ui

// Stereo displays: the part of the framebuffer that each eye sees. Pure.
//
// Full-frame packing for heads-up 3D displays (HDMI 1.4a, "side-by-side (half)" and
// "top-and-bottom"): each eye's whole picture at half the width or height, which the display
// stretches again. The left eye's picture is at the left or at the top.
#pragma once

#include <span>

#include "ui/layout/layout.h"
#include "ui/view/camera.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Left eye first; without stereo, only StereoEye::centre.
std::span<const StereoEye> eyes_of(StereoMode mode);

// Where a picture laid out on width × height pixels goes in a framebuffer of that size.
struct EyeFrame {
  Rect target; // of the whole layout
  int width = 0;
  int height = 0;

  // Maps a rectangle of the layout into the target. For both eyes the same, relative to their
  // targets. Never empty.
  Rect place(const Rect& rect) const;
};

EyeFrame eye_frame(StereoMode mode, StereoEye eye, int width, int height);

} // namespace octascope::ui

// Stereo displays: which part of the framebuffer each eye sees. Pure.
//
// Full-frame packing as heads-up 3D displays take it (HDMI 1.4a, "side-by-side (half)" and
// "top-and-bottom"): each eye's whole picture at half the width or half the height, which the
// display stretches again. The left eye's is at the left or at the top.
#pragma once

#include <span>

#include "ui/layout/layout.h"
#include "ui/view/camera.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Left first; without stereo, StereoEye::centre.
std::span<const StereoEye> eyes_of(StereoMode mode);

// Maps a picture laid out on width × height pixels into a framebuffer of that size.
struct EyeFrame {
  Rect target; // of the whole layout
  int width = 0;
  int height = 0;

  // The place of a rectangle of the layout; the same for both eyes but for the targets' offset.
  // Never empty.
  Rect place(const Rect& rect) const;
};

EyeFrame eye_frame(StereoMode mode, StereoEye eye, int width, int height);

} // namespace octascope::ui

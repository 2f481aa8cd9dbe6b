// The colour space OKLab: equal distances look alike, and L is the perceived lightness. Source: B.
// Ottosson, "A perceptual color space for image processing" (2020); sRGB's transfer curve from IEC
// 61966-2-1.
#pragma once

#include "ui/transfer/transfer_table.h"

namespace octascope::ui {

// L from 0 (black) to 1 (white); a from green to red, b from blue to yellow.
struct Oklab {
  float lightness = 0;
  float a = 0;
  float b = 0;
};

// Colours are sRGB as the display takes it; those outside its gamut lie beyond 0…1.
TransferTable::Colour to_srgb(const Oklab& lab);
Oklab to_oklab(const TransferTable::Colour& srgb);

} // namespace octascope::ui

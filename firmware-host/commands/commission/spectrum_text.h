// A spectrum for people: a strip of text, figures, and a picture.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "firmware-host/commands/commission/live_look.h"
#include "firmware-host/commands/commission/session.h"
#include "pipeline/files/png_image.h"
#include "ui/spectrum_screen.h"

namespace octascope::firmware_host {

// 24 letters, each as high as the mean of its pixels: from a blank (0) to a full block (`highest`).
std::string spectrum_strip(std::span<const double> line, double highest);

// Less is hardly a mirror's fringe: noise alone gives about 1 %.
inline constexpr double least_mirror_contrast = 0.05;

// Saturation, brightness, dark level, contrast, frames; warns of too little light, of too much, and of
// lost frames.
void add_quality(StepRecord& record, const LiveLook& look);

// The same for the display, each with what is good, and what helps.
std::vector<ui::SpectrumFigure> figures_of(const LiveLook& look);
// Warns where the arms interfere less than they should, with a mirror.
void warn_of_contrast(StepRecord& record, const pipeline::SpectrumQuality& quality);

// "62 % of full scale (2539 of 4095 counts)"
std::string brightness_text(const LiveLook& look);

// The mean line, and one line behind it; the axis reaches full scale.
pipeline::Image draw_spectrum(const std::vector<double>& mean, const std::vector<double>& one,
                              double full_scale);

} // namespace octascope::firmware_host

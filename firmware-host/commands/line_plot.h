// Plots curves on axes into an RGB picture, labelled in small capital letters.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/files/png_image.h"

namespace octascope::firmware_host {

using Colour = std::array<std::uint8_t, 3>;

struct PlotCurve {
  std::vector<double> values; // value i at x = i·PlotPanel::x_step
  Colour colour{};
  std::string name;
};

struct PlotPanel {
  std::string title; // capitals, digits and . , - : ( ) / +; other characters stay blank
  std::vector<PlotCurve> curves;
  double x_step = 1;
  double x_last = 1; // axis from 0 to here
  double y_low = 0;
  double y_high = 1;
};

struct Box {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

// Draws frame, grid with numbers, curves and their names inside `box`, which must lie in the
// picture.
void draw_panel(pipeline::Image& image, const Box& box, const PlotPanel& panel);

// One line of text from (x, y), its upper left corner; letters are 8 pixels apart and 10 high.
void draw_text(pipeline::Image& image, int x, int y, std::string_view text, Colour colour);

} // namespace octascope::firmware_host

// Colours by position in the display window.
#pragma once

#include <string>
#include <vector>

#include "ui/transfer/transfer_table.h"

namespace octascope::ui {

// Immutable. Any thread.
class ColourMap {
public:
  // At least two colours, evenly spread over the window; linear between them.
  ColourMap(std::string name, std::vector<TransferTable::Colour> samples);

  // Black to white: grey = u, formula (1) of the OCT paper.
  static ColourMap grey();
  // Made in OKLab (ui/transfer/oklab.h): lightness rises linearly with u, so that equal steps of
  // level look equal and brighter always means more, also in black and white and for colour-blind
  // people.
  static ColourMap amber();      // one hue, warm
  static ColourMap blue_green(); // one hue, cool
  static ColourMap dawn();       // violet, red, yellow: distinguishes the most levels

  // Grey by level; the hue is that of the depth (depth_colours.h).
  static ColourMap depth();

  bool by_depth() const { return by_depth_; }
  const std::string& name() const { return name_; }
  // u is clamped to 0…1.
  TransferTable::Colour at(float u) const;

private:
  std::string name_;
  std::vector<TransferTable::Colour> samples_;
  bool by_depth_ = false;
};

} // namespace octascope::ui

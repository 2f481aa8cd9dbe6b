// Colours by place in the display window.
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

  // Black to white: grey = u, the paper's formula (1).
  static ColourMap grey();
  // Made in OKLab (ui/transfer/oklab.h): lightness rises linearly with u, so that equal steps of
  // the level look alike and brighter always means more, also in black and white and to the
  // colour-blind.
  static ColourMap amber();      // one hue, warm
  static ColourMap blue_green(); // one hue, cool
  static ColourMap dawn();       // violet, red, yellow: distinguishes the most levels

  const std::string& name() const { return name_; }
  // u is clamped to 0…1.
  TransferTable::Colour at(float u) const;

private:
  std::string name_;
  std::vector<TransferTable::Colour> samples_;
};

} // namespace octascope::ui

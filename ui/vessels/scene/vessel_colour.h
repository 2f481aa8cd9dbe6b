// The colour of a vessel. Pure.
#pragma once

#include <cstddef>

#include "ui/view/vessel_look.h"

namespace octascope::ui {

// `diagnostic`: of who draws it.
inline VesselColour colour_of(VesselColouring colouring, std::size_t branch, std::size_t order,
                              const VesselColour& diagnostic) {
  switch (colouring) {
  case VesselColouring::branch: return branch_colours[branch];
  case VesselColouring::order: return order_colours[order];
  case VesselColouring::diagnostic: break;
  }
  return diagnostic;
}

} // namespace octascope::ui

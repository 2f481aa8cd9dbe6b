// From where tests look at the volume.
#pragma once

#include "ui/view/view_state.h"

namespace octascope::tests {

struct Place {
  const char* name;
  float yaw_deg;
  float tilt_deg;
  float distance;
};
inline constexpr Place places[] = {{"oblique", 35, 35, 3.1F},
                                   {"behind", 180, 20, 2.5F},
                                   {"along the slow axis", 0, 0, 2.5F},
                                   {"along the fast axis", 90, 0, 2.5F},
                                   {"from above", 0, 89, 2.5F},
                                   {"from below", 20, -60, 2.5F},
                                   {"grazing", 45, 0.5F, 2},
                                   {"inside", 30, 25, 0.6F}};

inline ui::ViewState view_from(const Place& place, float opacity) {
  ui::ViewState view;
  view.yaw_deg = place.yaw_deg;
  view.tilt_deg = place.tilt_deg;
  view.distance = place.distance;
  view.opacity = opacity;
  return view;
}

} // namespace octascope::tests

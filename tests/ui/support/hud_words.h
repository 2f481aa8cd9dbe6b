// The words of a display's badges and troubles, and a view with its figures.
#pragma once

#include <string>
#include <vector>

#include "ui/hud/hud.h"

namespace octascope::tests {

inline std::vector<std::string> badges_of(const ui::Status& status) {
  const ui::HudText hud = ui::compose_hud_text({}, status, {});
  std::vector<std::string> words;
  for (std::size_t i = 0; i < hud.badge_count; ++i)
    words.emplace_back(hud.badges[i].text.view());
  return words;
}

inline std::vector<std::string> troubles_of(const ui::Status& status) {
  const ui::HudText hud = ui::compose_hud_text({}, status, {});
  std::vector<std::string> words;
  for (std::size_t i = 0; i < hud.trouble_count; ++i)
    words.emplace_back(hud.troubles[i].words.view());
  return words;
}

inline ui::ViewState with_figures() {
  ui::ViewState view;
  view.figures = ui::FiguresShown::strip;
  return view;
}

} // namespace octascope::tests

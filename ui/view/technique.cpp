#include "ui/view/technique.h"

namespace octascope::ui {

std::string_view to_string(Technique technique) {
  switch (technique) {
  case Technique::slices: return "slices";
  case Technique::planes: return "planes";
  case Technique::rays: return "rays";
  case Technique::shaded: return "shaded";
  case Technique::maximum: return "maximum";
  case Technique::surface: return "surface";
  }
  return "rays";
}

std::optional<Technique> technique_named(std::string_view name) {
  for (const Technique technique : all_techniques)
    if (to_string(technique) == name)
      return technique;
  return std::nullopt;
}

} // namespace octascope::ui

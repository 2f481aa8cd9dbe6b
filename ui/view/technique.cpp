#include "ui/view/technique.h"

#include "ui/view/choice_value.h"

namespace octascope::ui {

static_assert(technique_values.size() == all_techniques.size());

std::string_view to_string(Technique technique) {
  return technique_values[static_cast<std::size_t>(technique)].name;
}

std::optional<Technique> technique_named(std::string_view name) {
  for (const Technique technique : all_techniques)
    if (to_string(technique) == name)
      return technique;
  return std::nullopt;
}

} // namespace octascope::ui

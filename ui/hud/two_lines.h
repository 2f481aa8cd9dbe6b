// Breaks text between words into two lines if it does not fit on one.
#pragma once

#include <string_view>

namespace octascope::ui {

struct TwoLines {
  std::string_view first;
  std::string_view second; // empty: one line is enough
};

// Pure. `width` must grow with the text and use the unit of `most`. A line is wider than `most` if
// the first word alone does not fit, or if the text is too long for two lines.
template <class Width>
TwoLines break_to_fit(std::string_view words, float most, const Width& width) {
  std::size_t end = words.size();
  while (width(words.substr(0, end)) > most) {
    const std::size_t space = words.rfind(' ', end - 1);
    if (space == std::string_view::npos || space == 0)
      return {words, {}};
    end = space;
  }
  return end == words.size() ? TwoLines{words, {}}
                             : TwoLines{words.substr(0, end), words.substr(end + 1)};
}

} // namespace octascope::ui

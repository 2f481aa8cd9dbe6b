// Fits words on one line, else breaks them into two between words.
#pragma once

#include <string_view>

namespace octascope::ui {

struct TwoLines {
  std::string_view first;
  std::string_view second; // empty: one line suffices
};

// Pure. `width` of a text, in the unit of `most`, must grow with it. A line is wider than `most` if
// not even the first word fits, or if two lines are too short.
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

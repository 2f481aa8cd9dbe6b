#include "ui/status/axis_words.h"

#include <algorithm>

namespace octascope::ui {

namespace {

// By number, each beside its opposite.
constexpr std::array<std::string_view, 4> names{"superior", "inferior", "nasal", "temporal"};

} // namespace

std::string_view to_string(Side side) {
  return names[static_cast<std::size_t>(side)];
}

std::string_view letter_of(Side side) {
  constexpr std::array<std::string_view, 4> letters{"S", "I", "N", "T"};
  return letters[static_cast<std::size_t>(side)];
}

std::optional<Side> side_named(std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    return std::nullopt;
  return static_cast<Side>(found - names.begin());
}

Side opposite(Side side) {
  return static_cast<Side>(static_cast<unsigned>(side) ^ 1U);
}

bool along_one_line(Side a, Side b) {
  return a == b || a == opposite(b);
}

AxisEnds ends_of(const ScanOnEye& scan, pipeline::Eye eye) {
  if (eye == pipeline::Eye::not_said || !scan.right_eye_x || !scan.right_eye_y)
    return {};
  const auto on_this_eye = [&](Side side) {
    const bool across = along_one_line(side, Side::nasal);
    return across && eye == pipeline::Eye::left ? opposite(side) : side;
  };
  const Side x = on_this_eye(*scan.right_eye_x);
  const Side y = on_this_eye(*scan.right_eye_y);
  return {opposite(x), x, opposite(y), y};
}

} // namespace octascope::ui

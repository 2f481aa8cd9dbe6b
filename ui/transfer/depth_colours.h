// Colour by depth: a hue says how deep it is, and how bright it is says what the level is.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace octascope::ui {

// The depths between which the hues are spread, as shares of the volume's depth.
struct DepthColours {
  float from = 0;
  float to = 1;

  float place_of(float depth) const { return std::clamp((depth - from) / (to - from), 0.0F, 1.0F); }
  bool operator==(const DepthColours&) const = default;
};

// Follows the depths that have tissue without a jump of any hue: a quarter of what is missing from volume
// to volume, so that an instrument that comes in above the tissue moves the hues within a second, and
// only a little. Begins with the first.
class GlidingDepths {
public:
  void follow(const DepthColours& wanted) {
    constexpr float share = 0.25F, there = 1.0F / 512; // of the volume's depth
    const auto glide = [](float at, float to) {
      return std::abs(to - at) < there ? to : at + share * (to - at);
    };
    current_ =
        current_ ? DepthColours{glide(current_->from, wanted.from), glide(current_->to, wanted.to)}
                 : wanted;
  }
  DepthColours current() const { return current_.value_or(DepthColours{}); }

private:
  std::optional<DepthColours> current_;
};

// From orange (shallow) over yellow, green and turquoise to blue: an arc of 200° in OKLab
// (ui/transfer/oklab.h) at a lightness of 0.77 and a chroma of 0.125, fitted by a cubic in the place
// for each of red, green and blue, lowest power first. All are equally light, so that a brightness
// means the same at any depth, and go from yellowish to bluish, which the colour-blind see, too.
inline constexpr std::array<std::array<float, 4>, 3> depth_tint_cubics{{
    {0.9061F, 0.1682F, -4.5649F, 4.1070F},
    {0.6191F, 0.5649F, -0.3296F, -0.1584F},
    {0.3522F, -0.8603F, 3.8560F, -2.3521F},
}};

// What a grey is multiplied with at a place from 0 to 1.
constexpr std::array<float, 3> depth_tint(float place) {
  std::array<float, 3> tint{};
  for (std::size_t channel = 0; channel < tint.size(); ++channel) {
    const auto& cubic = depth_tint_cubics[channel];
    tint[channel] = ((cubic[3] * place + cubic[2]) * place + cubic[1]) * place + cubic[0];
  }
  return tint;
}

} // namespace octascope::ui

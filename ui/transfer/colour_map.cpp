#include "ui/transfer/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "ui/transfer/oklab.h"

namespace octascope::ui {

namespace {

struct Chroma {
  float hue_deg;
  float amount;
};

// From nearly black, so that faint tissue has a colour at all, to nearly white.
constexpr float darkest = 0.1F;
constexpr float lightest = 0.95F;

// A cubic Bézier curve in the plane of OKLab's a and b, while L rises linearly. The control points
// stay far enough inside that all of it is within sRGB.
ColourMap along_curve(std::string name, const std::array<Chroma, 4>& controls) {
  constexpr std::size_t count = 256;
  std::vector<TransferTable::Colour> samples;
  samples.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float u = static_cast<float>(i) / (count - 1);
    const float v = 1 - u;
    const std::array weights{v * v * v, 3 * v * v * u, 3 * v * u * u, u * u * u};
    Oklab lab{darkest + (lightest - darkest) * u};
    for (std::size_t k = 0; k < controls.size(); ++k) {
      const float hue = controls[k].hue_deg * std::numbers::pi_v<float> / 180;
      lab.a += weights[k] * controls[k].amount * std::cos(hue);
      lab.b += weights[k] * controls[k].amount * std::sin(hue);
    }
    samples.push_back(to_srgb(lab));
  }
  return {std::move(name), std::move(samples)};
}

} // namespace

ColourMap::ColourMap(std::string name, std::vector<TransferTable::Colour> samples)
    : name_{std::move(name)}, samples_{std::move(samples)} {}

ColourMap ColourMap::grey() {
  return {"grey", {{0, 0, 0}, {1, 1, 1}}};
}

ColourMap ColourMap::amber() {
  return along_curve("amber", {{{60, 0.02F}, {50, 0.1F}, {66, 0.155F}, {98, 0.06F}}});
}

ColourMap ColourMap::blue_green() {
  return along_curve("blue-green", {{{265, 0.04F}, {257, 0.14F}, {195, 0.1F}, {165, 0.06F}}});
}

ColourMap ColourMap::dawn() {
  return along_curve("dawn", {{{285, 0.03F}, {320, 0.24F}, {38, 0.22F}, {105, 0.1F}}});
}

ColourMap ColourMap::depth() {
  ColourMap map = grey();
  map.name_ = "depth";
  map.by_depth_ = true;
  return map;
}

TransferTable::Colour ColourMap::at(float u) const {
  const float place = std::clamp(u, 0.0F, 1.0F) * static_cast<float>(samples_.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), samples_.size() - 2);
  const float share = place - static_cast<float>(below);
  const TransferTable::Colour& low = samples_[below];
  const TransferTable::Colour& high = samples_[below + 1];
  return {std::lerp(low.red, high.red, share), std::lerp(low.green, high.green, share),
          std::lerp(low.blue, high.blue, share)};
}

} // namespace octascope::ui

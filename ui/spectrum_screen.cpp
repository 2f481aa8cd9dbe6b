#include "ui/spectrum_screen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "ui/layout/layout.h"
#include "ui/layout/stereo.h"

namespace octascope::ui {

namespace {

constexpr float figures_width = 420; // at unit 1
constexpr double headroom = 1.06;    // of the axis above full scale

class Plot {
public:
  Plot(Canvas& canvas, const Rect& room, float unit, const LiveSpectrum& spectrum)
      : canvas_{canvas}, unit_{unit}, spectrum_{spectrum}, left_{static_cast<float>(room.x) +
                                                                 canvas.text_width(TextStyle::label,
                                                                                   "100 %") +
                                                                 12 * unit},
        right_{static_cast<float>(room.right())}, top_{static_cast<float>(room.y)},
        foot_{static_cast<float>(room.bottom()) - 2 * canvas.text_height(TextStyle::label)},
        columns_{std::clamp(static_cast<std::size_t>(std::max((right_ - left_) / unit, 1.0F)),
                            std::size_t{1}, spectrum.mean.size())} {}

  void draw() const {
    mark_saturated();
    draw_axes();
    draw_curve(spectrum_.last, palette::box, unit_);
    draw_curve(spectrum_.mean, palette::accent, 3 * unit_);
    name_curves();
  }

private:
  float y(double counts) const {
    const double share = std::clamp(counts / spectrum_.full_scale / headroom, 0.0, 1.0);
    return foot_ - (foot_ - top_) * static_cast<float>(share);
  }
  float x(std::size_t column) const {
    return left_ + (right_ - left_) * static_cast<float>(column) / static_cast<float>(columns_);
  }
  // The pixels of a column, and the one before them: curves have no gaps.
  std::span<const double> pixels(std::span<const double> line, std::size_t column) const {
    const std::size_t first = line.size() * column / columns_;
    const std::size_t end = line.size() * (column + 1) / columns_;
    const std::size_t begin = first == 0 ? 0 : first - 1;
    return line.subspan(begin, end - begin);
  }

  void draw_curve(std::span<const double> line, Colour colour, float thickness) const {
    for (std::size_t column = 0; column < columns_ && !line.empty(); ++column) {
      const auto [low, high] = std::ranges::minmax(pixels(line, column));
      canvas_.bar({x(column), y(high) - thickness / 2}, {x(column + 1), y(low) + thickness / 2},
                  colour);
    }
  }

  void mark_saturated() const {
    for (std::size_t column = 0; column < columns_ && !spectrum_.highest.empty(); ++column)
      if (std::ranges::max(pixels(spectrum_.highest, column)) >= spectrum_.full_scale)
        canvas_.bar({x(column), top_}, {std::max(x(column + 1), x(column) + 3 * unit_), foot_},
                    palette::warning.faded(110));
  }

  void draw_axes() const {
    const float thin = std::max(1.0F, unit_);
    const float half = canvas_.text_height(TextStyle::label) / 2;
    for (const int percent : {0, 20, 40, 60, 80, 100}) {
      const float level = y(spectrum_.full_scale * percent / 100);
      const bool full = percent == 100;
      canvas_.line({left_, level}, {right_, level}, full ? palette::warning : palette::hairline,
                   full ? 2 * thin : thin);
      const std::string words = fmt::format("{} %", percent);
      canvas_.text({left_ - 8 * unit_ - canvas_.text_width(TextStyle::label, words), level - half},
                   TextStyle::label, palette::quiet_text, words);
    }
    canvas_.line({left_, y(spectrum_.dark)}, {right_, y(spectrum_.dark)}, palette::frozen, thin);
  }

  // Of curves and, where there is room left, of the axis below them.
  void name_curves() const {
    float left = left_;
    const std::array<std::pair<Colour, const char*>, 4> names{{{palette::accent, "mean"},
                                                               {palette::box, "last line"},
                                                               {palette::frozen, "dark"},
                                                               {palette::warning, "saturated"}}};
    const float half = canvas_.text_height(TextStyle::label) / 2;
    for (const auto& [colour, name] : names) {
      canvas_.bar({left, foot_ + 2 * half - 2 * unit_},
                  {left + 24 * unit_, foot_ + 2 * half + 2 * unit_}, colour);
      left += 32 * unit_;
      left += canvas_.text({left, foot_ + half}, TextStyle::label, palette::quiet_text, name) +
              20 * unit_;
    }
    const std::string pixels = fmt::format("pixels 0 to {}", spectrum_.mean.size() - 1);
    const float begin = right_ - canvas_.text_width(TextStyle::label, pixels);
    if (begin > left)
      canvas_.text({begin, foot_ + half}, TextStyle::label, palette::quiet_text, pixels);
  }

  Canvas& canvas_;
  float unit_;
  const LiveSpectrum& spectrum_;
  float left_;
  float right_;
  float top_;
  float foot_;
  std::size_t columns_;
};

void lay_out_figures(Canvas& canvas, const Rect& room, float unit,
                     std::span<const SpectrumFigure> figures) {
  const float row = static_cast<float>(room.height) / static_cast<float>(figures.size());
  const float left = static_cast<float>(room.x) + 20 * unit;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const SpectrumFigure& figure = figures[i];
    const bool good = figure.remedy.empty();
    const float top = std::floor(static_cast<float>(room.y) + row * static_cast<float>(i));
    canvas.bar({static_cast<float>(room.x), top},
               {static_cast<float>(room.x) + 6 * unit, top + row - 12 * unit},
               good ? palette::good : palette::warning);
    float y = top;
    const auto say = [&](TextStyle style, Colour colour, std::string_view words) {
      canvas.text({left, y}, style, colour, words);
      y += std::ceil(canvas.text_height(style));
    };
    say(TextStyle::label, palette::quiet_text, figure.name);
    say(TextStyle::badge, good ? palette::text : palette::warning, figure.value);
    say(TextStyle::label, palette::quiet_text, "good: " + figure.good);
    if (!good)
      say(TextStyle::label, palette::warning, figure.remedy);
  }
}

} // namespace

void lay_out_spectrum(Canvas& canvas, int width, int height, float unit,
                      const LiveSpectrum& spectrum) {
  canvas.bar({0, 0}, {width, height}, palette::background);
  const int margin = static_cast<int>(20 * unit);
  const int beside = static_cast<int>(figures_width * unit);
  const int top = 2 * margin + static_cast<int>(canvas.text_height(TextStyle::badge));
  canvas.text({margin, margin}, TextStyle::badge, palette::text, "Spectrum");
  const std::string_view ends = "Enter ends it";
  canvas.text({static_cast<float>(width - margin) - canvas.text_width(TextStyle::value, ends),
               static_cast<float>(margin)},
              TextStyle::value, palette::quiet_text, ends);
  Plot{
      canvas, {margin, top, width - 3 * margin - beside, height - top - margin / 2}, unit, spectrum}
      .draw();
  if (!spectrum.figures.empty())
    lay_out_figures(canvas, {width - margin - beside, top, beside, height - top - margin / 2}, unit,
                    spectrum.figures);
}

SpectrumScreen::SpectrumScreen(int width, int height, Fonts fonts, CanvasRenderer renderer)
    : width_{width}, height_{height}, fonts_{std::move(fonts)}, renderer_{std::move(renderer)} {}

hal::Result<SpectrumScreen> SpectrumScreen::create(int width, int height) {
  HAL_TRY(auto fonts, Fonts::create(lay_out(width, height, {}).unit));
  HAL_TRY(auto renderer, CanvasRenderer::create());
  return SpectrumScreen{width, height, std::move(fonts), std::move(renderer)};
}

void SpectrumScreen::draw(const LiveSpectrum& spectrum) {
  Canvas canvas;
  canvas.begin(fonts_, width_, height_);
  lay_out_spectrum(canvas, width_, height_, lay_out(width_, height_, {}).unit, spectrum);
  renderer_.draw(canvas, eye_frame(StereoMode::off, StereoEye::centre, width_, height_), height_);
}

} // namespace octascope::ui

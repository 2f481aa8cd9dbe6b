#include "firmware-host/commands/line_plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace octascope::firmware_host {

namespace {

constexpr Colour frame_colour{90, 90, 90};
constexpr Colour grid_colour{225, 225, 225};
constexpr Colour text_colour{40, 40, 40};
constexpr int letter_step = 8;

// Five rows of three dots, each row an octal digit: the highest bit is the left dot.
std::string_view glyph(char c) {
  constexpr std::string_view characters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,-:()/+";
  constexpr std::array<std::string_view, 44> dots{
      "25755", "65656", "34443", "65556", "74647", "74644", "34553", "55755", "72227",
      "11152", "55655", "44447", "57755", "65555", "25552", "65644", "25531", "65655",
      "34216", "72222", "55557", "55552", "55775", "55255", "55222", "71247", // letters
      "75557", "26227", "71747", "71717", "55711", "74717", "74757", "71111", "75757",
      "75717", "00002", "00024", "00700", "02020", "12221", "42224", "11244", "02720"};
  const std::size_t at = characters.find(c);
  return at == std::string_view::npos ? "00000" : dots[at];
}

void set_pixel(pipeline::Image& image, int x, int y, Colour colour) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height)
    return;
  const auto at = (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                   static_cast<std::size_t>(x)) *
                  3;
  std::ranges::copy(colour, image.pixels.begin() + static_cast<std::ptrdiff_t>(at));
}

void draw_line(pipeline::Image& image, double x0, double y0, double x1, double y1, Colour colour) {
  const int steps =
      std::max(1, static_cast<int>(std::ceil(std::max(std::abs(x1 - x0), std::abs(y1 - y0)))));
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    set_pixel(image, static_cast<int>(std::lround(x0 + t * (x1 - x0))),
              static_cast<int>(std::lround(y0 + t * (y1 - y0))), colour);
  }
}

// 1, 2 or 5 times a power of ten: four to ten steps over the range.
double tick_step(double range) {
  const double rough = range / 8;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough)
      return factor * power;
  }
  return 10 * power;
}

std::string tick_text(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const double shown = std::abs(value) < step * 1e-6 ? 0 : value;
  return fmt::format("{:.{}f}", shown, decimals);
}

// The part of the box where the curves are.
class Axes {
public:
  Axes(const Box& box, const PlotPanel& panel)
      : left_(box.x + 64), top_(box.y + 24), right_(box.x + box.width - 16),
        bottom_(box.y + box.height - 24), panel_(panel) {}

  double x(double value) const { return left_ + value / panel_.x_last * (right_ - left_); }
  double y(double value) const {
    const double share = (value - panel_.y_low) / (panel_.y_high - panel_.y_low);
    return bottom_ - std::clamp(share, 0.0, 1.0) * (bottom_ - top_);
  }
  void draw_grid(pipeline::Image& image) const;
  void draw_curve(pipeline::Image& image, const PlotCurve& curve) const;

private:
  int left_;
  int top_;
  int right_;
  int bottom_;
  const PlotPanel& panel_;
};

void Axes::draw_grid(pipeline::Image& image) const {
  const double x_tick = tick_step(panel_.x_last);
  for (double value = 0; value <= panel_.x_last * (1 + 1e-9); value += x_tick) {
    draw_line(image, x(value), top_, x(value), bottom_, grid_colour);
    const std::string text = tick_text(value, x_tick);
    draw_text(image, static_cast<int>(x(value)) - static_cast<int>(text.size()) * letter_step / 2,
              bottom_ + 6, text, text_colour);
  }
  const double y_tick = tick_step(panel_.y_high - panel_.y_low);
  for (double value = std::ceil(panel_.y_low / y_tick - 1e-9) * y_tick;
       value <= panel_.y_high + 1e-9 * y_tick; value += y_tick) {
    draw_line(image, left_, y(value), right_, y(value), grid_colour);
    const std::string text = tick_text(value, y_tick);
    draw_text(image, left_ - 6 - static_cast<int>(text.size()) * letter_step,
              static_cast<int>(y(value)) - 5, text, text_colour);
  }
  draw_line(image, left_, top_, left_, bottom_, frame_colour);
  draw_line(image, left_, bottom_, right_, bottom_, frame_colour);
}

void Axes::draw_curve(pipeline::Image& image, const PlotCurve& curve) const {
  for (std::size_t i = 1; i < curve.values.size(); ++i) {
    const double from = static_cast<double>(i - 1) * panel_.x_step;
    if (from + panel_.x_step > panel_.x_last * (1 + 1e-9))
      return;
    if (std::isfinite(curve.values[i - 1]) && std::isfinite(curve.values[i]))
      draw_line(image, x(from), y(curve.values[i - 1]), x(from + panel_.x_step), y(curve.values[i]),
                curve.colour);
  }
}

} // namespace

void draw_text(pipeline::Image& image, int x, int y, std::string_view text, Colour colour) {
  for (const char c : text) {
    const std::string_view rows = glyph(c);
    for (int dot = 0; dot < 15; ++dot) {
      const int row = dot / 3;
      const int column = dot % 3;
      if (((rows[static_cast<std::size_t>(row)] - '0') >> (2 - column) & 1) == 0)
        continue;
      for (int i = 0; i < 4; ++i)
        set_pixel(image, x + 2 * column + i % 2, y + 2 * row + i / 2, colour);
    }
    x += letter_step;
  }
}

void draw_panel(pipeline::Image& image, const Box& box, const PlotPanel& panel) {
  const Axes axes{box, panel};
  axes.draw_grid(image);
  for (const PlotCurve& curve : panel.curves)
    axes.draw_curve(image, curve);
  draw_text(image, box.x + 64, box.y + 6, panel.title, text_colour);
  int x = box.x + 64 + (static_cast<int>(panel.title.size()) + 4) * letter_step;
  for (const PlotCurve& curve : panel.curves) {
    draw_text(image, x, box.y + 6, curve.name, curve.colour);
    x += (static_cast<int>(curve.name.size()) + 3) * letter_step;
  }
}

} // namespace octascope::firmware_host

#include "ui/hud/window_histogram.h"

#include <algorithm>
#include <cmath>

#include "pipeline/volume/level_scale.h"
#include "ui/view/fixed_text.h"

namespace octascope::ui {

namespace {

// Levels in decibels to the right, shares from 0 to 1 upwards.
struct Chart {
  float left, right, top, bottom;

  float x(float level_db) const {
    constexpr float range = pipeline::highest_level_db - pipeline::lowest_level_db;
    const float share = std::clamp((level_db - pipeline::lowest_level_db) / range, 0.0F, 1.0F);
    return left + share * (right - left);
  }
  float y(float share) const { return bottom - share * (bottom - top); }
};

void draw_shares(Canvas& canvas, const Chart& chart, const LevelShares& shares) {
  // The lowest level is also what missing B-scans have, and not of interest.
  const float most = *std::max_element(shares.begin() + 1, shares.end());
  if (most <= 0)
    return;
  const float width = (chart.right - chart.left) / static_cast<float>(shares.size());
  float x = chart.left;
  for (const float share : shares) {
    const float y = chart.y(std::sqrt(std::clamp(share / most, 0.0F, 1.0F)));
    canvas.bar({x, y}, {x + width, chart.bottom}, palette::histogram);
    x += width;
  }
}

void draw_ramp(Canvas& canvas, const Chart& chart, const ViewState& view, float unit) {
  const float from = view.window_offset_db;
  const float size = view.window_size_db;
  const auto opacity = [&](float db) { return std::clamp((db - from) / size, 0.0F, 1.0F); };
  const float width = 3 * unit;
  const std::array<float, 4> stops{pipeline::lowest_level_db, from, from + size,
                                   pipeline::highest_level_db};
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const float a = std::clamp(stops[i], stops.front(), stops.back());
    const float b = std::clamp(stops[i + 1], stops.front(), stops.back());
    canvas.line({chart.x(a), chart.y(opacity(a))}, {chart.x(b), chart.y(opacity(b))},
                palette::accent, width);
  }
}

// Only those that have room beside their neighbours.
void draw_levels(Canvas& canvas, const Chart& chart, float unit) {
  canvas.text({chart.left + 8 * unit, chart.top - 6 * unit}, TextStyle::label, palette::quiet_text,
              "dB");
  float taken = chart.left - 20 * unit;
  for (const int db : {-40, 0, 40, 80}) {
    FixedText<16> words;
    words.format("{}", db);
    const float width = canvas.text_width(TextStyle::label, words.view());
    const float at = chart.x(static_cast<float>(db));
    canvas.line({at, chart.bottom}, {at, chart.bottom + 5 * unit}, palette::quiet_text, unit);
    const float x = std::clamp(at - width / 2, chart.left - 6 * unit,
                               std::max(chart.left, chart.right + 6 * unit - width));
    if (x < taken + 8 * unit)
      continue;
    canvas.text({x, chart.bottom + 6 * unit}, TextStyle::label, palette::quiet_text, words.view());
    taken = x + width;
  }
}

} // namespace

void draw_window_histogram(Canvas& canvas, const Rect& rect, const LevelShares& shares,
                           const ViewState& view, float unit) {
  if (rect.empty())
    return;
  canvas.plate(rect, palette::plate, 6 * unit);
  const float label = canvas.text_height(TextStyle::label);
  const Chart chart{static_cast<float>(rect.x) + 14 * unit,
                    static_cast<float>(rect.right()) - 14 * unit,
                    static_cast<float>(rect.y) + 12 * unit,
                    static_cast<float>(rect.bottom()) - label - 12 * unit};
  if (chart.bottom - chart.top < 8 * unit)
    return;
  draw_shares(canvas, chart, shares);
  canvas.line({chart.left, chart.bottom}, {chart.right, chart.bottom}, palette::quiet_text, unit);
  draw_ramp(canvas, chart, view, unit);
  draw_levels(canvas, chart, unit);
}

} // namespace octascope::ui

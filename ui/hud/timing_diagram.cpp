#include <algorithm>
#include <array>
#include <cmath>

#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

constexpr std::array<std::string_view, timing_row_count> row_names{
    "Exposure", "Camera", "Workers", "Fixed rate", "Buffer", "Render", "Glass"};
// By their places in Timing.
constexpr std::array<Colour, 3> volume_colours{palette::accent, palette::crossed,
                                               palette::calliper};
constexpr float least_width = 100; // of the axis, at unit 1: less says nothing

hal::TimePoint begin_of(const TimedVolume& volume) {
  hal::TimePoint begin = volume.flipped;
  for (const TimingBar& bar : volume.bars)
    begin = std::min(begin, bar.begin);
  return begin;
}

// From the oldest volume's first line to the newest one's flip. What was long before, as before a
// freeze, is left out.
class TimeAxis {
public:
  TimeAxis(const Timing& timing, float left, float right)
      : end_{timing.newest_volume().flipped}, begin_{begin_of(timing.newest_volume())}, left_{
                                                                                            left} {
    earliest_ = begin_ - 4 * (end_ - begin_);
    for (const TimedVolume& volume : timing.volumes)
      if (shows(volume))
        begin_ = std::min(begin_, begin_of(volume));
    per_ms_ = (right - left) / static_cast<float>(std::max(ms(end_ - begin_), 1e-3));
  }

  bool shows(const TimedVolume& volume) const {
    return volume.index != 0 && begin_of(volume) >= earliest_;
  }
  float x(hal::TimePoint time) const {
    return left_ + per_ms_ * static_cast<float>(ms(time - begin_));
  }
  float per_ms() const { return per_ms_; }
  hal::TimePoint end() const { return end_; }

  static double ms(hal::Duration duration) { return hal::to_seconds(duration) * 1e3; }

private:
  hal::TimePoint end_, begin_, earliest_;
  float left_;
  float per_ms_;
};

class Diagram {
public:
  Diagram(Canvas& canvas, const Rect& room, const Timing& timing, float unit)
      : canvas_{canvas}, timing_{timing}, unit_{unit}, top_{static_cast<float>(room.y) + 8 * unit},
        row_{(static_cast<float>(room.height) - 14 * unit) / (timing_row_count + 1)},
        left_{static_cast<float>(room.x) + names_width() + 32 * unit},
        right_{static_cast<float>(room.right()) - 16 * unit}, axis_{timing, left_, right_} {}

  void draw() const {
    if (right_ - left_ < least_width * unit_)
      return;
    draw_rows();
    draw_ticks();
    for (std::size_t i = 0; i < timing_.volumes.size(); ++i)
      if (axis_.shows(timing_.volumes[i]))
        for (const TimingBar& bar : timing_.volumes[i].bars)
          draw_bar(bar, volume_colours[i]);
    draw_latency(timing_.newest_volume());
  }

private:
  float names_width() const {
    float width = 0;
    for (const std::string_view name : row_names)
      width = std::max(width, canvas_.text_width(TextStyle::label, name));
    return width;
  }
  float row_top(std::size_t row) const { return top_ + static_cast<float>(row) * row_; }

  void draw_rows() const {
    for (std::size_t row = 0; row < timing_row_count; ++row) {
      const float y = row_top(row) + (row_ - canvas_.text_height(TextStyle::label)) / 2;
      canvas_.text({left_ - names_width() - 16 * unit_, y}, TextStyle::label, palette::quiet_text,
                   row_names[row]);
      canvas_.line({left_, row_top(row) + row_}, {right_, row_top(row) + row_}, palette::hairline,
                   std::max(1.0F, unit_));
    }
  }

  // Back from the flip.
  void draw_ticks() const {
    const double step = round_ruler_step_mm(static_cast<double>(110 * unit_ / axis_.per_ms()));
    const float foot = row_top(timing_row_count);
    const float y = foot + (row_ - canvas_.text_height(TextStyle::label)) / 2 + 2 * unit_;
    float free_to = right_;
    for (int i = 0;; ++i) {
      const float x = axis_.x(axis_.end()) - axis_.per_ms() * static_cast<float>(i * step);
      if (x < left_)
        return;
      canvas_.line({x, top_}, {x, foot + 4 * unit_}, palette::hairline, std::max(1.0F, unit_));
      FixedText<16> words;
      if (i == 0)
        words.format("0 ms");
      else
        words.format("−{:g}", i * step);
      const float width = canvas_.text_width(TextStyle::label, words.view());
      const float begin = std::min(x - width / 2, right_ - width);
      if (begin < left_ || begin + width > free_to)
        continue;
      canvas_.text({begin, y}, TextStyle::label, palette::quiet_text, words.view());
      free_to = begin - 12 * unit_;
    }
  }

  // A worker has its own lane in the workers' row.
  void draw_bar(const TimingBar& bar, Colour colour) const {
    const float gap = 3 * unit_;
    float top = row_top(static_cast<std::size_t>(bar.row)) + gap;
    float height = row_ - 2 * gap;
    if (bar.row == TimingRow::workers) {
      height /= static_cast<float>(timing_.workers);
      top += static_cast<float>(bar.worker) * height;
      height -= std::min(unit_, height / 4);
    }
    const float from = axis_.x(bar.begin);
    const float to = std::max(axis_.x(bar.end), from + std::max(1.0F, unit_));
    if (!bar.waits) {
      canvas_.bar({from, top}, {to, top + height}, colour);
      if (to - from > 6 * unit_) // apart from what the same thread did before
        canvas_.bar({from, top}, {from + std::max(1.0F, unit_), top + height}, palette::panel);
      return;
    }
    canvas_.bar({from, top}, {to, top + height}, colour.faded(70));
    const float thin = std::max(1.0F, 1.5F * unit_);
    canvas_.bar({from, top}, {to, top + thin}, colour);
    canvas_.bar({from, top + height - thin}, {to, top + height}, colour);
  }

  // From the last line to the glass, in the row of what no longer happens then.
  void draw_latency(const TimedVolume& volume) const {
    FixedText<48> words;
    words.format("last line to glass {:.1f} ms", TimeAxis::ms(volume.flipped - volume.last_line));
    const float from = axis_.x(volume.last_line);
    const float to = axis_.x(volume.flipped);
    const float middle = row_top(0) + row_ / 2;
    const float thin = std::max(1.0F, 2 * unit_);
    canvas_.line({from, middle}, {to, middle}, palette::text, thin);
    for (const float x : {from, to})
      canvas_.line({x, middle - 6 * unit_}, {x, middle + 6 * unit_}, palette::text, thin);
    const float width = canvas_.text_width(TextStyle::label, words.view());
    const float height = canvas_.text_height(TextStyle::label);
    const float left = from - width - 12 * unit_;
    canvas_.bar({left - 8 * unit_, row_top(0)}, {from - 4 * unit_, row_top(0) + row_},
                palette::plate);
    canvas_.text({left, middle - height / 2}, TextStyle::label, palette::text, words.view());
  }

  Canvas& canvas_;
  const Timing& timing_;
  float unit_;
  float top_;
  float row_;
  float left_;
  float right_;
  TimeAxis axis_;
};

} // namespace

void draw_timing_diagram(Canvas& canvas, const Rect& room, const Timing& timing, float unit) {
  if (room.empty())
    return;
  const Canvas::Clip clip{canvas, room};
  if (timing.newest == 0) {
    canvas.text({static_cast<float>(room.x) + 16 * unit, static_cast<float>(room.y) + 8 * unit},
                TextStyle::label, palette::quiet_text, "No timing: no volume came from a camera.");
    return;
  }
  Diagram{canvas, room, timing, unit}.draw();
}

} // namespace octascope::ui

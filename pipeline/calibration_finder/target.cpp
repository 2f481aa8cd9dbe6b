#include "pipeline/calibration_finder/target.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace octascope::pipeline {

namespace {

using hal::ErrorCode;

struct Rectangle {
  double x0, x1, y0, y1;
};
constexpr double bar_pitch = 3;
constexpr double bar_width = 2;
constexpr double bars_begin = 14; // on the axis across
constexpr int x_bars = 4;
constexpr int y_bars = 7;
constexpr std::array letter{Rectangle{0, 3, 0, 12}, Rectangle{3, 11, 0, 3}, Rectangle{3, 8, 5, 8}};

bool in_bars(double along, double across, int bars) {
  return across >= bars_begin && across < target_units && along >= 0 && along < bars * bar_pitch &&
         std::fmod(along, bar_pitch) < bar_width;
}

struct Place {
  double x, y;
};

// The picture's axes, in samples.
struct Extent {
  double first = 0;
  double last = 0;
};

// One of the eight ways round. `u`, `v`: of the picture, 0 … 1 within the target's square.
Place drawing_place(double u, double v, bool mirrored, int quarter_turns) {
  double x = u;
  double y = v;
  for (int turn = 0; turn < quarter_turns; ++turn) {
    const double before = x;
    x = y;
    y = 1 - before;
  }
  return {(mirrored ? 1 - x : x) * target_units, y * target_units};
}

class TargetPicture {
public:
  TargetPicture(std::span<const float> en_face, int a_scans, int b_scans)
      : levels_(en_face), a_scans_(a_scans), b_scans_(b_scans) {}

  hal::Result<TargetMeasurement> measure(double side_um);

private:
  hal::Result<> find_threshold();
  hal::Result<Extent> find_extent(bool along_a) const;
  hal::Result<TargetMeasurement> find_orientation() const;
  double agreement(bool mirrored, int quarter_turns) const;
  hal::Result<double> find_pitch(const TargetMeasurement& way, bool along_a) const;
  std::vector<std::optional<double>> bar_profile(const TargetMeasurement& way, bool along_a,
                                                 bool x_axis) const;

  float level(int a, int b) const {
    return levels_[static_cast<std::size_t>(b) * static_cast<std::size_t>(a_scans_) +
                   static_cast<std::size_t>(a)];
  }
  bool bright(int a, int b) const { return level(a, b) >= threshold_; }

  std::span<const float> levels_;
  int a_scans_;
  int b_scans_;
  float threshold_ = 0;
  Extent a_;
  Extent b_;
};

hal::Result<> TargetPicture::find_threshold() {
  constexpr float least_contrast_db = 10;
  std::vector<float> sorted(levels_.begin(), levels_.end());
  std::ranges::sort(sorted);
  const float dark = sorted[sorted.size() / 20];
  const float light = sorted[sorted.size() - 1 - sorted.size() / 20];
  if (!(light - dark >= least_contrast_db))
    return hal::fail(ErrorCode::bad_data,
                     "no target: bright and dark places differ by {:.1f} dB, expected at least "
                     "{:.0f}; is it in focus, and within the depth range?",
                     light - dark, least_contrast_db);
  threshold_ = (dark + light) / 2;
  return {};
}

// Where columns (or rows) are at least half as full as the fullest.
hal::Result<Extent> TargetPicture::find_extent(bool along_a) const {
  const int length = along_a ? a_scans_ : b_scans_;
  const int across = along_a ? b_scans_ : a_scans_;
  std::vector<int> filled(static_cast<std::size_t>(length));
  for (int i = 0; i < length; ++i)
    for (int j = 0; j < across; ++j)
      filled[static_cast<std::size_t>(i)] += (along_a ? bright(i, j) : bright(j, i)) ? 1 : 0;
  int fullest = 2;
  for (const int count : filled)
    fullest = std::max(fullest, count);
  const auto is_enough = [&](int count) { return 2 * count >= fullest; };
  const auto first = std::ranges::find_if(filled, is_enough) - filled.begin();
  const auto last =
      length - 1 - (std::find_if(filled.rbegin(), filled.rend(), is_enough) - filled.rbegin());
  if (first == 0 || last == length - 1)
    return hal::fail(ErrorCode::bad_data,
                     "the target reaches the {} {}, expected all of it within the scan, with some "
                     "margin; move it, or scan a larger field",
                     first == 0 ? "first" : "last", along_a ? "A-scan" : "B-scan");
  return Extent{static_cast<double>(first) - 0.5, static_cast<double>(last) + 0.5};
}

double TargetPicture::agreement(bool mirrored, int quarter_turns) const {
  constexpr int grid = 2 * target_units;
  int balance = 0;
  for (int j = 0; j < grid; ++j)
    for (int i = 0; i < grid; ++i) {
      const double u = (i + 0.5) / grid;
      const double v = (j + 0.5) / grid;
      const int a = static_cast<int>(std::lround(a_.first + u * (a_.last - a_.first)));
      const int b = static_cast<int>(std::lround(b_.first + v * (b_.last - b_.first)));
      const Place place = drawing_place(u, v, mirrored, quarter_turns);
      balance += bright(std::clamp(a, 0, a_scans_ - 1), std::clamp(b, 0, b_scans_ - 1)) ==
                         target_reflects(place.x, place.y)
                     ? 1
                     : -1;
    }
  return static_cast<double>(balance) / (grid * grid);
}

hal::Result<TargetMeasurement> TargetPicture::find_orientation() const {
  constexpr double least_agreement = 0.7;
  constexpr double least_lead = 0.2;
  TargetMeasurement best{.agreement = -2, .runner_up = -2};
  for (const bool mirrored : {false, true})
    for (int turns = 0; turns < 4; ++turns) {
      const double value = agreement(mirrored, turns);
      best.runner_up = std::max(best.runner_up, std::min(value, best.agreement));
      if (value > best.agreement) {
        best.mirrored = mirrored;
        best.quarter_turns = turns;
        best.agreement = value;
      }
    }
  if (best.agreement < least_agreement || best.agreement - best.runner_up < least_lead)
    return hal::fail(
        ErrorCode::bad_data,
        "what was scanned is not the target: it agrees with its drawing by {:.2f}, the "
        "next way round by {:.2f}, expected {:.1f} and a lead of {:.1f}; is it flat, in "
        "focus, and along the axes of the scan?",
        best.agreement, best.runner_up, least_agreement, least_lead);
  return best;
}

// The level along one axis of the picture across the bars that measure it, by sample; nothing where
// there are none.
std::vector<std::optional<double>> TargetPicture::bar_profile(const TargetMeasurement& way,
                                                              bool along_a, bool x_axis) const {
  const double bars_end = (x_axis ? x_bars : y_bars) * bar_pitch;
  std::vector<double> sums(static_cast<std::size_t>(along_a ? a_scans_ : b_scans_));
  std::vector<int> counts(sums.size());
  for (int b = 0; b < b_scans_; ++b)
    for (int a = 0; a < a_scans_; ++a) {
      const Place place =
          drawing_place((a - a_.first) / (a_.last - a_.first),
                        (b - b_.first) / (b_.last - b_.first), way.mirrored, way.quarter_turns);
      const double along = x_axis ? place.x : place.y;
      const double across = x_axis ? place.y : place.x;
      if (along < -1 || along > bars_end || across < bars_begin + 1 || across > target_units - 1)
        continue;
      const auto i = static_cast<std::size_t>(along_a ? a : b);
      sums[i] += static_cast<double>(level(a, b));
      ++counts[i];
    }
  std::vector<std::optional<double>> profile(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (counts[i] > 0)
      profile[i] = sums[i] / counts[i];
  return profile;
}

// Centres of the bars between the crossings of the threshold, and the slope of a straight line
// through them.
hal::Result<double> TargetPicture::find_pitch(const TargetMeasurement& way, bool along_a) const {
  const bool x_axis = along_a == (way.quarter_turns % 2 == 0);
  const auto profile = bar_profile(way, along_a, x_axis);
  const auto threshold = static_cast<double>(threshold_);
  std::vector<double> centres;
  std::optional<double> rose;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    if (!profile[i - 1] || !profile[i])
      continue;
    const double before = *profile[i - 1] - threshold;
    const double after = *profile[i] - threshold;
    if ((before < 0) == (after < 0))
      continue;
    const double crossing = static_cast<double>(i - 1) + before / (before - after);
    if (after >= 0)
      rose = crossing;
    else if (rose)
      centres.push_back((*std::exchange(rose, std::nullopt) + crossing) / 2);
  }
  const auto expected = static_cast<std::size_t>(x_axis ? x_bars : y_bars);
  if (centres.size() != expected)
    return hal::fail(
        ErrorCode::bad_data,
        "{} bars are seen along the {}-scans, expected {}; is the target in focus, and "
        "are there at least three {}-scans a bar?",
        centres.size(), along_a ? 'A' : 'B', expected, along_a ? 'A' : 'B');
  const double middle = (static_cast<double>(expected) - 1) / 2;
  double slope = 0;
  double weight = 0;
  for (std::size_t n = 0; n < expected; ++n) {
    const double step = static_cast<double>(n) - middle;
    slope += step * centres[n];
    weight += step * step;
  }
  return slope / weight;
}

hal::Result<TargetMeasurement> TargetPicture::measure(double side_um) {
  HAL_CHECK(find_threshold());
  HAL_TRY(a_, find_extent(true));
  HAL_TRY(b_, find_extent(false));
  HAL_TRY(auto found, find_orientation());
  HAL_TRY(const double a_pitch, find_pitch(found, true));
  HAL_TRY(const double b_pitch, find_pitch(found, false));
  const double pitch_um = bar_pitch / target_units * side_um;
  found.a_spacing_um = pitch_um / a_pitch;
  found.b_spacing_um = pitch_um / b_pitch;
  return found;
}

} // namespace

bool target_reflects(double x, double y) {
  const bool in_letter = std::ranges::any_of(letter, [&](const Rectangle& part) {
    return x >= part.x0 && x < part.x1 && y >= part.y0 && y < part.y1;
  });
  return in_letter || in_bars(x, y, x_bars) || in_bars(y, x, y_bars);
}

std::string orientation_text(const TargetMeasurement& measurement) {
  if (measurement.upright())
    return "upright";
  const std::string turn =
      measurement.quarter_turns == 0
          ? std::string{}
          : fmt::format("turned by {}° clockwise", measurement.quarter_turns * 90);
  if (!measurement.mirrored)
    return turn;
  return turn.empty() ? "mirrored left for right" : "mirrored left for right and " + turn;
}

hal::Result<TargetMeasurement> measure_target(std::span<const float> en_face, int a_scans,
                                              int b_scans, double side_um) {
  return TargetPicture{en_face, a_scans, b_scans}.measure(side_um);
}

} // namespace octascope::pipeline

#include "pipeline/calibration_finder/target.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
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
  Extent find_extent(bool along_a) const;
  hal::Result<TargetMeasurement> find_orientation() const;
  double agreement(bool mirrored, int quarter_turns) const;
  double agreement(bool mirrored, int quarter_turns, double tilt_rad) const;
  hal::Result<double> find_pitch(const TargetMeasurement& way, bool along_a) const;
  std::vector<std::optional<double>> bar_profile(const TargetMeasurement& way, bool along_a,
                                                 bool x_axis) const;

  float level(int a, int b) const {
    return levels_[static_cast<std::size_t>(b) * static_cast<std::size_t>(a_scans_) +
                   static_cast<std::size_t>(a)];
  }
  std::string seen() const;
  std::string likely_reason() const;
  bool reaches_border(bool along_a, bool first) const;

  bool bright(int a, int b) const { return level(a, b) >= threshold_; }

  std::span<const float> levels_;
  int a_scans_;
  int b_scans_;
  double bright_share_ = 0; // of the picture
  double contrast_db_ = 0;
  float threshold_ = 0;
  Extent a_;
  Extent b_;
};

// Halfway between the means of what is below and above it, so that it does not matter which share is
// bright: of the smallest target that can be measured it is one place in fifty.
hal::Result<> TargetPicture::find_threshold() {
  constexpr double least_contrast_db = 10;
  constexpr int most_rounds = 50;
  std::vector<double> sorted(levels_.begin(), levels_.end());
  std::ranges::sort(sorted);
  const auto count = static_cast<std::ptrdiff_t>(sorted.size());
  double dark = sorted[sorted.size() / 20];
  double light = sorted[sorted.size() - 1 - sorted.size() / 100];
  auto first_light = sorted.begin();
  for (int round = 0; round < most_rounds; ++round) {
    const auto before =
        std::exchange(first_light, std::ranges::lower_bound(sorted, (dark + light) / 2));
    const auto darker = first_light - sorted.begin();
    if (first_light == before || darker == 0 || darker == count)
      break;
    dark = std::accumulate(sorted.begin(), first_light, 0.0) / static_cast<double>(darker);
    light = std::accumulate(first_light, sorted.end(), 0.0) / static_cast<double>(count - darker);
  }
  threshold_ = static_cast<float>((dark + light) / 2);
  contrast_db_ = light - dark;
  bright_share_ = static_cast<double>(sorted.end() - first_light) / static_cast<double>(count);
  if (!(contrast_db_ >= least_contrast_db))
    return hal::fail(ErrorCode::bad_data,
                     "no target: bright and dark places differ by {:.1f} dB, expected at least "
                     "{:.0f}; it is level (tilt it by a degree or two), or not within the field, "
                     "the depth range or the focus.",
                     contrast_db_, least_contrast_db);
  return {};
}

// Where columns (or rows) are at least half as full as the fullest.
Extent TargetPicture::find_extent(bool along_a) const {
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
  return {static_cast<double>(first) - 0.5, static_cast<double>(last) + 0.5};
}

double TargetPicture::agreement(bool mirrored, int quarter_turns) const {
  constexpr double step_rad = 0.0175; // a degree
  double best = -1;
  for (int step = -3; step <= 3; ++step)
    best = std::max(best, agreement(mirrored, quarter_turns, step * step_rad));
  return best;
}

// `tilt_rad`: of the target against the axes of the scan, about its centre.
double TargetPicture::agreement(bool mirrored, int quarter_turns, double tilt_rad) const {
  constexpr int grid = 2 * target_units;
  const double middle_a = (a_.first + a_.last) / 2;
  const double middle_b = (b_.first + b_.last) / 2;
  int balance = 0;
  for (int j = 0; j < grid; ++j)
    for (int i = 0; i < grid; ++i) {
      const double u = (i + 0.5) / grid - 0.5;
      const double v = (j + 0.5) / grid - 0.5;
      const int a =
          static_cast<int>(std::lround(middle_a + (u - v * tilt_rad) * (a_.last - a_.first)));
      const int b =
          static_cast<int>(std::lround(middle_b + (v + u * tilt_rad) * (b_.last - b_.first)));
      const Place place = drawing_place(u + 0.5, v + 0.5, mirrored, quarter_turns);
      balance += bright(std::clamp(a, 0, a_scans_ - 1), std::clamp(b, 0, b_scans_ - 1)) ==
                         target_reflects(place.x, place.y)
                     ? 1
                     : -1;
    }
  return static_cast<double>(balance) / (grid * grid);
}

std::string TargetPicture::seen() const {
  return fmt::format("{:.0f} % of the field are bright, by {:.1f} dB, and span {:.0f} % of the "
                     "A-scans and {:.0f} % of the B-scans",
                     100 * bright_share_, contrast_db_, 100 * (a_.last - a_.first) / a_scans_,
                     100 * (b_.last - b_.first) / b_scans_);
}

bool TargetPicture::reaches_border(bool along_a, bool first) const {
  constexpr double noise_alone = 0.04; // of the border's places that may be bright
  const int across = along_a ? b_scans_ : a_scans_;
  const int border = first ? 0 : (along_a ? a_scans_ : b_scans_) - 1;
  int reached = 0;
  for (int j = 0; j < across; ++j)
    reached += (along_a ? bright(border, j) : bright(j, border)) ? 1 : 0;
  return reached > noise_alone * across;
}

// The remedy of what is most probably wrong.
std::string TargetPicture::likely_reason() const {
  constexpr double least_samples = 3; // a bar
  const double a_samples = (a_.last - a_.first) * bar_width / target_units;
  const double b_samples = (b_.last - b_.first) * bar_width / target_units;
  if (std::min(a_samples, b_samples) < least_samples)
    return fmt::format("It is too small in this field: a bar is {:.1f} {}-scans wide, expected at "
                       "least {:.0f}; scan a smaller field, or take a larger target.",
                       std::min(a_samples, b_samples), a_samples < b_samples ? 'A' : 'B',
                       least_samples);
  for (const bool along_a : {true, false})
    for (const bool first : {true, false})
      if (reaches_border(along_a, first))
        return fmt::format(
            "It reaches the {} {}-scan: is it wholly within the field? Move it, scan "
            "a larger field, or take a smaller target.",
            first ? "first" : "last", along_a ? 'A' : 'B');
  return "Is it the target, flat, in focus, and turned by a few degrees at most against the axes "
         "of the scan?";
}

hal::Result<TargetMeasurement> TargetPicture::find_orientation() const {
  constexpr double least_agreement = 0.7;
  constexpr double least_lead = 0.15;
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
        "next way round by {:.2f}, expected {:.2f} and a lead of {:.2f}. {}. {}",
        best.agreement, best.runner_up, least_agreement, least_lead, seen(), likely_reason());
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
  std::size_t cut = 0; // bars at the border, whose centre is not known
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
    else
      ++cut;
  }
  if (rose)
    ++cut;
  const auto expected = static_cast<std::size_t>(x_axis ? x_bars : y_bars);
  if (centres.size() + cut != expected)
    return hal::fail(ErrorCode::bad_data,
                     "{} bars are seen along the {}-scans, expected {}. {}. {}",
                     centres.size() + cut, along_a ? 'A' : 'B', expected, seen(), likely_reason());
  const double middle = (static_cast<double>(centres.size()) - 1) / 2;
  double slope = 0;
  double weight = 0;
  for (std::size_t n = 0; n < centres.size(); ++n) {
    const double step = static_cast<double>(n) - middle;
    slope += step * centres[n];
    weight += step * step;
  }
  return slope / weight;
}

hal::Result<TargetMeasurement> TargetPicture::measure(double side_um) {
  HAL_CHECK(find_threshold());
  a_ = find_extent(true);
  b_ = find_extent(false);
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

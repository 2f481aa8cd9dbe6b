// Chooses how finely the volume is drawn so that the frame rate holds. Pure: times are arguments.
//
// A frame's cost is a fixed part (panels, text, compositing) and a part that grows with the samples
// taken. Both are learnt from the frames that are drawn anyway, for each technique and for each
// step of the ladder of qualities, as medians of the last few: one interrupted frame changes
// nothing. A finer quality is taken only where it is predicted to stay well below the budget, a
// coarser one only where the budget is exceeded, and what a quality has cost is remembered: the
// choice cannot swing between two neighbours. Where a quality takes but half of the budget, the
// next finer one is tried once, whatever is predicted.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "hal/clock.h"
#include "ui/view/draw_quality.h"
#include "ui/view/technique.h"

namespace octascope::ui {

// From full quality down, each step about three quarters of the one before it in cost.
std::span<const DrawQuality> quality_ladder();

// Of the samples that full quality takes; what a quality costs beyond the fixed part, relatively.
double sample_share(const DrawQuality& quality);

// That share where it is so small that one sees it, for the display to say so.
std::optional<float> visible_reduction(const DrawQuality& quality);

struct FrameBudget {
  hal::Duration moving;  // while the view or the window changes: the rate of frames matters
  hal::Duration resting; // while only volumes come: their latency matters
};

// Threads: one at a time. Allocates nothing.
class Governor {
public:
  explicit Governor(const FrameBudget& budget) : budget_(budget) {}

  void set_budget(const FrameBudget& budget) { budget_ = budget; }

  struct Situation {
    hal::TimePoint now;
    Technique technique = Technique::rays;
    bool moved = false; // what was asked for differs from the last frame's
    bool live = true;   // volumes keep coming; else the picture is drawn once and may take its time
  };

  // For the frame that begins now. At rest and not live, or where the budget allows it: full.
  DrawQuality choose(const Situation& situation);

  // What that frame cost, from its beginning until it was drawn.
  void note(hal::Duration cost, bool volume_drawn);

  // How long after the last movement the view counts as resting.
  static constexpr hal::Duration rest_after = std::chrono::milliseconds{250};

private:
  static constexpr std::size_t kept = 7;
  static constexpr std::size_t most_rungs = 16;

  // Of the last few values.
  class Median {
  public:
    void add(double value) { values_[count_++ % kept] = value; }
    void clear() { count_ = 0; }
    bool empty() const { return count_ == 0; }
    double value() const; // only where there is one

  private:
    std::array<double, kept> values_{};
    std::size_t count_ = 0;
  };

  // What is known of a technique: cost = fixed + full · sample_share · correction.
  struct Knowledge {
    Median full_ms;
    std::array<double, most_rungs> correction;
    std::array<double, most_rungs> learnt_at_ms{}; // full_ms then; 0: never
    bool compared = false;                         // more than one quality was drawn
    Knowledge() { correction.fill(1); }
  };

  // Where one technique stands on the ladder in one situation.
  struct Place {
    std::size_t rung = 4;   // until something is known
    std::size_t frames = 0; // drawn there since it came there
    Median sampling_ms;
    Median frame_ms;
  };

  double predict_ms(const Knowledge& knowledge, std::size_t rung) const;
  void settle(Place& place, Knowledge& knowledge, double budget_ms) const;
  static void enter(Place& place, std::size_t rung);
  static bool worth_trying(const Knowledge& knowledge, std::size_t rung);
  void learn(Place& place, Knowledge& knowledge, double sampling_ms, double budget_ms) const;
  double budget_ms() const;

  FrameBudget budget_;
  Median fixed_ms_;
  std::array<Knowledge, all_techniques.size()> knowledge_;
  std::array<std::array<Place, 2>, all_techniques.size()> places_; // resting, moving
  hal::TimePoint still_since_{};
  bool moving_ = false;
  bool still_ = false; // the frame is one that may take its time
  std::size_t technique_ = 0;
};

} // namespace octascope::ui

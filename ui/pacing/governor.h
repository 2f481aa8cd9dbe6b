// Chooses how finely the volume is drawn so that the frame rate holds. Pure: times are arguments.
//
// A frame's cost is a fixed part (panels, text, compositing) and a part that grows with the samples
// taken. Both are learnt from drawn frames, for each technique and each step of the quality ladder,
// as medians of the last few, so that one interrupted frame changes nothing. A finer quality is
// chosen only if predicted to stay well below the budget, a coarser one only if the budget is
// exceeded; since past costs are remembered, the choice cannot oscillate between two neighbours.
// Where a quality takes only half of the budget, the next finer one is tried once, whatever is
// predicted.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "hal/clock.h"
#include "ui/view/draw_quality.h"
#include "ui/view/technique.h"

namespace octascope::ui {

// From full quality down; each step costs about three quarters of the one before.
std::span<const DrawQuality> quality_ladder();

// Share of the samples at full quality: the relative cost of a quality beyond the fixed part.
double sample_share(const DrawQuality& quality);

// That share if it is visibly reduced, for the display to say so; else empty.
std::optional<float> visible_reduction(const DrawQuality& quality);

struct FrameBudget {
  hal::Duration moving;  // while the view or the window changes: the frame rate matters
  hal::Duration resting; // while only volumes arrive: their latency matters
};

// Threads: one at a time. Allocates nothing.
class Governor {
public:
  explicit Governor(const FrameBudget& budget) : budget_(budget) {}

  void set_budget(const FrameBudget& budget) { budget_ = budget; }

  struct Situation {
    hal::TimePoint now;
    Technique technique = Technique::rays;
    bool moved = false; // the request differs from the last frame's
    bool live = true;   // volumes keep arriving; else the picture is drawn once and may take its
                        // time
  };

  // The quality for the frame that begins now. Full if at rest and not live, or if the budget
  // allows.
  DrawQuality choose(const Situation& situation);

  // The cost of that frame, from its beginning until it was drawn.
  void note(hal::Duration cost, bool volume_drawn);

  // How long after the last movement the view counts as resting.
  static constexpr hal::Duration rest_after = std::chrono::milliseconds{250};

  // The predicted cost of a frame; 0 while the technique is unknown.
  hal::Duration predict(Technique technique, const DrawQuality& quality) const;

private:
  static constexpr std::size_t kept = 7;
  static constexpr std::size_t most_rungs = 16;

  // Of the last few values.
  class Median {
  public:
    void add(double value) { values_[count_++ % kept] = value; }
    void clear() { count_ = 0; }
    bool empty() const { return count_ == 0; }
    double value() const; // undefined if empty

  private:
    std::array<double, kept> values_{};
    std::size_t count_ = 0;
  };

  // The model of a technique: cost = fixed + full · sample_share · correction.
  struct Knowledge {
    Median full_ms;
    std::array<double, most_rungs> correction;
    std::array<double, most_rungs> learnt_at_ms{}; // full_ms at that time; 0: never
    bool compared = false;                         // more than one quality has been drawn
    Knowledge() { correction.fill(1); }
  };

  // A technique's place on the ladder in one situation.
  struct Place {
    std::size_t rung = 4;   // until something is known
    std::size_t frames = 0; // frames drawn since it moved there
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
  bool still_ = false; // the frame may take its time
  std::size_t technique_ = 0;
};

} // namespace octascope::ui

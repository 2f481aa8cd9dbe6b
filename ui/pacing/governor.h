// Chooses the volume's drawing quality so that the frame rate holds. Pure: times are arguments.
//
// A frame's cost has a fixed part (panels, text, compositing) and a part that grows with the number
// of samples. Both are learnt from ordinary frames, per technique and per step of the quality
// ladder, as medians of the last few frames, so that one interrupted frame changes nothing; a whole
// frame that costs less than the fixed part is thought to refutes what was learnt. A finer quality
// is chosen only if it is predicted to stay well below the budget, a coarser one only if the budget
// is exceeded. Measured costs are remembered, so the choice does not oscillate between
// two neighbours. If a quality takes only half of the budget, the next finer one is tried once,
// whatever the prediction.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "hal/clock.h"
#include "ui/view/draw_quality.h"
#include "ui/view/technique.h"

namespace octascope::ui {

// From full quality down; each step costs about three quarters of the one before it.
std::span<const DrawQuality> quality_ladder();

// The share of the samples of full quality: the relative cost beyond the fixed part.
double sample_share(const DrawQuality& quality);

// That share if the reduction is visible and the display should say so; else empty.
std::optional<float> visible_reduction(const DrawQuality& quality);

struct FrameBudget {
  hal::Duration moving;  // while the view or the window changes: the frame rate matters
  hal::Duration resting; // while only new volumes arrive: their latency matters
  // Moving rays of the processor may take so long before they are coarser than coarsest_at_rest.
  hal::Duration moving_cast{};
};

struct DrawnHow {
  bool software = false;          // by the processor
  bool rolling = false;           // B-scans come all the time
  bool in_parts = false;          // of a view at rest only what changed
  bool waits_for_refresh = false; // the output shows an image at the refresh after it is ready
};

// With a GPU every refresh of a moving view gets a frame, and a volume that comes while the view rests
// may take two. Where the processor draws, a frame of a moving view takes two refreshes of an output that
// waits for them: what takes a little more than one would gain nothing by being coarser. On others it takes 0.9,
// as they hold the renderer for whole refreshes, too, and bringing a volume takes the rest of some of them; but
// moving rays are no coarser than those at rest while 30 pictures/s can be drawn so. A picture of a new volume
// while the view rests takes one and a half. Of what rolls, each refresh shows what has come where only that is
// drawn anew; copying it takes its time, too.
FrameBudget frame_budget(hal::Duration refresh, const DrawnHow& how);

// Threads: one at a time. Allocates nothing.
class Governor {
public:
  explicit Governor(const FrameBudget& budget) : budget_(budget) {}

  void set_budget(const FrameBudget& budget) { budget_ = budget; }

  struct Situation {
    hal::TimePoint now;
    Technique technique = Technique::rays;
    bool moved = false; // the request differs from the last frame's
    bool live = true;   // volumes keep coming; else the picture is drawn once and may take longer
    bool cast = false;  // by the processor's rays: at rest never below coarsest_at_rest,
                        // moving only if that takes longer than moving_cast
  };

  // Most of what a frame of few rays costs is its fixed part: of a view at rest, which is looked at,
  // still fewer would blur the picture and gain next to nothing.
  static constexpr DrawQuality coarsest_at_rest{0.5F, 192};

  // For the frame that begins now. Full quality at rest without live volumes, or within budget.
  DrawQuality choose(const Situation& situation);

  // The most that any of the last few frames cost whose volume's picture was not redrawn.
  hal::Duration longest_fixed_cost() const;

  // Reports the cost of that frame, from its beginning until it was drawn.
  void note(hal::Duration cost, bool volume_drawn);

  // The view counts as resting this long after the last movement.
  static constexpr hal::Duration rest_after = std::chrono::milliseconds{250};

private:
  static constexpr std::size_t kept = 7;
  static constexpr std::size_t most_rungs = 16;

  // The median and the largest of the last few values.
  class Recent {
  public:
    void add(double value) { values_[count_++ % kept] = value; }
    void clear() { count_ = 0; }
    bool empty() const { return count_ == 0; }
    double median() const;  // not to be called when empty
    double longest() const; // neither

  private:
    std::array<double, kept> values_{};
    std::size_t count_ = 0;
  };

  // What is known about a technique: cost = fixed + full · sample_share · correction.
  struct Knowledge {
    Recent full_ms;
    std::array<double, most_rungs> correction;
    std::array<double, most_rungs> learnt_at_ms{}; // full_ms at that time; 0: never
    bool compared = false;                         // more than one quality was drawn
    Knowledge() { correction.fill(1); }
  };

  // The position of one technique on the ladder, in one situation.
  struct Place {
    std::size_t rung = 4;   // initial guess
    std::size_t frames = 0; // drawn since it moved to this rung
    Recent sampling_ms;
    Recent frame_ms;
  };

  double predict_ms(const Knowledge& knowledge, std::size_t rung) const;
  void settle(Place& place, Knowledge& knowledge, double budget_ms, std::size_t coarsest) const;
  static void enter(Place& place, std::size_t rung);
  static bool worth_trying(const Knowledge& knowledge, std::size_t rung);
  void learn(Place& place, Knowledge& knowledge, double sampling_ms, double budget_ms) const;
  void forget_what_cannot_be(double frame_ms);
  bool can_move_as_it_rests() const;
  std::size_t coarsest_rung(bool cast) const;
  double budget_ms() const;

  FrameBudget budget_;
  Recent fixed_ms_;
  std::array<Knowledge, all_techniques.size()> knowledge_;
  std::array<std::array<Place, 2>, all_techniques.size()> places_; // resting, moving
  hal::TimePoint still_since_{};
  bool moving_ = false;
  bool still_ = false; // the frame may take longer
  std::size_t technique_ = 0;
};

} // namespace octascope::ui

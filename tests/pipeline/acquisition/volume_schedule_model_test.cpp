// Random schedules against a model that knows what truly happened: which sweep each frame was of,
// what came, what was made. Frames are lost, late and doubled, workers are slow, pulses fail, volumes
// are passed over, the thread oversleeps; every decision is checked, and the books balance.
#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/acquisition/volume_scheduler.h"
#include "pipeline/threads/triple_buffer.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

struct TrueVolume {
  std::uint64_t number = 0;
  std::optional<std::uint32_t> buffer; // while it is under way
  hal::TimePoint begin;                // of its first sweep
  std::set<int> placed;                // sweeps
  std::set<int> submitted;             // B-scans
  int made = 0;
  bool passed_over = false;
  std::optional<hal::TimePoint> waits_since; // for a look at the camera
};

struct Event {
  TrueVolume* volume = nullptr;
  std::optional<int> sweep; // whose frame comes; empty: a B-scan is made
  hal::TimePoint first_line;
};

class ScheduleModel {
public:
  explicit ScheduleModel(unsigned seed)
      : random_(seed), plan_(random_plan()), scheduler_(plan_, std::nullopt) {
    lost_share_ = pick<double>({0, 0.05, 0.4});
    doubled_share_ = pick<double>({0, 0.1});
    late_share_ = pick<double>({0, 0, 0.2});
    failed_share_ = pick<double>({0, 0.2});
    away_share_ = pick<double>({0, 0.2});
    passed_share_ = pick<double>({0, 0, 0.3, 0.8});
    oversleep_share_ = pick<double>({0, 0, 0.02});
    unlooked_share_ = pick<double>({0, 0.3, 1});
    most_work_ = pick<hal::Duration>({0ms, plan_.frame_period(), 4 * plan_.sweep_duration()});
  }

  void run() {
    scheduler_.begin(first_tick_);
    const hal::TimePoint end = now_ + 30 * plan_.tick_period();
    while (now_ < end && !testing::Test::HasFailure()) {
      if (scheduler_.tick_due(now_))
        tick();
      take_events();
      decide();
      if (chance(0.3))
        shown_.take();
      now_ = next_time();
    }
    check_books();
  }

private:
  ScanPlan random_plan() {
    ScanPlan plan;
    plan.a_scans = between(1, 6);
    plan.fly_back_lines = between(0, 3);
    plan.bidirectional = chance(0.3);
    plan.turn_around_lines = between(0, 3);
    plan.b_scans = between(1, 6);
    plan.repeats = between(1, ScanPlan::most_repeats);
    plan.line_rate_hz = 1000.0 * plan.lines_per_frame(); // a sweep lasts 1 ms
    return plan;
  }

  int between(int lowest, int highest) {
    return std::uniform_int_distribution{lowest, highest}(random_);
  }
  bool chance(double share) { return std::bernoulli_distribution{share}(random_); }
  hal::Duration up_to(hal::Duration most) {
    return hal::Duration{std::uniform_int_distribution<std::int64_t>{0, most.count()}(random_)};
  }
  template <typename T> T pick(std::vector<T> values) {
    return values[static_cast<std::size_t>(between(0, static_cast<int>(values.size()) - 1))];
  }

  // Of what the scheduler knows of a volume's begin.
  hal::Duration tolerance() const { return plan_.frame_period() / 5; }
  hal::TimePoint accepts_until(const TrueVolume& volume) const {
    return volume.begin + plan_.sweep_duration() + plan_.sweep_duration() / 6;
  }

  // Nothing but events and next_wake() ever wakes the thread, and it wakes a little late. Now and
  // then it sleeps until another tick: then pulses stay about a tick apart, and a frame's time
  // tells its sweep whatever was lost (sweep_tracker.h).
  hal::TimePoint next_time() {
    hal::TimePoint time = scheduler_.next_wake(now_);
    if (!events_.empty())
      time = std::min(time, std::max(events_.begin()->first, now_));
    overslept_ = chance(oversleep_share_);
    if (overslept_) {
      const auto ticks = (time - first_tick_) / plan_.tick_period() + between(1, 4);
      time = first_tick_ + ticks * plan_.tick_period();
    }
    return time + up_to(plan_.frame_period() / 10);
  }

  void tick() {
    const TickDecision decision = scheduler_.tick(now_);
    if (!overslept_) {
      EXPECT_EQ(decision.slept_through, 0U) << "next_wake() was too late";
    }
    planned_ += decision.slept_through;
    lose_whole(decision.slept_through);
    ASSERT_TRUE(decision.pulse);
    if (chance(away_share_)) {
      scheduler_.not_ready();
      if (!volumes_.empty()) {
        ++planned_;
        lose_whole(1);
      }
      return;
    }
    ++planned_;
    if (chance(failed_share_)) {
      scheduler_.pulse_failed();
      lose_whole(1);
      return;
    }
    pulse();
  }

  void pulse() {
    auto& volume = *volumes_.emplace_back(std::make_unique<TrueVolume>());
    volume.number = planned_;
    volume.begin =
        volumes_.size() == 1
            ? now_
            : std::max(now_, volumes_[volumes_.size() - 2]->begin + plan_.sweep_duration());
    if (chance(passed_share_))
      pass_over(volume);
    else
      build(volume);
    send_frames(volume);
  }

  void pass_over(TrueVolume& volume) {
    scheduler_.pass_over(now_);
    volume.passed_over = true;
    if (passed_over_.size() == SweepTracker::volumes) {
      lose_whole(1);
      return;
    }
    volume.buffer = VolumeScheduler::pool_size; // or another one that is none of the pool
    passed_over_.push_back(&volume);
  }

  void build(TrueVolume& volume) {
    volume.buffer = scheduler_.pulsed(now_);
    if (volume.buffer) {
      EXPECT_NE(volume.buffer, shown_.front()) << "the renderer has it";
      EXPECT_NE(volume.buffer, waiting_to_be_shown_);
      for (const TrueVolume* const other : under_way_)
        EXPECT_NE(other->buffer, volume.buffer);
      under_way_.push_back(&volume);
    } else {
      EXPECT_EQ(under_way_.size(), 3U);
      lose_whole(1);
    }
  }

  void send_frames(TrueVolume& volume) {
    const bool all_lost = chance(lost_share_ / 2);
    for (int sweep = 0; sweep < plan_.sweeps(); ++sweep) {
      if (all_lost || chance(lost_share_))
        continue;
      const hal::TimePoint first_line = volume.begin + sweep * plan_.frame_period() +
                                        up_to(plan_.frame_period() / 10) -
                                        plan_.frame_period() / 20;
      hal::TimePoint comes = first_line + plan_.frame_period();
      if (chance(late_share_))
        comes += up_to(2 * plan_.sweep_duration());
      events_.emplace(comes, Event{&volume, sweep, first_line});
      if (chance(doubled_share_))
        events_.emplace(comes + up_to(plan_.sweep_duration()), Event{&volume, sweep, first_line});
    }
  }

  void take_events() {
    while (!events_.empty() && events_.begin()->first <= now_) {
      const Event event = events_.begin()->second;
      events_.erase(events_.begin());
      if (event.sweep) {
        place(*event.volume, *event.sweep, event.first_line);
      } else {
        ++event.volume->made;
        scheduler_.b_scan_made(*event.volume->buffer);
      }
    }
  }

  void place(TrueVolume& volume, int sweep, hal::TimePoint first_line) {
    const int b_scan = sweep / plan_.repeats;
    const bool came = volume.placed.contains(sweep);
    const bool made = volume.submitted.contains(b_scan);
    const FrameDecision decision =
        scheduler_.place(first_line, first_line + plan_.frame_period() / 2);
    switch (decision.verdict) {
    case FrameVerdict::placed:
      EXPECT_FALSE(volume.passed_over);
      EXPECT_EQ(decision.buffer, volume.buffer);
      EXPECT_EQ(decision.b_scan, b_scan);
      EXPECT_EQ(decision.repeat, sweep % plan_.repeats);
      EXPECT_FALSE(came);
      EXPECT_FALSE(made);
      volume.placed.insert(sweep);
      break;
    case FrameVerdict::passed_over:
      EXPECT_TRUE(volume.passed_over);
      EXPECT_FALSE(came);
      EXPECT_TRUE(decision.submit.empty());
      volume.placed.insert(sweep);
      break;
    case FrameVerdict::doubled: EXPECT_TRUE(came); break;
    case FrameVerdict::late: EXPECT_TRUE(!volume.buffer || made); break;
    case FrameVerdict::outside: EXPECT_GE(volumes_.back()->number, volume.number + 3); break;
    }
    submit(volume, decision.submit);
  }

  void submit(TrueVolume& volume, std::span<const BScanJob> jobs) {
    for (const BScanJob& job : jobs) {
      EXPECT_EQ(job.buffer, volume.buffer);
      EXPECT_GT(count_placed(volume, job.b_scan), 0);
      EXPECT_TRUE(volume.submitted.insert(job.b_scan).second) << "twice";
      events_.emplace(now_ + up_to(most_work_), Event{&volume, std::nullopt, {}});
    }
  }

  std::ptrdiff_t count_placed(const TrueVolume& volume, int b_scan) const {
    return std::ranges::count(volume.placed, b_scan,
                              [this](int sweep) { return sweep / plan_.repeats; });
  }

  void decide() {
    const bool streaming = !chance(away_share_);
    if (!chance(unlooked_share_))
      looked_until_ = now_;
    while (!testing::Test::HasFailure()) {
      TrueVolume* const built = oldest_of(under_way_, streaming);
      TrueVolume* const passed = oldest_of(passed_over_, streaming);
      const VolumeDecision decision = scheduler_.next(now_, looked_until_, streaming);
      if (decision.action == VolumeDecision::Action::wait) {
        for (const TrueVolume* const volume : {built, passed})
          if (volume != nullptr)
            check_wait(*volume, streaming);
        return;
      }
      TrueVolume* const oldest = decision.buffer < VolumeScheduler::pool_size ? built : passed;
      ASSERT_NE(oldest, nullptr);
      if (oldest == built) {
        EXPECT_EQ(decision.buffer, oldest->buffer) << "the oldest first";
      }
      act(*oldest, decision);
    }
  }

  // Notes since when it waits for a look at the camera, if it does.
  TrueVolume* oldest_of(const std::vector<TrueVolume*>& volumes, bool streaming) const {
    if (volumes.empty())
      return nullptr;
    TrueVolume& oldest = *volumes.front();
    if (!oldest.waits_since && is_over(oldest) && waits_for_look(oldest, streaming))
      oldest.waits_since = now_;
    return &oldest;
  }

  bool is_whole(const TrueVolume& volume) const {
    return static_cast<int>(volume.placed.size()) == plan_.sweeps();
  }
  bool is_made(const TrueVolume& volume) const {
    return volume.made == static_cast<int>(volume.submitted.size());
  }

  bool is_over(const TrueVolume& volume) const {
    return now_ >= accepts_until(volume) + tolerance();
  }
  bool waits_for_look(const TrueVolume& volume, bool streaming) const {
    return streaming && looked_until_ < accepts_until(volume) + tolerance();
  }

  void check_wait(const TrueVolume& volume, bool streaming) const {
    EXPECT_FALSE(is_whole(volume) && is_made(volume)) << "nothing to wait for";
    if (!is_over(volume) || !is_made(volume))
      return;
    EXPECT_TRUE(waits_for_look(volume, streaming)) << "there is nothing to wait for";
    EXPECT_LT(now_, *volume.waits_since + plan_.sweep_duration() / 2) << "for longer than it may";
  }

  void act(TrueVolume& volume, const VolumeDecision& decision) {
    if (!is_whole(volume)) {
      EXPECT_GE(now_, accepts_until(volume) - tolerance()) << "given up too soon";
    }
    switch (decision.action) {
    case VolumeDecision::Action::wait: break;
    case VolumeDecision::Action::look: EXPECT_LT(looked_until_, decision.look_until); break;
    case VolumeDecision::Action::submit:
      EXPECT_FALSE(decision.submit.empty());
      submit(volume, decision.submit);
      break;
    case VolumeDecision::Action::lose:
      EXPECT_TRUE(volume.placed.empty());
      lose_whole(1);
      leave(volume);
      break;
    case VolumeDecision::Action::pass:
      EXPECT_TRUE(volume.passed_over);
      ++passed_over_volumes_;
      count_lost(volume, decision.volume);
      leave(volume);
      break;
    case VolumeDecision::Action::publish: publish(volume, decision.volume); break;
    }
  }

  void publish(TrueVolume& volume, const FinishedVolume& finished) {
    EXPECT_FALSE(volume.passed_over);
    EXPECT_TRUE(is_made(volume));
    EXPECT_EQ(volume.submitted, b_scans_of(volume)) << "all that came is shown";
    count_lost(volume, finished);
    ++acquired_;
    const auto [recycled, skipped] = shown_.publish(*volume.buffer);
    waiting_to_be_shown_ = *volume.buffer;
    skipped_ += skipped ? 1 : 0;
    scheduler_.published(recycled, skipped);
    leave(volume);
  }

  std::set<int> b_scans_of(const TrueVolume& volume) const {
    std::set<int> b_scans;
    for (const int sweep : volume.placed)
      b_scans.insert(sweep / plan_.repeats);
    return b_scans;
  }

  void count_lost(const TrueVolume& volume, const FinishedVolume& finished) {
    EXPECT_FALSE(volume.placed.empty());
    EXPECT_EQ(finished.number, volume.number);
    const int lost_b_scans = plan_.b_scans - static_cast<int>(b_scans_of(volume).size());
    const int lost_lines =
        (plan_.sweeps() - static_cast<int>(volume.placed.size())) * plan_.a_scans;
    EXPECT_EQ(finished.lost_b_scans, lost_b_scans);
    EXPECT_EQ(finished.lost_lines, lost_lines);
    lost_b_scans_ += static_cast<std::uint64_t>(lost_b_scans);
    lost_lines_ += static_cast<std::uint64_t>(lost_lines);
  }

  void leave(TrueVolume& volume) {
    std::erase(under_way_, &volume);
    std::erase(passed_over_, &volume);
    volume.buffer.reset();
  }

  void lose_whole(std::uint64_t volumes) {
    lost_volumes_ += volumes;
    lost_b_scans_ += volumes * static_cast<std::uint64_t>(plan_.b_scans);
    lost_lines_ += volumes * static_cast<std::uint64_t>(plan_.sweeps() * plan_.a_scans);
  }

  void check_books() {
    scheduler_.end();
    const VolumeCounters counters = scheduler_.counters();
    EXPECT_EQ(counters.planned, planned_);
    EXPECT_EQ(counters.triggered, volumes_.size());
    EXPECT_EQ(counters.acquired, acquired_);
    EXPECT_EQ(counters.published, acquired_);
    EXPECT_EQ(counters.skipped, skipped_);
    EXPECT_EQ(counters.lost_volumes, lost_volumes_);
    EXPECT_EQ(counters.lost_b_scans, lost_b_scans_);
    EXPECT_EQ(counters.lost_lines, lost_lines_);
    EXPECT_EQ(counters.passed_over, passed_over_volumes_);
    EXPECT_EQ(counters.unfinished, under_way_.size() + passed_over_.size());
    EXPECT_EQ(counters.planned, counters.acquired + counters.passed_over + counters.lost_volumes +
                                    counters.unfinished);
  }

  std::mt19937 random_;
  ScanPlan plan_;
  VolumeScheduler scheduler_;
  TripleBuffer shown_{VolumeScheduler::first_middle, VolumeScheduler::first_front};
  std::uint32_t waiting_to_be_shown_ = VolumeScheduler::first_middle;
  double lost_share_, doubled_share_, late_share_, failed_share_, away_share_, oversleep_share_,
      unlooked_share_, passed_share_;
  hal::Duration most_work_;

  const hal::TimePoint first_tick_{10s};
  hal::TimePoint now_ = first_tick_;
  hal::TimePoint looked_until_;
  bool overslept_ = false;
  std::multimap<hal::TimePoint, Event> events_;
  std::vector<std::unique_ptr<TrueVolume>> volumes_; // all that were pulsed, in order
  std::vector<TrueVolume*> under_way_;               // that are built; oldest first
  std::vector<TrueVolume*> passed_over_;             // likewise
  std::uint64_t planned_ = 0, acquired_ = 0, passed_over_volumes_ = 0, skipped_ = 0,
                lost_volumes_ = 0, lost_b_scans_ = 0, lost_lines_ = 0;
};

TEST(VolumeSchedule, is_right_at_every_step_and_its_books_balance) {
  constexpr unsigned first_seed = 24000;
  constexpr unsigned schedules = 500;
  std::cout << "seeds " << first_seed << " to " << first_seed + schedules - 1 << '\n';
  for (unsigned i = 0; i < schedules && !HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << first_seed + i);
    ScheduleModel{first_seed + i}.run();
  }
}

} // namespace
} // namespace octascope::pipeline

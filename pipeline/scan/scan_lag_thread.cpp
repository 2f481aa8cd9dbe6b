#include "pipeline/scan/scan_lag_thread.h"

#include <fmt/format.h>

#include "pipeline/scan/sweep_alignment.h"
#include "pipeline/threads/heartbeat.h"

namespace octascope::pipeline {

using namespace std::chrono_literals;

namespace {

constexpr std::uint64_t used_to_settle = 4;
constexpr hal::Duration pause_when_settled = 500ms;
constexpr hal::Duration longest_wait = 100ms; // also how soon a stop is noticed

// Of one line and one sweep: what a sketch of a scan that is not searched takes.
ScanPlan plan_to_sketch(const ScanPlan& plan) {
  return plan.bidirectional && plan.find_scan_lag
             ? plan
             : ScanPlan{.samples = 16, .a_scans = 1, .fly_back_lines = 0, .b_scans = 1};
}

} // namespace

ScanLagThread::ScanLagThread(const ScanPlan& plan, hal::Clock& clock, FaultLog& faults)
    : plan_(plan), clock_(clock), faults_(faults), downsampled_(plan_to_sketch(plan)),
      estimator_(plan_to_sketch(plan)), tracker_(plan.scan_lag_a_scans),
      in_use_a_scans_(plan.bidirectional ? plan.scan_lag_a_scans : 0) {}

void ScanLagThread::start(const ThreadSetup& setup) {
  if (!searches())
    return;
  thread_.start({"phase"}, setup, [this] { run(); });
}

DownsampledSweep* ScanLagThread::borrow() {
  if (!searches() || state_.load(std::memory_order_acquire) != Sketch::free)
    return nullptr;
  state_.store(Sketch::drawn_on, std::memory_order_relaxed);
  downsampled_.clear();
  return &downsampled_;
}

void ScanLagThread::finished() {
  state_.store(Sketch::drawn, std::memory_order_release);
  wakeup_.post();
}

ScanLagStatus ScanLagThread::status() const {
  return {.in_use_a_scans = in_use_a_scans(),
          .automatic = searches(),
          .used = used_.load(),
          .refused = refused_.load(),
          .correlation = correlation_.load(),
          .significance = significance_.load()};
}

void ScanLagThread::run() {
  while (!thread_.stopping()) {
    Heartbeat::beat_here(clock_.now());
    wakeup_.wait_until(clock_, clock_.now() + longest_wait);
    if (state_.load(std::memory_order_acquire) != Sketch::drawn)
      continue;
    look();
    if (tracker_.used() >= used_to_settle && !wait(pause_when_settled))
      break;
    state_.store(Sketch::free, std::memory_order_release);
  }
}

void ScanLagThread::look() {
  const ScanLagEstimate estimate = estimator_.estimate(downsampled_);
  const bool changed = tracker_.update(estimate);
  correlation_.store(estimate.correlation, std::memory_order_relaxed);
  significance_.store(estimate.significance, std::memory_order_relaxed);
  used_.store(tracker_.used(), std::memory_order_relaxed);
  refused_.store(tracker_.refused(), std::memory_order_relaxed);
  if (!changed)
    return;
  in_use_a_scans_.store(tracker_.in_use_a_scans(), std::memory_order_release);
  complain_about_ends();
}

void ScanLagThread::complain_about_ends() {
  const SweepAlignment alignment{plan_, tracker_.in_use_a_scans()};
  const int repeated = alignment.repeated_a_scans();
  if (repeated <= 1)
    return;
  faults_.add(
      Fault::phase_beyond_turn_around,
      fmt::format("the mirror lags by {:.1f} A-scans, the {} turn-around lines do not reach "
                  "so far: the outermost {} A-scans repeat their neighbour; set "
                  "turn_around_lines to {}",
                  tracker_.in_use_a_scans(), plan_.turn_around_lines, repeated,
                  plan_.turn_around_lines + repeated),
      clock_.now());
}

bool ScanLagThread::wait(hal::Duration how_long) {
  const hal::TimePoint until = clock_.now() + how_long;
  while (clock_.now() < until && !thread_.stopping())
    wakeup_.wait_until(clock_, std::min(until, clock_.now() + longest_wait));
  return !thread_.stopping();
}

} // namespace octascope::pipeline

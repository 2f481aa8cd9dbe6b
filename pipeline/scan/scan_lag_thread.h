// Tracks the scan lag of a bidirectional scan off the hot path: an ordinary thread that analyses a
// downsampled volume from time to time.
#pragma once

#include <atomic>
#include <cstdint>

#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/scan/downsampled_sweep.h"
#include "pipeline/scan/scan_lag_estimator.h"
#include "pipeline/scan/scan_lag_tracker.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::pipeline {

// For the report. The figures are those of the last estimate, used or not.
struct ScanLagStatus {
  double in_use_a_scans = 0;
  bool automatic = false; // false: the configured lag is always used
  std::uint64_t used = 0;
  std::uint64_t refused = 0;
  double correlation = 0;
  double significance = 0;
};

// There is one DownsampledSweep: the volume thread borrows it for a volume, its workers fill it,
// and it returns when the volume is finished. While it is borrowed or analysed, volumes are
// skipped.
// At first every volume is analysed, later one every half second: a mirror's lag changes slowly.
class ScanLagThread {
public:
  // `clock` and `faults` outlive this. If the plan is not to be searched, nothing is allocated or
  // started, and borrow() always returns null.
  ScanLagThread(const ScanPlan& plan, hal::Clock& clock, FaultLog& faults);

  void start(const ThreadSetup& setup);
  void stop() { thread_.stop(); }

  // Called by the volume thread. None allocates or waits.
  DownsampledSweep* borrow(); // cleared; null while unavailable
  void finished();            // the borrowed one is complete and can be analysed
  double in_use_a_scans() const { return in_use_a_scans_.load(std::memory_order_acquire); }

  // Any thread.
  ScanLagStatus status() const;

private:
  enum class Sketch : std::uint8_t { free, drawn_on, drawn };

  bool searches() const { return plan_.bidirectional && plan_.find_scan_lag; }
  void run();
  void look();
  void complain_about_ends();
  bool wait(hal::Duration how_long); // false: stopping

  ScanPlan plan_;
  hal::Clock& clock_;
  FaultLog& faults_;
  DownsampledSweep downsampled_;
  ScanLagEstimator estimator_;
  ScanLagTracker tracker_;
  Wakeup wakeup_;
  std::atomic<Sketch> state_{Sketch::free};
  std::atomic<double> in_use_a_scans_;
  std::atomic<double> correlation_{0}, significance_{0};
  std::atomic<std::uint64_t> used_{0}, refused_{0};
  RoleThread thread_{&wakeup_};
};

} // namespace octascope::pipeline

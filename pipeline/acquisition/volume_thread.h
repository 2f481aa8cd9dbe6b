// The fixed-rate thread: one tick, one trigger pulse, one volume.
//
// Each tick arms the galvo trigger. B-scans are handed to the workers as they come, not at the end
// of the sweeps, so that almost nothing is left to do when the last one arrives. A volume is
// published when it is complete, or, with its missing B-scans marked, shortly after its sweeps
// should have ended, once the camera's thread has looked at the camera that long: a late camera
// never delays the tick, and a busy machine makes no frame late that the camera gave in time.
//
// With several sweeps of each B-scan, a B-scan goes to a worker when all of them have come; when
// one is missing, once the B-scan after the next has begun, or when the volume's time is over. A
// B-scan is missing when none of its sweeps came.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "hal/clock.h"
#include "hal/galvo_trigger.h"
#include "pipeline/acquisition/acquisition.h"
#include "pipeline/acquisition/b_scan_builder.h"
#include "pipeline/acquisition/neighbour_average.h"
#include "pipeline/acquisition/volume_assembler.h"
#include "pipeline/acquisition/volume_feed.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/scan/scan_lag_thread.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/scan/sweep_alignment.h"
#include "pipeline/scan/sweep_tracker.h"
#include "pipeline/threads/duration_statistics.h"
#include "pipeline/threads/retry_delay.h"
#include "pipeline/threads/triple_buffer.h"
#include "pipeline/threads/wakeup.h"
#include "pipeline/threads/worker_pool.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// Called on the volume thread for each frame in the order of their coming, before a worker gets
// it, for what depends on that order; must not throw or allocate. May be empty.
using ObserveFrame = std::function<void(const hal::LineFrame& frame)>;

// Called on the volume thread with each volume that was published, when the renderer could have
// taken it already; must not throw, allocate or wait. May be empty.
using ObserveVolume = std::function<void(const Volume& volume)>;

struct VolumeThreadSetup {
  ScanPlan plan;
  hal::GalvoTriggerConfig trigger;
  std::size_t workers = 1;
  ReconstructSweep reconstruct;
  ObserveFrame observe = {};
  ObserveVolume observe_volume = {};
  NeighbourAverage average;
  std::optional<std::uint64_t> most_volumes; // then no more are triggered
};

struct PipelineStatistics {
  DurationStatistics reconstruct; // work of all workers for one volume
  DurationStatistics assemble;
  DurationStatistics publish;
};

class VolumeThread final : public VolumeFeed {
public:
  // All references outlive this; `arrived` is the one the acquisition posts, `news` is posted
  // after each published volume.
  VolumeThread(VolumeThreadSetup setup, hal::GalvoTrigger& trigger, Acquisition& acquisition,
               hal::LineCamera& camera, hal::Clock& clock, FaultLog& faults, Wakeup& arrived,
               Wakeup& news);
  ~VolumeThread() override;

  void start(const ThreadSetup& setup);

  // Ends thread and workers and closes the trigger; volumes under way are counted as unfinished.
  void stop();

  // Any thread.
  const PipelineStatistics& statistics() const { return statistics_; }
  ScanLagStatus phase() const { return phase_.status(); }

private:
  // A B-scan under construction, and the job that makes it.
  struct Position {
    std::array<hal::LineFrame, ScanPlan::most_repeats> frames; // buffer < 0: did not come (yet)
    std::uint32_t came = 0;                                    // one bit a repeat
    bool submitted = false; // from then on the frames are the worker's
  };
  // A volume under construction; one for each buffer of the pool.
  struct Construction {
    bool open = false;
    hal::TimePoint accept_until;
    std::optional<hal::TimePoint> give_up_at; // set when that was over and the camera not looked at
    SweepAlignment alignment;                 // of all its sweeps
    DownsampledSweep* sketch = nullptr;
    std::unique_ptr<VolumeAssembler> assembler;
    std::vector<Position> positions; // by B-scan
    int sweeps_came = 0;
    int submitted = 0;
    int flushed = 0;              // B-scans before this one wait for no more sweeps
    std::atomic<int> finished{0}; // B-scans that the workers are done with
    std::atomic<std::int64_t> work_ns{0};
    std::atomic<int> saturated_lines{0};
  };
  struct Counts {
    std::atomic<std::uint64_t> planned{0}, triggered{0}, acquired{0}, published{0}, skipped{0},
        lost_lines{0}, lost_b_scans{0}, lost_volumes{0}, unfinished{0}, saturated_lines{0};
  };

  // The renderer's side of the triple buffer.
  const Volume* do_take_newest() override;
  bool do_has_newer() const override { return triple_buffer_.has_newer(); }
  VolumeCounters do_counters() const override;

  static constexpr std::uint32_t pool_size = 5; // middle, renderer's, and three to build in

  void run();
  void tick();
  std::uint64_t under_way() const;
  bool enough_triggered() const;
  bool trigger_ready();
  void open_volume(hal::TimePoint armed);
  void count_lost_volume();
  void place(const hal::LineFrame& frame);
  void submit(std::uint32_t index, int b_scan);
  void flush(std::uint32_t index, int end);
  void release(Position& position);
  void reconstruct(std::size_t worker, std::uint32_t job);
  bool more_may_come(Construction& construction, hal::TimePoint looked_until) const;
  void finish_due_volumes(hal::TimePoint looked_until);
  void finish(std::uint32_t index);
  void fill_ledger(Volume& volume, const Construction& construction);
  std::uint32_t oldest_open() const;
  hal::TimePoint next_deadline() const;

  VolumeThreadSetup setup_;
  hal::GalvoTrigger& trigger_;
  Acquisition& acquisition_;
  hal::LineCamera& camera_;
  hal::Clock& clock_;
  FaultLog& faults_;
  Wakeup& arrived_;
  Wakeup& news_;

  std::vector<Volume> volumes_;
  std::array<Construction, pool_size> constructions_;
  std::vector<std::uint32_t> free_; // buffers of the pool to build in
  TripleBuffer triple_buffer_{0, 1};
  SweepTracker sweeps_;
  BScanBuilder builder_;
  ScanLagThread phase_;

  std::uint64_t last_number_ = 0;
  hal::TimePoint next_tick_;
  RetryDelay trigger_retry_;
  Counts counts_;
  PipelineStatistics statistics_;
  std::atomic<bool> stopping_{false};
  std::unique_ptr<WorkerPool> workers_;
  std::thread thread_;
};

} // namespace octascope::pipeline

// The fixed-rate thread: one tick, one trigger pulse, one volume.
//
// It wakes for ticks, frames and finished B-scans and does what the VolumeScheduler decides: pulses
// the trigger, hands B-scans to the workers, publishes volumes.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "hal/galvo_trigger.h"
#include "pipeline/acquisition/acquisition.h"
#include "pipeline/acquisition/b_scan_builder.h"
#include "pipeline/acquisition/neighbour_average.h"
#include "pipeline/acquisition/repeat_comparison.h"
#include "pipeline/acquisition/right_of_way.h"
#include "pipeline/acquisition/volume_assembler.h"
#include "pipeline/acquisition/volume_demand.h"
#include "pipeline/acquisition/volume_feed.h"
#include "pipeline/acquisition/volume_scheduler.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/scan/scan_lag_thread.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/scan/sweep_alignment.h"
#include "pipeline/threads/buffer_loan.h"
#include "pipeline/threads/duration_statistics.h"
#include "pipeline/threads/retry_delay.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/triple_buffer.h"
#include "pipeline/threads/wakeup.h"
#include "pipeline/threads/worker_pool.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// Called on the volume thread for each placed frame in order of arrival, before a worker gets it,
// for processing that depends on that order. Must not throw or allocate. May be empty.
using ObserveFrame = std::function<void(const hal::LineFrame& frame)>;

// Called on the volume thread after each volume is published, when the renderer may already have
// taken it. Must not throw, allocate or wait. May be empty.
using ObserveVolume = std::function<void(const Volume& volume)>;

// A frame and its place in a volume.
struct PlacedFrame {
  const hal::LineFrame& frame;
  std::uint64_t volume = 0; // what will be its VolumeMetadata::index
  int b_scan = 0;
  int repeat = 0;
  double scan_lag_a_scans = 0; // with which its volume is placed
};

// Called by a worker for each frame that it has converted, before the frame goes back to the camera.
// Must not throw, allocate or wait. May be empty.
using ObserveConverted = std::function<void(std::size_t worker, const PlacedFrame& placed)>;

// Called on the volume thread before each volume: whether it is wanted even if the renderer could not
// show it. Must not throw, allocate or wait. May be empty: no.
using WantsEveryVolume = std::function<bool()>;

struct VolumeThreadSetup {
  ScanPlan plan;
  hal::GalvoTriggerConfig trigger;
  std::size_t workers = 1;
  ReconstructSweep reconstruct;
  ObserveFrame observe = {};
  ObserveVolume observe_volume = {};
  ObserveConverted observe_converted = {};
  NeighbourAverage average;
  WantsEveryVolume wants_every_volume = {};
  std::optional<std::uint64_t> most_volumes; // stop triggering after this many that are published
  // Of the same plan and workers; empty: volumes have no flow. Where it is there, `reconstruct` is
  // not called.
  std::optional<RepeatComparison> comparison = std::nullopt;
};

// Any thread may read it. Zero without a comparison.
struct FlowStatistics {
  DurationStatistics tell;                // a worker's time for the flow of one B-scan
  std::atomic<std::uint64_t> volumes{0};  // published, all B-scans of which were compared
  std::atomic<std::uint64_t> told{0};     // B-scans of published volumes
  std::atomic<std::uint64_t> left_out{0}; // likewise: moved too far between sweeps
  std::atomic<std::uint64_t> none{0};     // likewise: not received whole, or no time for it
  std::atomic<std::uint64_t> no_time{0};  // B-scans for which there was none
};

struct PipelineStatistics {
  DurationStatistics reconstruct; // summed over all workers for one volume
  DurationStatistics assemble;
  DurationStatistics publish;
  FlowStatistics flow;
};

class VolumeThread final : public VolumeFeed {
public:
  // All references outlive this. `arrived` is the Wakeup that `acquisition` posts; `news` is posted
  // after each published volume.
  VolumeThread(VolumeThreadSetup setup, hal::GalvoTrigger& trigger, Acquisition& acquisition,
               hal::LineCamera& camera, hal::Clock& clock, FaultLog& faults, Wakeup& arrived,
               Wakeup& news);

  void start(const ThreadSetup& setup);

  // Ends the thread and its workers and closes the trigger. Volumes under way count as unfinished.
  void stop();

  // Any thread.
  const PipelineStatistics& statistics() const { return statistics_; }
  ScanLagStatus scan_lag() const { return scan_lag_.status(); }

private:
  // The frames of a B-scan, by repeat; buffer < 0: not arrived (yet), or given back. Owned by the
  // worker once the B-scan is submitted.
  using Sweeps = std::array<hal::LineFrame, ScanPlan::most_repeats>;
  // State for building a volume; one for each buffer of the pool.
  struct Workplace {
    SweepAlignment alignment; // of all its sweeps
    DownsampledSweep* sketch = nullptr;
    std::unique_ptr<VolumeAssembler> assembler;
    std::vector<Sweeps> sweeps; // by B-scan
    std::atomic<int> saturated_lines{0};
    std::uint64_t number = 0; // of the volume
  };

  const Volume* do_take_newest() override;
  bool do_has_newer() const override { return triple_buffer_.has_newer(); }
  std::optional<VolumeInMaking> do_borrow_after(std::uint64_t after) override;
  void do_give_back() override { loan_.give_back(); }
  void do_expect(Showing how) override;
  void do_note_begun() override { demand_.begun(clock_.now()); }
  void do_note_drawn() override;
  bool do_lends() const override { return true; }
  bool do_has_flow() const override { return builder_.compares(); }
  VolumeCounters do_counters() const override { return scheduler_.counters(); }

  void run();
  void tick();
  void pulse(hal::TimePoint now);
  bool trigger_ready();
  bool passes_over(hal::TimePoint now) const;
  void begin_volume(std::uint32_t buffer, hal::TimePoint pulsed);
  void place(const hal::LineFrame& frame);
  void note_last(VolumeMetadata& metadata, const hal::LineFrame& frame) const;
  void refuse(const hal::LineFrame& frame, FrameVerdict verdict);
  void submit(std::span<const BScanJob> jobs);
  void submit_held_back();
  void begin(std::span<const BScanJob> jobs);
  bool holds_back(hal::TimePoint now) const;
  void grant_right_of_way(hal::TimePoint published);
  hal::TimePoint next_wake() const;
  void show_converted(std::size_t worker, const Workplace& workplace, int b_scan) const;
  void release(Sweeps& sweeps);
  static void note_exposure(BScanWork& work, const Sweeps& sweeps);
  void reconstruct(std::size_t worker, std::uint32_t job);
  void tell_flow(std::size_t worker, Volume& volume, int b_scan);
  bool is_behind(const BScanWork& work, hal::TimePoint now) const;
  void finish_due_volumes(hal::TimePoint looked_until);
  void lose(std::uint32_t buffer);
  void publish(std::uint32_t buffer, const FinishedVolume& finished);
  void finish_flow(Volume& volume);
  void fill_ledger(Volume& volume, const Workplace& workplace, const FinishedVolume& finished);

  VolumeThreadSetup setup_;
  hal::GalvoTrigger& trigger_;
  Acquisition& acquisition_;
  hal::LineCamera& camera_;
  hal::Clock& clock_;
  FaultLog& faults_;
  Wakeup& arrived_;
  Wakeup& news_;

  std::vector<Volume> volumes_;
  std::array<Workplace, VolumeScheduler::pool_size> workplaces_;
  TripleBuffer triple_buffer_{VolumeScheduler::first_middle, VolumeScheduler::first_front};
  BufferLoan<VolumeScheduler::pool_size> loan_;
  RightOfWay right_of_way_;
  VolumeDemand demand_;
  hal::TimePoint waits_since_{}; // for the renderer: what was published then, or what replaced it
  std::vector<BScanJob> held_back_; // while the renderer has it, since:
  hal::TimePoint held_since_{};
  VolumeScheduler scheduler_;
  BScanBuilder builder_;
  ScanLagThread scan_lag_;

  RetryDelay trigger_retry_;
  PipelineStatistics statistics_;
  std::unique_ptr<WorkerPool> workers_;
  RoleThread thread_{&arrived_};
};

} // namespace octascope::pipeline

// Name, priority and core of each thread, by its role.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "firmware-host/supervision/thread_watch.h"
#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/worker_pool.h"

namespace octascope::firmware_host {

// Which worker runs on which core. With `configured` cores, on those in turns; else one on each of
// the `allowed` ones, and where there are fewer of them than workers, wherever the system wants.
class WorkerCores {
public:
  WorkerCores(std::size_t workers, std::span<const int> configured, std::span<const int> allowed);

  // Empty: the system chooses.
  std::optional<int> planned(std::size_t worker) const;

  // Any thread: a worker says where it is pinned; what all of them said, −1 where the system
  // chooses.
  void set_pinned(std::size_t worker, int core);
  std::vector<int> pinned() const;

private:
  std::vector<int> planned_; // by worker, or empty
  std::vector<std::atomic<int>> pinned_;
};

// What the pipeline's and the display's threads call first. Camera and volume threads come before
// the workers, the workers before everything else; the iso-surface comes last. Where the system
// refuses, that is one record in `faults` (which like `cores` outlives the threads) and the
// appliance goes on. `watch`, which outlives them too, notices those that hang; null: nobody does.
pipeline::ThreadSetup make_thread_setup(hal::Clock& clock, pipeline::FaultLog& faults,
                                        WorkerCores& cores, ThreadWatch* watch = nullptr);

} // namespace octascope::firmware_host

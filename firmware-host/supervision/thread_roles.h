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

// Which worker runs on which core. `configured` cores are used in turn; else each worker gets one
// of the `allowed` cores or, if there are too few, the system chooses.
class WorkerCores {
public:
  WorkerCores(std::size_t workers, std::span<const int> configured, std::span<const int> allowed);

  // Empty: the system chooses.
  std::optional<int> planned(std::size_t worker) const;

  // Any thread: a worker reports its core, or all reports are read; −1: the system chooses.
  void set_pinned(std::size_t worker, int core);
  std::vector<int> pinned() const;

private:
  std::vector<int> planned_; // by worker, or empty
  std::vector<std::atomic<int>> pinned_;
};

// Called first by each of the pipeline's and the display's threads. Camera and volume threads take
// precedence over the workers, the workers over everything else; the iso-surface and the vessel
// tree come last. If the system refuses, that is one record in `faults`, and the appliance goes on. `watch` notices hung
// threads; null: nobody does. All three references outlive the threads.
pipeline::ThreadSetup make_thread_setup(hal::Clock& clock, pipeline::FaultLog& faults,
                                        WorkerCores& cores, ThreadWatch* watch = nullptr);

} // namespace octascope::firmware_host

// Threads that work off numbered jobs, handed to them without locks.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

#include "pipeline/threads/index_ring.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::pipeline {

// One thread submits; the jobs start in order and may finish in any. Destruction waits for the
// jobs in progress and forgets those not begun.
class WorkerPool {
public:
  using Work = std::function<void(std::size_t worker, std::uint32_t job)>;

  // Starts the threads. The pool keeps `work`; what it refers to must outlive the pool. It must not
  // throw.
  WorkerPool(std::size_t workers, std::size_t most_jobs, const ThreadSetup& setup, Work work);
  ~WorkerPool();

  // False when `most_jobs` wait already.
  bool submit(std::uint32_t job);

  std::size_t workers() const { return threads_.size(); }

private:
  void run(std::size_t worker);

  Work work_;
  IndexRing jobs_;
  Wakeup wakeup_;
  std::atomic<bool> stopping_{false};
  std::vector<std::thread> threads_;
};

} // namespace octascope::pipeline

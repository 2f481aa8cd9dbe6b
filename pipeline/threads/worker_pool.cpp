#include "pipeline/threads/worker_pool.h"

#include "pipeline/threads/heartbeat.h"
#include "pipeline/threads/hot_path.h"

namespace octascope::pipeline {

WorkerPool::WorkerPool(std::size_t workers, std::size_t most_jobs, const ThreadSetup& setup,
                       Work work)
    : work_(std::move(work)), jobs_(most_jobs) {
  threads_.reserve(workers);
  for (std::size_t worker = 0; worker < workers; ++worker) {
    threads_.emplace_back([this, worker, setup] {
      if (setup)
        setup({"worker", worker});
      run(worker);
    });
  }
}

WorkerPool::~WorkerPool() {
  stopping_.store(true, std::memory_order_release);
  for (std::size_t i = 0; i < threads_.size(); ++i)
    wakeup_.post();
  for (std::thread& thread : threads_)
    thread.join();
}

bool WorkerPool::submit(std::uint32_t job) {
  if (!jobs_.push(job))
    return false;
  wakeup_.post();
  return true;
}

void WorkerPool::run(std::size_t worker) {
  Heartbeat::rest_here();
  while (true) {
    wakeup_.wait();
    if (stopping_.load(std::memory_order_acquire))
      return;
    if (const auto job = jobs_.pop()) {
      const HotPath hot;
      work_(worker, *job);
      Heartbeat::rest_here();
    }
  }
}

} // namespace octascope::pipeline

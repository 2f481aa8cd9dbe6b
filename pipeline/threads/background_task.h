// One job at a time on a thread of its own, for a thread that must never wait.
#pragma once

#include <chrono>
#include <future>
#include <optional>
#include <utility>

namespace octascope::pipeline {

// Bound to one thread. Only wait() and the destructor wait for the job; what the job borrows must
// outlive this.
template <class Outcome> class BackgroundTask {
public:
  // Returns at once. False, and the job is not started, while busy().
  template <class Job> bool start(Job&& job) {
    if (busy())
      return false;
    outcome_ = std::async(std::launch::async, std::forward<Job>(job));
    return true;
  }

  // A job runs, or its outcome has not been taken yet.
  bool busy() const { return outcome_.valid(); }

  // The outcome, once; empty while the job runs.
  std::optional<Outcome> take() {
    if (!busy() || outcome_.wait_for(std::chrono::seconds{0}) != std::future_status::ready)
      return std::nullopt;
    return outcome_.get();
  }

  // Until take() has the outcome, if there is a job.
  void wait() const {
    if (busy())
      outcome_.wait();
  }

private:
  std::future<Outcome> outcome_; // its destructor waits
};

} // namespace octascope::pipeline

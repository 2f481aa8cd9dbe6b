// A recording as a feed of volumes: a thread of its own reads it and publishes at the recorded
// times, as ReplayPlayer has it.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

#include "hal/clock.h"
#include "pipeline/recordings/replay/replay_player.h"
#include "pipeline/threads/worker_pool.h"

namespace octascope::pipeline {

class ReplayThread final : public VolumeFeed {
public:
  // All references outlive this; `news` is posted after each published volume.
  ReplayThread(ReplaySource source, const ReplaySetup& setup, hal::Clock& clock, FaultLog& faults,
               Wakeup& news);
  ~ReplayThread() override;

  // Once. The thread's role is "replay".
  void start(const ThreadSetup& setup);
  void stop();

  // Any thread, also before start(): as ReplayPlayer has them.
  void seek(std::size_t n);
  void hold(bool held);
  ReplayEnd end() const { return player_.end(); }
  std::size_t position() const { return player_.position(); }
  const ReplaySchedule& schedule() const { return player_.schedule(); }
  const RecordingFacts& facts() const { return player_.facts(); }

private:
  const Volume* do_take_newest() override { return player_.take_newest(); }
  bool do_has_newer() const override { return player_.has_newer(); }
  VolumeCounters do_counters() const override { return player_.counters(); }

  void run();

  hal::Clock& clock_;
  ReplayPlayer player_;
  Wakeup wakeup_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

} // namespace octascope::pipeline

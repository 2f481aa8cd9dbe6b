// A recording as a feed of volumes: a thread of its own reads it and publishes at the recorded
// times, as ReplayPlayer has it.
#pragma once

#include <cstddef>

#include "hal/clock.h"
#include "pipeline/recordings/replay/replay_player.h"
#include "pipeline/threads/role_thread.h"

namespace octascope::pipeline {

class ReplayThread final : public VolumeFeed {
public:
  // All references outlive this; `news` is posted after each published volume.
  ReplayThread(ReplaySource source, const ReplaySetup& setup, hal::Clock& clock, FaultLog& faults,
               Wakeup& news);

  // Once. The thread's role is "replay".
  void start(const ThreadSetup& setup);
  void stop() { thread_.stop(); }

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
  RoleThread thread_{&wakeup_};
};

} // namespace octascope::pipeline

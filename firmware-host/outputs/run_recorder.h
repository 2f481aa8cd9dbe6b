// The recordings of a run: where they go, whose they are, and what the screen says of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "firmware-host/configuration/run_options.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/recordings/recorder.h"
#include "pipeline/threads/wakeup.h"
#include "pipeline/threads/worker_pool.h"
#include "ui/status/status.h"

namespace octascope::firmware_host {

struct RecordingSetup {
  std::filesystem::path folder;              // of those that a pedal begins; made when it is needed
  std::optional<std::filesystem::path> file; // one from the first volume on, until the end
  pipeline::RecordingFacts facts;            // but for when it was begun
};

struct KeptRecording {
  std::filesystem::path file;
  std::uint64_t kept = 0;
  std::uint64_t not_kept = 0;
};

// One thread, the render thread; the recorder's own threads are said there.
class RunRecorder {
public:
  RunRecorder(RecordingSetup setup, hal::Clock& clock, pipeline::FaultLog& faults,
              pipeline::Wakeup& news);

  // Could the file of the setup be made? Leaves nothing behind.
  hal::Result<> check() const;

  // Begins with the file of the setup, if there is one, and waits until volumes are taken.
  hal::Result<> start(const pipeline::ThreadSetup& setup);
  void stop();

  // Begins one, or ends the one that is on; what to say of it.
  std::string_view toggle();

  ui::RecordingStatus status(hal::TimePoint now) const;

  // Once it was stopped: every recording of the run, in their order.
  const std::vector<KeptRecording>& kept() const { return kept_; }

  // For the fixed-rate thread.
  void offer(const pipeline::Volume& volume) { recorder_.offer(volume); }

private:
  bool begin(const std::filesystem::path& file);
  void note_counts();

  RecordingSetup setup_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  pipeline::Recorder recorder_;
  std::vector<KeptRecording> kept_;
};

} // namespace octascope::firmware_host

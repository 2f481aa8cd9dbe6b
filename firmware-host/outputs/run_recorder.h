// The recordings of a run: destination, patient and eye, and their status for the screen.
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
  std::filesystem::path folder;              // for recordings begun by pedal; made when needed
  std::optional<std::filesystem::path> file; // a recording from the first volume to the end
  pipeline::RecordingFacts facts;            // complete but for the start time
};

struct KeptRecording {
  std::filesystem::path file;
  std::uint64_t kept = 0;
  std::uint64_t not_kept = 0;
  std::optional<hal::Error> failure{}; // as Recorder::failure()

  bool is_there() const { return !failure || failure->code != hal::ErrorCode::absent; }
};

// Of a recording that has lasted so long: until its disk is full, as fast as it was written so far.
std::optional<hal::Duration> time_left(hal::Duration lasted, std::uint64_t kept,
                                       std::optional<std::uint64_t> room);

// Bound to the render thread; the recorder documents its own threads.
class RunRecorder {
public:
  RunRecorder(RecordingSetup setup, hal::Clock& clock, pipeline::FaultLog& faults,
              pipeline::Wakeup& news);

  // Checks that the setup's file could be made; leaves nothing behind.
  hal::Result<> check() const;

  // Starts the recording into the setup's file, if any, and waits until volumes are accepted.
  hal::Result<> start(const pipeline::ThreadSetup& setup);
  void stop();

  // Begins a recording or ends the present one; returns the text to show.
  std::string_view toggle();

  ui::RecordingStatus status(hal::TimePoint now) const;

  // After stop(): every recording of the run, in order.
  const std::vector<KeptRecording>& kept() const { return kept_; }

  // After stop(): whether the setup's file, if any, holds all that was asked for.
  hal::Result<> outcome() const;

  // To be called on the fixed-rate thread.
  bool is_on() const { return recorder_.is_on(); }
  void offer(const pipeline::Volume& volume) { recorder_.offer(volume); }

private:
  bool begin(const std::filesystem::path& file);
  void note_counts();

  RecordingSetup setup_;
  hal::Clock& clock_;
  pipeline::Recorder recorder_;
  std::vector<KeptRecording> kept_;
};

} // namespace octascope::firmware_host

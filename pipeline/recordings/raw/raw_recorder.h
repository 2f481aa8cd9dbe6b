// Records a run's raw spectra in the background.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "hal/line_camera.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/recordings/raw/raw_writer.h"
#include "pipeline/threads/index_ring.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::pipeline {

// Every frame that was offered is kept or counted as not kept, once the recorder has stopped.
struct RawRecorderStatus {
  bool waiting = false;   // for its disk, which has not made the file yet: no frame is kept
  bool made = false;      // the file, by this recorder
  bool on = false;        // it takes frames
  hal::TimePoint since{}; // meaningful while on
  std::uint64_t offered = 0;
  std::uint64_t kept = 0;
  std::uint64_t not_kept = 0;        // the disk was too slow, or the recording had ended by itself
  std::optional<std::uint64_t> room; // frames until its disk is full; empty: not known yet
};

// Makes the file: RawWriter::create(), but for tests.
using RawWriterMaker =
    std::function<hal::Result<RawWriter>(const std::filesystem::path&, const RawFacts&)>;

// The workers offer each frame that they have converted and never wait: it is copied into a free
// slot, or counted. A writing thread empties the slots; another has the file written to the disk,
// so that the first does not wait for that. The first makes the file, too: a disk that hangs holds up
// nobody, and frames that come meanwhile are counted as not kept. It ends before the disk is full, when writing fails, or
// when its file is removed, moved or replaced; each is a fault of the device "recording". The frames
// written by then stay in the file.
class RawRecorder {
public:
  // Slots for frames take at most so much memory: 0.6 s at 440 MB/s.
  static constexpr std::size_t most_memory = std::size_t{256} << 20;

  // `most_frames`: takes no more than so many; 0: any number.
  RawRecorder(std::filesystem::path file, RawFacts facts, std::size_t workers,
              std::uint64_t most_frames, hal::Clock& clock, FaultLog& faults,
              RawWriterMaker make_writer = RawWriter::create);

  // How long start() waits for the file.
  static constexpr std::chrono::seconds patience{2};

  // Makes the slots, all memory that is ever used, then the threads, one of which makes the file. On
  // an Error the file cannot be made, and nothing was started. Where the disk does not answer
  // (RawRecorderStatus::waiting, and a fault again and again) it is begun when it does, or ends by
  // itself.
  hal::Result<> start(const ThreadSetup& setup);

  // After the last offer(): writes what waits and finishes the file. `camera`: RawEnd::camera.
  void stop(const std::string& camera);

  // Worker `worker`, until its frame is released. `entry` without its checksum and wall clock;
  // `background`: the frame's, or nothing. Neither waits nor allocates.
  void offer(std::size_t worker, const RawFrame& entry, std::span<const std::byte> frame,
             std::span<const float> background) noexcept;

  // Any thread.
  RawRecorderStatus status() const;
  // Why it ended by itself, or could not be finished. Empty: nothing of that.
  std::optional<hal::Error> failure() const;

  const std::filesystem::path& file() const { return file_; }

private:
  struct Slot {
    RawFrame entry;
    std::vector<std::byte> frame;
    std::vector<float> background;
  };

  bool make_file();
  void make_slots();
  void run();
  void write_waiting();
  void write(const Slot& slot);
  void flush();
  bool has_room();
  void tell_of_waiting();
  void sync();
  void give_up(Fault fault, const hal::Error& error);

  const std::filesystem::path file_;
  const std::filesystem::path folder_;
  const RawFacts facts_;
  const std::uint64_t most_frames_;
  hal::Clock& clock_;
  FaultLog& faults_;
  const RawWriterMaker make_writer_;
  std::vector<Slot> slots_;
  std::unique_ptr<IndexRing> free_;                 // the writing thread's → the workers'
  std::vector<std::unique_ptr<IndexRing>> waiting_; // each worker's → the writing thread's
  std::atomic<bool> waiting_for_file_{false};       // changed under mutex_
  std::atomic<bool> made_file_{false};
  std::atomic<bool> taking_{false};
  std::atomic<std::uint64_t> offered_{0};
  std::atomic<std::uint64_t> kept_{0};
  std::atomic<std::uint64_t> not_kept_{0};
  std::atomic<std::int64_t> room_{-1}; // frames; -1: not known yet
  Wakeup wakeup_;
  Wakeup sync_wakeup_;

  mutable std::mutex mutex_;
  std::condition_variable made_; // the file, or not
  bool told_of_waiting_ = false; // start() returned meanwhile
  std::optional<hal::Error> failure_;

  std::optional<RawWriter> writer_; // the writing thread's, but for its sync()
  hal::TimePoint began_;            // before it takes frames
  hal::TimePoint flushed_;
  RoleThread thread_{&wakeup_};
  RoleThread sync_thread_{&sync_wakeup_};
};

} // namespace octascope::pipeline

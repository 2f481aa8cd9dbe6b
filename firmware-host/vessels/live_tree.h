// Traces vessel trees in the flow of the newest volume, beside the running display.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "firmware-host/vessels/vessel_source.h"
#include "hal/clock.h"
#include "pipeline/threads/duration_statistics.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/wakeup.h"
#include "pipeline/vessels/tracing/vessel_tracer.h"
#include "pipeline/vessels/tree.h"
#include "pipeline/volume/volume.h"

namespace octascope::firmware_host {

// What was found in one volume.
struct LiveTree {
  std::uint64_t number = 0;       // of those traced, from 1
  pipeline::VesselTree tree;      // in the volume's frame (registration.h); no nodes if refused
  double quality = 0;             // vessel_tracer.h
  std::string refusal;            // empty: the tree may be shown; else why not
  hal::TimePoint of_volume;       // when the volume's last line was exposed
  std::uint64_t volume_index = 0; // its VolumeMetadata::index
  std::optional<LoadedVessels> packed; // the tree for drawing; empty if refused
  std::uint64_t vessels = 0;           // between branch points and tips
  double length_mm = 0;
};

// One job at a time, so that nothing is locked: offer() gives the thread a copy of a volume's flow while
// it is idle, and take() what it made of it. The thread starts with the first volume that has flow.
class LiveTreeThread {
public:
  // `news` is posted when a tree is finished; it and `clock` outlive this.
  LiveTreeThread(hal::Clock& clock, pipeline::Wakeup& news, pipeline::ThreadSetup setup = {});
  // Gives up what it is at, within some hundredths of a second.
  ~LiveTreeThread();
  LiveTreeThread(const LiveTreeThread&) = delete;
  LiveTreeThread& operator=(const LiveTreeThread&) = delete;

  // All of these: the render thread.

  // Copies the volume's flow, which takes milliseconds for a live volume, if the thread is idle, the volume
  // is another than the last one and has flow, and the last was at least `interval` ago; `patience` more if
  // this volume was offered before: a tree that is begun when its volume comes is mostly done before the
  // next one is drawn, and takes no memory's time from that picture.
  static constexpr hal::Duration patience = std::chrono::milliseconds{500};
  void offer(const pipeline::Volume& volume, hal::Duration interval);
  // What was found last, once; null if nothing new was.
  std::shared_ptr<const LiveTree> take();

  // A tree is being traced, of a volume that was copied.
  bool is_at_work() const { return turn_.load(std::memory_order_acquire) == Turn::at_work; }

  struct Counters {
    std::uint64_t traced = 0;
    std::uint64_t refused = 0;      // not among the traced
    pipeline::DurationSummary took; // from the copy to the packed tree, of both
  };
  Counters counters() const;

private:
  enum class Turn : std::uint8_t {
    starting, // makes room
    idle,
    at_work,
    finished,
  };

  void run();
  void trace();

  hal::Clock& clock_;
  pipeline::Wakeup& news_;
  const pipeline::ThreadSetup setup_;
  std::stop_source stop_;
  pipeline::Wakeup wakeup_;
  std::atomic<Turn> turn_{Turn::idle};

  // The render thread's.
  std::optional<hal::TimePoint> offered_;
  std::uint64_t traced_index_ = 0;
  std::optional<std::uint64_t> seen_index_; // of the volume that was offered last
  std::uint64_t count_ = 0;
  std::uint64_t refused_ = 0;

  // Of the thread while it is at work or makes room, else of the render thread.
  pipeline::VolumeGeometry geometry_;
  std::vector<std::uint8_t> flow_;
  pipeline::VesselTracer tracer_;
  std::shared_ptr<LiveTree> tree_;

  pipeline::DurationStatistics took_;
  pipeline::RoleThread thread_{&wakeup_}; // last: it uses all of the above
};

} // namespace octascope::firmware_host

// Where the display's volumes come from: the fixed-rate thread, or a recording.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>

#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// Once the thread has stopped, planned = acquired + passed_over + lost_volumes + unfinished.
struct VolumeCounters {
  std::uint64_t planned = 0; // ticks, each of which should bring a volume
  std::uint64_t triggered = 0;
  std::uint64_t acquired = 0; // at least one B-scan came
  std::uint64_t published = 0;
  std::uint64_t skipped = 0;      // published, but replaced before the renderer took them
  std::uint64_t passed_over = 0;  // came, and not reconstructed: nobody would have seen them
  std::uint64_t lost_lines = 0;   // kept lines of every sweep that did not arrive whole and in time
  std::uint64_t lost_b_scans = 0; // with no sweep that did
  std::uint64_t lost_volumes = 0; // ticks that yielded nothing
  std::uint64_t unfinished = 0;   // under way when the thread was stopped
  std::uint64_t saturated_lines = 0;
};

enum class BScanProgress : std::uint8_t {
  awaited,
  finished, // its levels, occupancy, flow, states and times of exposure stay as they are
  overdue   // it did not come when it should have; it may still become `finished`
};

// A volume that is being made, on loan. Nothing of it may be read but `progress` (acquire) and of the
// B-scans that are finished there what BScanProgress names.
struct VolumeInMaking {
  std::uint64_t number = 0; // what will be its VolumeMetadata::index
  const Volume* volume = nullptr;
  std::span<const std::atomic<BScanProgress>> progress; // by B-scan
};

// What the renderer makes of what comes.
enum class Showing : std::uint8_t {
  nothing, // or only now and then
  whole,   // each volume, to be drawn before the next one is begun (right_of_way.h)
  rolling  // B-scans of the one in the making
};

class VolumeFeed {
public:
  virtual ~VolumeFeed() = default;

  // Renderer's thread only. The newest volume, or null if none came since the last call; valid and
  // unchanged until the next call that returns one.
  const Volume* take_newest() { return do_take_newest(); }
  bool has_newer() const { return do_has_newer(); }

  // Renderer's thread only. The oldest volume behind number `after` that is being made or was just
  // published, on loan until give_back(), which must follow soon: its memory is not used anew
  // meanwhile. Empty: there is none. Neither waits.
  std::optional<VolumeInMaking> borrow_after(std::uint64_t after) { return do_borrow_after(after); }
  void give_back() { do_give_back(); }
  // Renderer's thread only. What it would not come to need not be made (volume_demand.h), unless it shows
  // nothing.
  void expect(Showing how) { do_expect(how); }
  // It has begun a frame with B-scans that it borrowed; a frame with them, or with the newest volume that
  // it took, is drawn.
  void note_begun() { do_note_begun(); }
  void note_drawn() { do_note_drawn(); }
  // Whether any volume is ever lent.
  bool lends() const { return do_lends(); }
  // Whether its volumes say what flows.
  bool has_flow() const { return do_has_flow(); }

  // Any thread.
  VolumeCounters counters() const { return do_counters(); }

private:
  virtual const Volume* do_take_newest() = 0;
  virtual bool do_has_newer() const = 0;
  virtual std::optional<VolumeInMaking> do_borrow_after(std::uint64_t) { return std::nullopt; }
  virtual void do_give_back() {}
  virtual void do_expect(Showing /*how*/) {}
  virtual void do_note_begun() {}
  virtual void do_note_drawn() {}
  virtual bool do_lends() const { return false; }
  virtual bool do_has_flow() const { return false; }
  virtual VolumeCounters do_counters() const = 0;
};

} // namespace octascope::pipeline

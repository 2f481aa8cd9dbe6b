// The memory of the frames, and who has each of them. No lock, and no allocation after the
// constructor: the camera thread and whoever gives frames back meet no library here.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "hal/line_camera.h"

namespace octascope::hal::linux_backend {

// A frame as the stream delivered it.
struct ServedFrame {
  std::uint64_t sequence = 0;
  TimePoint end{};       // when it was complete
  std::size_t bytes = 0; // at most the slot's
  FrameIntegrity integrity = FrameIntegrity::good;
  bool timed_by_host = false; // as of LineFrame
};

// idle --queue--> queued --serve--> waiting --fetch--> lent --give_back--> idle
class FrameSlots {
public:
  // `bytes` of each slot; the memory is touched, so that no page is missing later.
  FrameSlots(int count, std::size_t bytes);

  int count() const { return static_cast<int>(slots_.size()); }
  std::span<std::byte> bytes(int slot) const {
    return {memory_.get() + static_cast<std::size_t>(slot) * stride_, bytes_};
  }
  const ServedFrame& frame(int slot) const { return at(slot).frame; } // of a lent one

  // One thread at a time. True if the slot was idle: it is the stream's now.
  bool queue(int slot);

  // One thread at a time. Hands a queued slot on, or back to the idle ones.
  void serve(int slot, const ServedFrame& frame);
  void drop(int slot);

  // One thread at a time. The oldest waiting frame, which is lent now.
  std::optional<int> fetch();

  // Any thread. True if the slot was lent; other numbers are ignored.
  bool give_back(int slot);

  // While no other thread uses this, but for give_back(): all that are not lent are idle.
  void reset();

private:
  enum class Place : std::uint8_t { idle, queued, waiting, lent };
  struct Slot {
    std::atomic<Place> place{Place::idle};
    ServedFrame frame;
  };
  struct Free {
    void operator()(std::byte* memory) const;
  };

  const Slot& at(int slot) const { return slots_[static_cast<std::size_t>(slot)]; }
  Slot& at(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  bool move(int slot, Place from, Place to);

  std::size_t bytes_;
  std::size_t stride_; // whole pages
  std::vector<Slot> slots_;
  std::unique_ptr<std::byte[], Free> memory_;
  // The waiting ones, oldest first: serve() writes, fetch() reads. There is room for all.
  std::vector<int> ring_;
  std::atomic<std::size_t> served_{0};
  std::atomic<std::size_t> fetched_{0};
};

} // namespace octascope::hal::linux_backend

// The driver's buffers, mapped: who has each of them, and their way through the driver's queue.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/linux/v4l2/frame_times.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// A frame as the driver handed it over.
struct FetchedFrame {
  int buffer = -1;
  std::uint32_t bytes_used = 0;
  std::uint32_t sequence = 0;
  bool flagged = false; // the driver says that its bytes are wrong
  FrameStamp stamp;
};

// Threads: one thread at a time, but give_back(), which any thread may call. After the making,
// nothing here allocates or locks unless it fails.
class CaptureBuffers {
public:
  static constexpr int most = 64;

  // Asks for `wanted` buffers of at least `bytes` and takes what the driver has, `least` or more.
  // `file` outlives the buffers; `node` is for messages. On failure nothing is left behind.
  static Result<std::unique_ptr<CaptureBuffers>> map(const FileDescriptor& file,
                                                     const std::string& node, int wanted, int least,
                                                     std::size_t bytes);

  // Unmaps and frees them; the bytes of no frame can be read any more.
  ~CaptureBuffers();
  CaptureBuffers(const CaptureBuffers&) = delete;
  CaptureBuffers& operator=(const CaptureBuffers&) = delete;

  int count() const { return static_cast<int>(mapped_.size()); }
  std::span<const std::byte> bytes(int buffer) const {
    return mapped_[static_cast<std::size_t>(buffer)];
  }

  // Queues all that are not on loan and starts the stream; frames that lay in the driver from
  // before are thrown away.
  Result<> start();

  // Takes all back that are not on loan.
  void stop();

  // 0, or why not: EAGAIN when no frame waits. The frame is on loan from then on.
  int fetch(FetchedFrame& frame);

  // Waits for a frame, at most `timeout`; 0, or why the wait failed. It may end early. EAGAIN:
  // there is nothing to wait for, because the driver has no buffer or is gone; fetch() knows which.
  int wait(Duration timeout) const;

  // Queues a loan again; numbers that are none are ignored. False when the driver did not take it:
  // then it waits for retry_strays().
  bool give_back(int buffer);

  // Buffers that could not be queued again are tried once more here. Cheap when there are none.
  void retry_strays();

private:
  // ours: neither in the driver's queue nor on loan.
  enum class Place : std::uint8_t { none, ours, queued, lent };

  CaptureBuffers(const FileDescriptor& file, std::string node)
      : file_{file}, node_{std::move(node)} {
    for (std::atomic<Place>& place : places_)
      place.store(Place::none, std::memory_order_relaxed);
  }

  Result<> map_one(int buffer, std::size_t bytes);
  int queue(int buffer);
  bool in_driver(int buffer) const;
  void discard_waiting();
  std::atomic<Place>& place(int buffer) { return places_[static_cast<std::size_t>(buffer)]; }

  const FileDescriptor& file_;
  std::string node_;
  bool requested_ = false;
  std::vector<std::span<std::byte>> mapped_;
  std::array<std::atomic<Place>, most> places_;
  std::atomic<int> strays_{0};
};

} // namespace octascope::hal::linux_backend

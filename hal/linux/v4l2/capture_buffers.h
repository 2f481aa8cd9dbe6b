// The driver's mapped buffers: who has each of them, and queueing them to the driver.
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

// A frame as the driver delivered it.
struct FetchedFrame {
  int buffer = -1;
  std::uint32_t bytes_used = 0;
  std::uint32_t sequence = 0;
  bool flagged = false; // the driver flagged its data as wrong
  FrameStamp stamp;
};

// Threads: one thread at a time, except give_back(), which any thread may call. After map(),
// nothing here allocates or locks unless it fails.
class CaptureBuffers {
public:
  static constexpr int most = 64;

  // Requests `wanted` buffers of at least `bytes` and accepts what the driver gives, if `least` or
  // more. `file` must outlive the buffers; `node` is for messages. On failure all are freed.
  static Result<std::unique_ptr<CaptureBuffers>> map(const FileDescriptor& file,
                                                     const std::string& node, int wanted, int least,
                                                     std::size_t bytes);

  // Unmaps and frees the buffers; no frame's bytes may be read afterwards.
  ~CaptureBuffers();
  CaptureBuffers(const CaptureBuffers&) = delete;
  CaptureBuffers& operator=(const CaptureBuffers&) = delete;

  int count() const { return static_cast<int>(mapped_.size()); }
  std::span<const std::byte> bytes(int buffer) const {
    return mapped_[static_cast<std::size_t>(buffer)];
  }

  // Queues all buffers that are not borrowed and starts the stream; discards older frames that are
  // still in the driver.
  Result<> start();

  // Stops the stream and takes back all buffers that are not borrowed.
  void stop();

  // Returns 0 or an errno: EAGAIN if no frame waits. The frame is then borrowed until give_back().
  int fetch(FetchedFrame& frame);

  // Waits at most `timeout` for a frame, and may return early. Returns 0 or an errno: EAGAIN if
  // there is nothing to wait for, because the driver has no buffer or is gone; fetch() tells which.
  int wait(Duration timeout) const;

  // Queues a borrowed buffer again; ignores others. False if the driver did not accept it: it is
  // then left to retry_strays().
  bool give_back(int buffer);

  // Retries the buffers that could not be queued again. Cheap if there are none.
  void retry_strays();

private:
  // ours: neither in the driver's queue nor borrowed.
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

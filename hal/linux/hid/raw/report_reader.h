// Reads a raw device on a thread of its own, blocked in hidapi, and makes of it what others can
// wait for beside other files: a descriptor.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <semaphore>
#include <span>
#include <thread>

#include "hal/linux/hid/raw/raw_device.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Threads: one at a time; the device is the reader's own until this is destroyed. The thread has
// the priority of the one that started it.
class ReportReader {
public:
  // What may wait here to be taken; more waits in the kernel, which keeps as many.
  static constexpr std::size_t most_reports = 64;

  // `device` outlives this.
  static Result<std::unique_ptr<ReportReader>> start(RawDevice& device);
  ~ReportReader(); // waits for the thread, at most as long as one look at the device takes (20 ms)

  // Readable when take() has something to tell.
  int descriptor() const { return news_.get(); }

  // The oldest report that was not taken yet, until the next call; empty: there is none. The error
  // with which reading ended comes after all reports. No allocation but then.
  Result<std::span<const std::uint8_t>> take();

  // Soon nothing more is read; does not wait.
  void finish();

private:
  struct Report {
    std::array<std::uint8_t, 256> bytes;
    std::size_t size = 0;
  };

  ReportReader(RawDevice& device, FileDescriptor news) : device_{device}, news_{std::move(news)} {}
  void run();
  void tell();

  RawDevice& device_;
  FileDescriptor news_;                        // an eventfd
  std::array<Report, most_reports> reports_{}; // a ring: the thread writes, take() reads
  std::counting_semaphore<most_reports + 1> room_{most_reports};
  std::atomic<std::size_t> written_{0};
  std::size_t taken_ = 0;
  bool lent_ = false; // the report that was taken last
  std::optional<Error> end_;
  std::atomic<bool> ended_{false}; // end_ is told
  std::atomic<bool> finishing_{false};
  std::thread thread_;
};

} // namespace octascope::hal::linux_backend

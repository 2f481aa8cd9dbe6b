// Reads a raw device on its own thread, which blocks in hidapi, and provides a descriptor that can
// be polled together with other files.
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

// Threads: one at a time. Only the reader may use the device while it exists. Its thread inherits
// the priority of the one that called start().
class ReportReader {
public:
  // The reports that can wait here; further ones wait in the kernel, which keeps as many.
  static constexpr std::size_t most_reports = 64;

  // `device` is borrowed and must outlive this.
  static Result<std::unique_ptr<ReportReader>> start(RawDevice& device);
  ~ReportReader(); // waits for the thread, at most for one read's timeout (20 ms)

  // Readable when take() has a report or an error.
  int descriptor() const { return news_.get(); }

  // Takes the oldest waiting report, which is valid until the next call; empty if there is none.
  // After all reports, returns the error that ended reading. Allocates only then.
  Result<std::span<const std::uint8_t>> take();

  // Asks the thread to end; does not wait for it.
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
  bool lent_ = false; // the report taken last is still in use
  std::optional<Error> end_;
  std::atomic<bool> ended_{false}; // end_ is set
  std::atomic<bool> finishing_{false};
  std::thread thread_;
};

} // namespace octascope::hal::linux_backend

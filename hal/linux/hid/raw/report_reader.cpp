#include "hal/linux/hid/raw/report_reader.h"

#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {
constexpr std::chrono::milliseconds one_look{20}; // how soon the end is noticed
}

Result<std::unique_ptr<ReportReader>> ReportReader::start(RawDevice& device) {
  FileDescriptor news{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
  if (!news)
    return system_failure(device.node(), "making a descriptor to wait on", errno);
  std::unique_ptr<ReportReader> reader{new ReportReader{device, std::move(news)}};
  try {
    reader->thread_ = std::thread{&ReportReader::run, reader.get()};
  } catch (const std::system_error& error) {
    return system_failure(device.node(), "starting the thread that reads it", error.code().value());
  }
  return reader;
}

ReportReader::~ReportReader() {
  finish();
  if (thread_.joinable())
    thread_.join();
}

void ReportReader::finish() {
  if (!finishing_.exchange(true))
    room_.release(); // the thread may wait for some
}

void ReportReader::run() {
  pthread_setname_np(pthread_self(), "octa-hid");
  for (std::size_t next = 0;; ++next) {
    room_.acquire();
    Report& report = reports_[next % most_reports];
    Result<std::size_t> size{0};
    while (size && *size == 0 && !finishing_.load(std::memory_order_relaxed))
      size = device_.read(report.bytes, one_look);
    if (finishing_.load(std::memory_order_relaxed))
      return;
    if (!size) {
      end_ = std::move(size.error());
      ended_.store(true, std::memory_order_release);
      tell();
      return;
    }
    report.size = *size;
    written_.store(next + 1, std::memory_order_release);
    tell();
  }
}

void ReportReader::tell() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t told = ::write(news_.get(), &one, sizeof one);
}

Result<std::span<const std::uint8_t>> ReportReader::take() {
  if (std::exchange(lent_, false))
    room_.release();
  for (const bool looked : {false, true}) {
    // Asked first: then all reports that came before the end are seen below.
    const bool ended = ended_.load(std::memory_order_acquire);
    if (taken_ != written_.load(std::memory_order_acquire)) {
      const Report& report = reports_[taken_++ % most_reports];
      lent_ = true;
      return std::span{report.bytes}.first(report.size);
    }
    if (ended)
      return tl::make_unexpected(*end_);
    std::uint64_t count = 0;
    if (!looked) // what comes from now on is told anew
        [[maybe_unused]]
      const ssize_t read = ::read(news_.get(), &count, sizeof count);
  }
  return std::span<const std::uint8_t>{};
}

} // namespace octascope::hal::linux_backend

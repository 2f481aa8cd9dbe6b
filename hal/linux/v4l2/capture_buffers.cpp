#include "hal/linux/v4l2/capture_buffers.h"

#include <algorithm>
#include <cerrno>
#include <ctime>

#include <fmt/format.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/mman.h>

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

v4l2_buffer kernel_buffer(int index) {
  v4l2_buffer buffer{};
  buffer.index = static_cast<__u32>(index);
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

FrameStamp stamp_of(const v4l2_buffer& buffer) {
  FrameStamp stamp;
  switch (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) {
  case V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC: stamp.clock = FrameStamp::Clock::monotonic; break;
  case V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN: stamp.clock = FrameStamp::Clock::unnamed; break;
  default: stamp.clock = FrameStamp::Clock::foreign; break;
  }
  if ((buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE)
    stamp.moment = FrameStamp::Moment::start_of_exposure;
  stamp.seconds = buffer.timestamp.tv_sec;
  stamp.microseconds = buffer.timestamp.tv_usec;
  return stamp;
}

} // namespace

Result<std::unique_ptr<CaptureBuffers>> CaptureBuffers::map(const FileDescriptor& file,
                                                            const std::string& node, int wanted,
                                                            int least, std::size_t bytes) {
  std::unique_ptr<CaptureBuffers> buffers{new CaptureBuffers{file, node}};
  v4l2_requestbuffers request{};
  request.count = static_cast<__u32>(std::min(wanted, most));
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (control(file, VIDIOC_REQBUFS, &request) == -1)
    return system_failure(node, fmt::format("asking for {} buffers", wanted), errno);
  buffers->requested_ = true;
  const auto got = static_cast<int>(std::min<__u32>(request.count, 1000));
  if (got < least)
    return fail(ErrorCode::system,
                "{}: the driver has {} buffers, expected at least {}: end what else uses it, or "
                "free memory",
                node, got, least);
  if (got > wanted)
    return fail(ErrorCode::unsupported,
                "{}: the driver works with no fewer than {} buffers, {} are configured; configure "
                "{} or more",
                node, got, wanted, got);
  buffers->mapped_.reserve(static_cast<std::size_t>(got));
  for (int i = 0; i < got; ++i) {
    HAL_CHECK(buffers->map_one(i, bytes));
  }
  return buffers;
}

Result<> CaptureBuffers::map_one(int index, std::size_t bytes) {
  v4l2_buffer buffer = kernel_buffer(index);
  if (control(file_, VIDIOC_QUERYBUF, &buffer) == -1)
    return system_failure(node_, fmt::format("asking for buffer {}", index), errno);
  if (buffer.length < bytes)
    return fail(ErrorCode::unsupported, "{}: buffer {} has {} bytes, expected at least {}", node_,
                index, buffer.length, bytes);
  void* const memory = ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED,
                              file_.get(), buffer.m.offset);
  if (memory == MAP_FAILED)
    return system_failure(node_, fmt::format("mapping buffer {}", index), errno);
  mapped_.emplace_back(static_cast<std::byte*>(memory), buffer.length);
  place(index).store(Place::ours, std::memory_order_release);
  return {};
}

CaptureBuffers::~CaptureBuffers() {
  for (const std::span<std::byte> memory : mapped_)
    ::munmap(memory.data(), memory.size());
  if (requested_) {
    v4l2_requestbuffers none{};
    none.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    none.memory = V4L2_MEMORY_MMAP;
    control(file_, VIDIOC_REQBUFS, &none); // what remains goes with the descriptor
  }
}

Result<> CaptureBuffers::start() {
  strays_.store(0, std::memory_order_relaxed);
  for (int i = 0; i < count(); ++i) {
    if (const int why = queue(i); why != 0) { // loans stay where they are
      stop();
      return system_failure(node_, fmt::format("queueing buffer {}", i), why,
                            "it is tried again by itself");
    }
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (control(file_, VIDIOC_STREAMON, &type) == -1) {
    const int why = errno;
    stop();
    return system_failure(node_, "starting the stream", why,
                          why == EINVAL ? "the driver refused it, see `sudo dmesg`; it is tried "
                                          "again by itself"
                                        : "");
  }
  discard_waiting();
  return {};
}

// What a loopback keeps from before. A driver that follows the rules has nothing at this moment.
void CaptureBuffers::discard_waiting() {
  FetchedFrame frame;
  for (int i = 0; i < count() && fetch(frame) == 0; ++i)
    give_back(frame.buffer);
}

void CaptureBuffers::stop() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  control(file_, VIDIOC_STREAMOFF, &type); // fails for a device that has gone: it has stopped
  for (int i = 0; i < count(); ++i) {
    Place expected = Place::queued;
    place(i).compare_exchange_strong(expected, Place::ours, std::memory_order_acq_rel);
  }
}

int CaptureBuffers::fetch(FetchedFrame& frame) {
  v4l2_buffer buffer = kernel_buffer(0);
  if (control(file_, VIDIOC_DQBUF, &buffer) == -1)
    return errno;
  if (buffer.index >= mapped_.size())
    return EPROTO;
  frame.buffer = static_cast<int>(buffer.index);
  frame.bytes_used = buffer.bytesused;
  frame.sequence = buffer.sequence;
  frame.flagged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  frame.stamp = stamp_of(buffer);
  place(frame.buffer).store(Place::lent, std::memory_order_release);
  return 0;
}

int CaptureBuffers::wait(Duration timeout) const {
  pollfd waiting{file_.get(), POLLIN, 0};
  const timespec limit{.tv_sec = timeout.count() / 1'000'000'000,
                       .tv_nsec = timeout.count() % 1'000'000'000};
  if (::ppoll(&waiting, 1, &limit, nullptr) == -1)
    return errno == EINTR || errno == EAGAIN ? 0 : errno;
  // The device may have gone: fetch() then says so. If not, all buffers are on loan, which the
  // kernel reports in the same way, and at once.
  const bool waited =
      (waiting.revents & POLLIN) != 0 || (waiting.revents & (POLLERR | POLLHUP)) == 0;
  return waited ? 0 : EAGAIN;
}

bool CaptureBuffers::give_back(int buffer) {
  if (buffer < 0 || buffer >= count())
    return true;
  Place expected = Place::lent;
  if (!place(buffer).compare_exchange_strong(expected, Place::ours, std::memory_order_acq_rel) ||
      queue(buffer) == 0)
    return true;
  strays_.fetch_add(1, std::memory_order_release);
  return false;
}

void CaptureBuffers::retry_strays() {
  if (strays_.load(std::memory_order_acquire) == 0)
    return;
  strays_.store(0, std::memory_order_release);
  for (int i = 0; i < count(); ++i) {
    if (queue(i) != 0)
      strays_.fetch_add(1, std::memory_order_release);
  }
}

// Marked before the call: once the driver has it, it may be fetched.
int CaptureBuffers::queue(int buffer) {
  Place expected = Place::ours;
  if (!place(buffer).compare_exchange_strong(expected, Place::queued, std::memory_order_acq_rel))
    return 0; // on loan, or another thread was quicker
  v4l2_buffer request = kernel_buffer(buffer);
  if (control(file_, VIDIOC_QBUF, &request) == 0)
    return 0;
  const int why = errno;
  // A loan given back in the moment of a stop() may be in the queue already.
  if (why == EINVAL && in_driver(buffer))
    return 0;
  expected = Place::queued;
  place(buffer).compare_exchange_strong(expected, Place::ours, std::memory_order_acq_rel);
  return why;
}

bool CaptureBuffers::in_driver(int buffer) const {
  v4l2_buffer state = kernel_buffer(buffer);
  return control(file_, VIDIOC_QUERYBUF, &state) == 0 &&
         (state.flags & (V4L2_BUF_FLAG_QUEUED | V4L2_BUF_FLAG_DONE)) != 0;
}

} // namespace octascope::hal::linux_backend

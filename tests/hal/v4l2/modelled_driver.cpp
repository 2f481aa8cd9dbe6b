#include "tests/hal/v4l2/modelled_driver.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

namespace octascope::tests {

using namespace std::chrono_literals;

namespace {

// The C library's functions have no place for a context.
std::atomic<ModelledDriver*> alive{nullptr};

constexpr std::size_t page = 4096;

template <class Function> Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

int refuse(int error) {
  errno = error;
  return -1;
}

} // namespace

ModelledDriver::ModelledDriver(const hal::LineCameraConfig& makes, int frames_per_sweep,
                               hal::Clock& clock)
    : makes_{makes}, frames_per_sweep_{frames_per_sweep},
      frame_period_{hal::from_seconds(makes.format.lines_per_frame / makes.line_rate_hz)},
      clock_{clock} {
  alive = this;
}

ModelledDriver::~ModelledDriver() {
  alive = nullptr;
}

void ModelledDriver::trigger() {
  const std::lock_guard lock{mutex_};
  const hal::TimePoint now = clock_.now();
  expose_until(now);
  if (frames_to_come_ == 0)
    next_end_ = now + frame_period_;
  frames_to_come_ += frames_per_sweep_;
}

void ModelledDriver::unplug() {
  const std::lock_guard lock{mutex_};
  plugged_ = false;
  gone_ = descriptor_ >= 0;
}

void ModelledDriver::replug() {
  const std::lock_guard lock{mutex_};
  plugged_ = true;
}

int ModelledDriver::open_node() {
  const std::lock_guard lock{mutex_};
  if (!plugged_)
    return refuse(ENOENT);
  if (descriptor_ >= 0)
    return refuse(EBUSY);
  gone_ = false;
  descriptor_ = ::memfd_create("modelled camera", MFD_CLOEXEC);
  return descriptor_;
}

bool ModelledDriver::owns(int descriptor) const {
  const std::lock_guard lock{mutex_};
  return descriptor >= 0 && descriptor == descriptor_;
}

void ModelledDriver::closed(int descriptor) {
  const std::lock_guard lock{mutex_};
  if (descriptor != descriptor_)
    return;
  stream(false);
  count_ = 0;
  descriptor_ = -1;
}

int ModelledDriver::control(unsigned long request, void* argument) {
  const std::lock_guard lock{mutex_};
  if (gone_)
    return refuse(ENODEV);
  const int error = answer(request, argument);
  return error == 0 ? 0 : refuse(error);
}

int ModelledDriver::answer(unsigned long request, void* argument) {
  switch (request) {
  case VIDIOC_QUERYCAP: {
    auto& capability = *static_cast<v4l2_capability*>(argument);
    capability.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
    std::strcpy(reinterpret_cast<char*>(capability.card), "modelled");
    return 0;
  }
  case VIDIOC_ENUM_FMT: {
    auto& format = *static_cast<v4l2_fmtdesc*>(argument);
    format.pixelformat = V4L2_PIX_FMT_Y12;
    return format.index == 0 ? 0 : EINVAL;
  }
  case VIDIOC_TRY_FMT:
  case VIDIOC_S_FMT: return set_format(*static_cast<v4l2_format*>(argument));
  case VIDIOC_REQBUFS: return request_buffers(*static_cast<v4l2_requestbuffers*>(argument));
  case VIDIOC_QUERYBUF: {
    auto& buffer = *static_cast<v4l2_buffer*>(argument);
    if (buffer.index >= count_)
      return EINVAL;
    buffer.length = static_cast<__u32>(buffer_bytes_);
    buffer.m.offset = static_cast<__u32>(buffer.index * buffer_bytes_);
    buffer.flags = buffers_[buffer.index].place == Place::queued ? V4L2_BUF_FLAG_QUEUED : 0U;
    return 0;
  }
  case VIDIOC_QBUF: return queue(*static_cast<v4l2_buffer*>(argument));
  case VIDIOC_DQBUF: return fetch(*static_cast<v4l2_buffer*>(argument));
  case VIDIOC_STREAMON: return stream(true);
  case VIDIOC_STREAMOFF: return stream(false);
  default: return ENOTTY;
  }
}

int ModelledDriver::set_format(v4l2_format& format) const {
  v4l2_pix_format& pixels = format.fmt.pix;
  pixels.pixelformat = V4L2_PIX_FMT_Y12;
  pixels.width = static_cast<__u32>(makes_.format.samples_per_line);
  pixels.height = static_cast<__u32>(makes_.format.lines_per_frame);
  pixels.bytesperline = static_cast<__u32>(makes_.format.line_bytes());
  pixels.sizeimage = static_cast<__u32>(makes_.format.frame_bytes());
  pixels.field = V4L2_FIELD_NONE;
  return 0;
}

int ModelledDriver::request_buffers(v4l2_requestbuffers& request) {
  stream(false);
  request.count = std::min<__u32>(request.count, most_buffers);
  count_ = request.count;
  buffers_.fill({});
  buffer_bytes_ = (makes_.format.frame_bytes() + page - 1) / page * page;
  return ::ftruncate(descriptor_, static_cast<off_t>(count_ * buffer_bytes_)) == 0 ? 0 : errno;
}

int ModelledDriver::queue(v4l2_buffer& buffer) {
  if (buffer.index >= count_ || buffers_[buffer.index].place != Place::outside)
    return EINVAL;
  expose_until(clock_.now()); // what came before had no use of it
  buffers_[buffer.index].place = Place::queued;
  queued_[queued_end_++ % most_buffers] = buffer.index;
  queued_since_start_ = true;
  return 0;
}

int ModelledDriver::fetch(v4l2_buffer& buffer) {
  if (!streaming_)
    return EINVAL;
  expose_until(clock_.now());
  if (done_begin_ == done_end_)
    return EAGAIN;
  Buffer& oldest = buffers_[done_[done_begin_++ % most_buffers]];
  oldest.place = Place::outside;
  buffer = oldest.filled;
  return 0;
}

int ModelledDriver::stream(bool on) {
  expose_until(clock_.now());
  streaming_ = on;
  started_ = clock_.now();
  if (on)
    return 0;
  for (Buffer& buffer : buffers_)
    buffer.place = Place::outside;
  queued_begin_ = queued_end_ = done_begin_ = done_end_ = 0;
  queued_since_start_ = false;
  return 0;
}

void ModelledDriver::expose_until(hal::TimePoint now) {
  for (; frames_to_come_ > 0 && next_end_ <= now; --frames_to_come_, next_end_ += frame_period_) {
    if (gone_ || !streaming_ || next_end_ - frame_period_ < started_)
      continue;
    if (queued_begin_ != queued_end_)
      fill(queued_[queued_begin_++ % most_buffers], next_end_);
    ++raw_sequence_;
  }
}

void ModelledDriver::fill(std::uint32_t index, hal::TimePoint end) {
  const std::uint32_t number = raw_sequence_;
  const auto offset = static_cast<off_t>(index * buffer_bytes_);
  for (std::size_t at = 0; at < makes_.format.frame_bytes(); at += sizeof number)
    (void)!::pwrite(descriptor_, &number, sizeof number, offset + static_cast<off_t>(at));
  v4l2_buffer& filled = buffers_[index].filled;
  filled = {};
  filled.index = index;
  filled.bytesused = static_cast<__u32>(makes_.format.frame_bytes());
  filled.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
  filled.sequence = number;
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(end.time_since_epoch());
  filled.timestamp = {us.count() / 1'000'000, us.count() % 1'000'000};
  buffers_[index].place = Place::done;
  done_[done_end_++ % most_buffers] = index;
}

hal::TimePoint ModelledDriver::next_look(hal::TimePoint now, hal::TimePoint deadline) const {
  const hal::TimePoint soon = std::min(deadline, now + 1ms); // somebody may trigger
  return frames_to_come_ > 0 ? std::min(soon, next_end_) : soon;
}

int ModelledDriver::wait(short& revents, hal::Duration timeout) {
  const hal::TimePoint begin = clock_.now();
  const hal::TimePoint deadline =
      timeout > hal::TimePoint::max() - begin ? hal::TimePoint::max() : begin + timeout;
  for (hal::TimePoint now = begin;; now = clock_.now()) {
    hal::TimePoint look;
    {
      const std::lock_guard lock{mutex_};
      expose_until(now);
      revents = 0;
      if (gone_)
        revents = POLLERR | POLLHUP;
      else if (done_begin_ != done_end_)
        revents = POLLIN;
      else if (!streaming_ || !queued_since_start_)
        revents = POLLERR;
      if (revents != 0 || now >= deadline)
        return revents != 0 ? 1 : 0;
      look = next_look(now, deadline);
    }
    clock_.sleep_until(look);
  }
}

} // namespace octascope::tests

// ---- what stands before the C library ----

using octascope::tests::alive;
using octascope::tests::ModelledDriver;
using octascope::tests::next;

extern "C" {

int open(const char* path, int flags, ...) {
  ModelledDriver* const driver = alive;
  if (driver != nullptr && std::strcmp(path, ModelledDriver::node) == 0)
    return driver->open_node();
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : mode_t{0};
  va_end(arguments);
  return next<int(const char*, int, ...)>("open")(path, flags, mode);
}

int close(int descriptor) {
  if (ModelledDriver* const driver = alive)
    driver->closed(descriptor);
  return next<int(int)>("close")(descriptor);
}

int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  ModelledDriver* const driver = alive;
  if (driver != nullptr && driver->owns(descriptor))
    return driver->control(request, argument);
  return next<int(int, unsigned long, ...)>("ioctl")(descriptor, request, argument);
}

// The C library declares the files as written to only, but they say what to wait for.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
int ppoll(pollfd* files, nfds_t count, const timespec* timeout, const sigset_t* mask) {
  ModelledDriver* const driver = alive;
  if (driver != nullptr && count == 1 && driver->owns(files->fd)) {
    const octascope::hal::Duration limit =
        timeout == nullptr
            ? octascope::hal::Duration::max()
            : std::chrono::seconds{timeout->tv_sec} + std::chrono::nanoseconds{timeout->tv_nsec};
    return driver->wait(files->revents, limit);
  }
  return next<int(pollfd*, nfds_t, const timespec*, const sigset_t*)>("ppoll")(files, count,
                                                                               timeout, mask);
}

} // extern "C"

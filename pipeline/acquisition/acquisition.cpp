#include "pipeline/acquisition/acquisition.h"

#include <algorithm>

#include <fmt/format.h>

#include "pipeline/threads/heartbeat.h"
#include "pipeline/threads/hot_path.h"

namespace octascope::pipeline {

using namespace std::chrono_literals;

namespace {

// Also how soon a stop is noticed; a volume that misses frames waits for the end of a look that
// began after its time was over.
constexpr hal::Duration frame_timeout = 10ms;
// Frames that come more often are fetched several at a time.
constexpr hal::Duration gathering = 1ms;
constexpr hal::Duration retry_step = 50ms; // how soon a stop is noticed while the camera is away
constexpr hal::Duration stamps_told_every = 1s;
constexpr hal::Duration first_patience = 3s;
constexpr hal::Duration most_patience = 24s;

// More often than threads should be woken, and not so fast that an eighth of the buffers would not hold
// what is gathered.
bool comes_often(const hal::LineCameraConfig& config, int buffers) {
  const hal::Duration period =
      hal::from_seconds(config.format.lines_per_frame / config.line_rate_hz);
  return period < gathering && buffers / 8 * period >= gathering;
}

} // namespace

Acquisition::Acquisition(hal::LineCamera& camera, const hal::LineCameraConfig& config,
                         hal::Clock& clock, FaultLog& faults, Wakeup& arrived)
    : camera_(camera), config_(config), clock_(clock), faults_(faults), arrived_(arrived),
      frames_(static_cast<std::size_t>(config.buffers)),
      queue_(static_cast<std::size_t>(config.buffers)), buffers_(config.buffers),
      patience_(first_patience) {}

hal::Result<> Acquisition::start(const ThreadSetup& setup) {
  if (auto opened = camera_.open(config_); !opened) {
    if (opened.error().code == hal::ErrorCode::invalid_argument)
      return opened;
    faults_.add(Device::line_camera, opened.error(), clock_.now());
  }
  thread_.start({"camera"}, setup, [this] { run(); });
  return {};
}

std::optional<hal::LineFrame> Acquisition::take() {
  const auto buffer = queue_.pop();
  if (!buffer)
    return std::nullopt;
  return frames_[*buffer];
}

void Acquisition::release(int buffer) {
  give_back(buffer);
}

AcquisitionCounters Acquisition::counters() const {
  return {good_.load(), unusable_.load(), gaps_.load(), overflowed_.load()};
}

void Acquisition::run() {
  while (!thread_.stopping()) {
    const hal::TimePoint asked = clock_.now();
    Heartbeat::beat_here(asked);
    if (camera_.state() != hal::DeviceState::streaming && !open_and_start()) {
      wait_before_retry();
      continue;
    }
    const HotPath hot;
    if (look(frame_timeout) && gathers_)
      gather();
  }
  camera_.stop();
  close_when_returned();
}

// Whether a frame came.
bool Acquisition::look(hal::Duration timeout) {
  const hal::TimePoint asked = clock_.now();
  const auto frame = camera_.wait_frame(timeout);
  if (!frame) {
    faults_.add(Device::line_camera, frame.error(), clock_.now());
    close_when_returned();
    return false;
  }
  if (*frame)
    receive(**frame);
  else
    mend_silence();
  note_look(*frame ? std::min((*frame)->last_line, clock_.now()) : asked);
  return frame->has_value();
}

// Those that came meanwhile, and then for a while none: what frames have brought is worth less than
// the cores that waking two threads for each would take from it.
void Acquisition::gather() {
  for (int more = 1; more < config_.buffers && look(hal::Duration{}); ++more) {
  }
  arrived_.post();
  clock_.sleep_for(gathering);
}

bool Acquisition::open_and_start() {
  const auto result = camera_.state() == hal::DeviceState::ready
                          ? camera_.start()
                          : camera_.open(config_).and_then([&] { return camera_.start(); });
  if (!result) {
    faults_.add(Device::line_camera, result.error(), clock_.now());
    const bool goes_on =
        camera_.state() == hal::DeviceState::ready && result.error().code == hal::ErrorCode::absent;
    if (!goes_on)
      camera_.close();
    return false;
  }
  buffers_.store(camera_.fewer_buffers().value_or(config_.buffers), std::memory_order_relaxed);
  gathers_ = comes_often(config_, buffers());
  last_sequence_.reset();
  repeated_ = 0;
  silent_since_.reset();
  unanswered_.store(false, std::memory_order_relaxed);
  retry_.success();
  return true;
}

// Closing unmaps the frames' memory, and a worker may still be reading one. Queued frames are
// dropped here; those in work come back within a few milliseconds.
void Acquisition::close_when_returned() {
  while (on_loan_.load(std::memory_order_acquire) > 0) {
    while (const auto buffer = queue_.pop())
      give_back(static_cast<int>(*buffer));
    if (on_loan_.load(std::memory_order_acquire) > 0)
      clock_.sleep_for(1ms);
  }
  camera_.close();
}

void Acquisition::mend_silence() {
  const hal::TimePoint now = clock_.now();
  if (unanswered_.exchange(false, std::memory_order_relaxed) && !silent_since_)
    silent_since_ = now;
  if (!silent_since_ || now - *silent_since_ < patience_)
    return;
  faults_.add(Fault::silent,
              "the camera streams and sends nothing although the scanner is pulsed; it is opened "
              "anew. Is the scanner on, and its trigger wired to the camera?",
              now);
  patience_ = std::min(2 * patience_, most_patience);
  close_when_returned();
}

void Acquisition::receive(const hal::LineFrame& frame) {
  silent_since_.reset();
  patience_ = first_patience;
  unanswered_.store(false, std::memory_order_relaxed);
  check_sequence(frame.sequence);
  check_times(frame);
  gathers_ = gathers_ && !frame.timed_by_host; // its time may be that at which it was fetched
  const bool sized = frame.bytes.size() == config_.format.frame_bytes();
  if (frame.integrity != hal::FrameIntegrity::good || !sized) {
    unusable_.fetch_add(1, std::memory_order_relaxed);
    const auto complaint = [&] {
      return sized ? std::string{"the driver flagged a frame as corrupted"}
                   : fmt::format("a frame has {} bytes, expected {}", frame.bytes.size(),
                                 config_.format.frame_bytes());
    };
    faults_.add(sized ? Fault::corrupted_frame : Fault::wrong_size, complaint, clock_.now());
    camera_.release(frame.buffer);
    return;
  }
  hal::LineFrame& kept = frames_[static_cast<std::size_t>(frame.buffer)];
  kept = frame;
  kept.fetched = clock_.now();
  on_loan_.fetch_add(1, std::memory_order_acq_rel);
  good_.fetch_add(1, std::memory_order_relaxed);
  if (const auto dropped = queue_.push_dropping_oldest(static_cast<std::uint32_t>(frame.buffer))) {
    overflowed_.fetch_add(1, std::memory_order_relaxed);
    faults_.add(Fault::frame_overflow,
                "frames came faster than they were worked off; the oldest was dropped",
                clock_.now());
    give_back(static_cast<int>(*dropped));
  }
  if (!gathers_)
    arrived_.post();
}

// A counter that hung jumps to where it should be: the frames that came meanwhile fill the gap.
void Acquisition::check_sequence(std::uint64_t sequence) {
  if (last_sequence_ && sequence <= *last_sequence_) {
    const auto complaint = [&] {
      return fmt::format("frame number {} came after {}", sequence, *last_sequence_);
    };
    faults_.add(Fault::stuck_sequence, complaint, clock_.now());
    repeated_ = sequence == *last_sequence_ ? repeated_ + 1 : 0; // smaller: it began anew
    last_sequence_ = sequence;
    return;
  }
  if (const std::uint64_t step = last_sequence_ ? sequence - *last_sequence_ - 1 : 0;
      step > repeated_) {
    gaps_.fetch_add(step - repeated_, std::memory_order_relaxed);
    const auto complaint = [&] {
      return fmt::format("the driver lost frames: number {} came after {}", sequence,
                         *last_sequence_);
    };
    faults_.add(Fault::dropped_frames, complaint, clock_.now(), step - repeated_);
  }
  last_sequence_ = sequence;
  repeated_ = 0;
}

// As long as it is so, that its notice stays.
void Acquisition::check_times(const hal::LineFrame& frame) {
  if (!frame.timed_by_host) {
    stamps_told_.reset();
    return;
  }
  const hal::TimePoint now = clock_.now();
  if (stamps_told_ && now - *stamps_told_ < stamps_told_every)
    return;
  stamps_told_ = now;
  faults_.add(Fault::unusable_stamps,
              "the camera's time stamps do not fit the computer's clock (none, or its clock runs "
              "more than 1 % fast or slow): frames are given the times at which they come, which "
              "are less exact, so that B-scans may lie beside their places; is what the camera "
              "says of its time stamps' frequency true?",
              now);
}

void Acquisition::give_back(int buffer) {
  camera_.release(buffer);
  on_loan_.fetch_sub(1, std::memory_order_acq_rel);
}

void Acquisition::note_look(hal::TimePoint until) {
  if (until > looked_until_.load(std::memory_order_relaxed))
    looked_until_.store(until, std::memory_order_release);
  hal::TimePoint awaited = awaited_look_.load(std::memory_order_relaxed);
  if (until >= awaited && awaited_look_.compare_exchange_strong(awaited, hal::TimePoint::max(),
                                                                std::memory_order_relaxed))
    arrived_.post();
}

void Acquisition::wait_before_retry() {
  if (camera_.state() == hal::DeviceState::ready) { // its start goes on, and start() waits for it
    clock_.sleep_for(retry_step);
    return;
  }
  retry_.failure(clock_.now());
  while (!retry_.due(clock_.now()) && !thread_.stopping()) {
    Heartbeat::beat_here(clock_.now());
    clock_.sleep_until(std::min(retry_.next(), clock_.now() + retry_step));
  }
}

} // namespace octascope::pipeline

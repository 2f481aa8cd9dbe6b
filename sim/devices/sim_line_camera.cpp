#include "sim/devices/sim_line_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sim/faults/fault_random.h"
#include "sim/faults/fault_spectra.h"

namespace octascope::sim {

using hal::DeviceState;
using hal::Duration;
using hal::ErrorCode;
using hal::TimePoint;
using pipeline::Fault;
using namespace std::chrono_literals;

namespace {

void count(std::atomic<std::uint64_t>& counter) {
  counter.fetch_add(1, std::memory_order_relaxed);
}

std::string words(const hal::LineFormat& f) {
  return fmt::format("{} lines of {} samples, {}-bit in {}, shift {}", f.lines_per_frame,
                     f.samples_per_line, f.significant_bits, to_string(f.sample_type),
                     f.right_shift);
}

} // namespace

SimLineCamera::SimLineCamera(const SpectraSource& source, GalvoLink& link, hal::Clock& clock,
                             const FaultSchedule* faults, ScanMotion motion, std::string identity)
    : source_(source), link_(link), clock_(clock), motion_(motion),
      probe_(faults, pipeline::Device::line_camera), plugged_in_(std::move(identity)) {}

std::string SimLineCamera::do_identity() const {
  const std::lock_guard lock{identity_mutex_};
  return identity_;
}

void SimLineCamera::look_what_is_plugged_in(TimePoint now) {
  const ScriptedFault* const pulled = probe_.active(gone(pipeline::Device::line_camera), now);
  if (pulled != nullptr && !pulled->comes_back_as.empty())
    plugged_in_ = pulled->comes_back_as;
}

LineCameraTally SimLineCamera::tally() const {
  return {.made = made_.load(std::memory_order_relaxed),
          .delivered = delivered_.load(std::memory_order_relaxed),
          .dropped_by_fault = dropped_by_fault_.load(std::memory_order_relaxed),
          .dropped_without_buffer = dropped_without_buffer_.load(std::memory_order_relaxed),
          .altered = altered_.load(std::memory_order_relaxed)};
}

hal::Result<> SimLineCamera::check(const hal::LineCameraConfig& config) const {
  const auto refuse = [](std::string why) {
    return hal::fail(ErrorCode::invalid_argument, "simulated line camera: " + std::move(why));
  };
  if (config.format != source_.format())
    return refuse(fmt::format("format is {}, expected that of the spectra: {}",
                              words(config.format), words(source_.format())));
  if (!(config.line_rate_hz >= 1 && config.line_rate_hz <= 1e9))
    return refuse(fmt::format("line_rate_hz is {}, expected 1 to 1e9", config.line_rate_hz));
  if (config.buffers < 1 || config.buffers > FrameLoans::most_buffers)
    return refuse(
        fmt::format("buffers is {}, expected 1 to {}", config.buffers, FrameLoans::most_buffers));
  const double sweep_s =
      static_cast<double>(config.format.lines_per_frame) * source_.sweeps() / config.line_rate_hz;
  if (std::abs(sweep_s - hal::to_seconds(link_.sweep_duration())) > 1e-6)
    return refuse(fmt::format("{} sweeps of {} lines at {} Hz take {} s, expected the {} s that "
                              "the scanner sweeps; give both the same scan plan",
                              source_.sweeps(), config.format.lines_per_frame, config.line_rate_hz,
                              sweep_s, hal::to_seconds(link_.sweep_duration())));
  return {};
}

hal::Result<> SimLineCamera::do_open(const hal::LineCameraConfig& config) {
  HAL_CHECK(check(config));
  const TimePoint now = clock_.now();
  look_what_is_plugged_in(now);
  if (probe_.unplugged(now))
    return hal::fail(ErrorCode::absent,
                     "simulated line camera: not found, expected it on its cable; "
                     "the fault script has unplugged it, try again later");
  probe_.watch_plug(now);
  config_ = config;
  allocate_buffers();
  {
    const std::lock_guard lock{identity_mutex_};
    identity_ = plugged_in_;
  }
  set_state(DeviceState::ready);
  return {};
}

void SimLineCamera::allocate_buffers() {
  const auto buffers = static_cast<std::size_t>(config_.buffers);
  loans_.reset(config_.buffers);
  waiting_.assign(buffers, WaitingFrame{});
  oldest_waiting_ = 0;
  waiting_count_ = 0;
  const bool altering = probe_.expects(Fault::corrupted_frame) ||
                        probe_.expects(Fault::wrong_size) || probe_.expects(Fault::saturation);
  // Twice a frame: wrong sizes go up to that. All of it is touched here, as a driver's buffers are:
  // pages that came one by one, as faults strike, would look like a leak in the program.
  scratch_bytes_ = altering ? 2 * config_.format.frame_bytes() : 0;
  scratch_ = altering ? std::make_unique<std::byte[]>(scratch_bytes_ * buffers) : nullptr;
}

hal::Result<> SimLineCamera::do_start() {
  started_ = clock_.now();
  if (probe_.pulled_since_last_look(started_))
    return tl::make_unexpected(disconnect());
  next_sequence_ = 0;
  shown_sequence_ = 0;
  next_in_volume_ = 0;
  // The one sweep that may run now, or wait latched, is among the two newest.
  const std::uint64_t sweeps = link_.sweeps();
  next_sweep_ = sweeps >= 2 ? sweeps - 2 : 0;
  for (auto next = next_exposure(); next && next->begin < started_; next = next_exposure())
    step_exposure();
  set_state(DeviceState::streaming);
  return {};
}

hal::Result<std::optional<hal::LineFrame>> SimLineCamera::do_wait_frame(Duration timeout) {
  TimePoint now = clock_.now();
  const TimePoint deadline = hal::deadline_after(now, timeout);
  while (true) {
    if (probe_.pulled_since_last_look(now))
      return tl::make_unexpected(disconnect());
    expose_until(now);
    if (waiting_count_ > 0 && waiting_[oldest_waiting_].ready <= now) {
      const WaitingFrame& oldest = waiting_[oldest_waiting_];
      oldest_waiting_ = (oldest_waiting_ + 1) % waiting_.size();
      --waiting_count_;
      return hand_out(oldest);
    }
    if (now >= deadline)
      return std::nullopt;
    clock_.sleep_until(next_look(now, deadline));
    now = clock_.now();
  }
}

// While frames are coming, their times are known. A pulse from the trigger's thread is not: it is
// looked for every millisecond, or every B-scan period where that is shorter, which delays nothing,
// because the first frame of a sweep is complete one B-scan period after its pulse at the earliest.
// Below 0.1 ms the polling would cost more than the delay it saves.
TimePoint SimLineCamera::next_look(TimePoint now, TimePoint deadline) {
  const Duration period = line_offset(config_.format.lines_per_frame);
  TimePoint next = std::min(deadline, now + std::clamp<Duration>(period, 100us, 1ms));
  if (waiting_count_ > 0)
    next = std::min(next, waiting_[oldest_waiting_].ready);
  if (const auto exposure = next_exposure())
    next = std::min(next, exposure->end);
  return next;
}

Duration SimLineCamera::line_offset(std::int64_t line) const {
  return hal::from_seconds(static_cast<double>(line) / config_.line_rate_hz);
}

std::optional<SimLineCamera::Exposure> SimLineCamera::next_exposure() {
  while (next_sweep_ < link_.sweeps()) {
    if (const auto start = link_.start_of(next_sweep_)) {
      const std::int64_t lines = config_.format.lines_per_frame;
      const std::int64_t first = lines * next_in_volume_;
      return Exposure{.sweep = next_sweep_,
                      .in_volume = next_in_volume_,
                      .begin = *start + line_offset(first),
                      .end = *start + line_offset(first + lines)};
    }
    // Nobody fetched for so many volumes that the scanner forgot this one. Its frames were made,
    // and dropped for want of buffers.
    const auto forgotten = static_cast<std::uint64_t>(source_.sweeps() - next_in_volume_);
    next_sequence_ += forgotten;
    made_.fetch_add(forgotten, std::memory_order_relaxed);
    dropped_without_buffer_.fetch_add(forgotten, std::memory_order_relaxed);
    ++next_sweep_;
    next_in_volume_ = 0;
  }
  return std::nullopt;
}

void SimLineCamera::step_exposure() {
  if (++next_in_volume_ < source_.sweeps())
    return;
  next_in_volume_ = 0;
  ++next_sweep_;
}

void SimLineCamera::expose_until(TimePoint now) {
  for (auto next = next_exposure(); next && next->end <= now; next = next_exposure()) {
    finish(*next);
    step_exposure();
  }
}

void SimLineCamera::finish(const Exposure& exposure) {
  count(made_);
  const std::uint64_t sequence = next_sequence_++;
  const TimePoint t = exposure.end;
  if (probe_.strike(Fault::dropped_frames, t) != nullptr) {
    count(dropped_by_fault_);
    return;
  }
  const auto buffer = loans_.reserve();
  if (!buffer) {
    count(dropped_without_buffer_);
    return;
  }
  const bool stuck = probe_.strike(Fault::stuck_sequence, t) != nullptr;
  shown_sequence_ = stuck ? shown_sequence_ : sequence;
  const ScriptedFault* late = probe_.strike(Fault::late_frame, t);

  // The patient's time is the scanner's: it stands still between the sweeps, so that what a frame
  // shows does not depend on how busy the machine was.
  const Duration patient_time =
      static_cast<std::int64_t>(exposure.sweep) * link_.sweep_duration() +
      line_offset(std::int64_t{config_.format.lines_per_frame} * exposure.in_volume);
  const int met = motion_.met_sweep(exposure.in_volume, source_.sweeps(), source_.alike_every(),
                                    source_.sweeps_per_b_scan(), patient_time);

  const std::size_t place = (oldest_waiting_ + waiting_count_) % waiting_.size();
  waiting_[place] = {.buffer = *buffer,
                     .bytes = source_.frame(exposure.sweep, met),
                     .sequence = shown_sequence_,
                     .first_line = exposure.begin,
                     .last_line = exposure.end - line_offset(1),
                     .ready = late == nullptr ? t : t + late->late_by,
                     .noise_seed = mixed(sequence),
                     .corrupted = probe_.strike(Fault::corrupted_frame, t),
                     .wrong_size = probe_.strike(Fault::wrong_size, t),
                     .saturated = probe_.strike(Fault::saturation, t)};
  ++waiting_count_;
}

hal::LineFrame SimLineCamera::hand_out(const WaitingFrame& frame) {
  count(delivered_);
  hal::LineFrame out{.buffer = -1,
                     .bytes = altered_bytes(frame),
                     .sequence = frame.sequence,
                     .first_line = frame.first_line,
                     .last_line = frame.last_line,
                     .integrity = hal::FrameIntegrity::good};
  if (frame.wrong_size != nullptr)
    out.integrity = hal::FrameIntegrity::wrong_size;
  if (frame.corrupted != nullptr)
    out.integrity = hal::FrameIntegrity::corrupted;
  loans_.lend(frame.buffer);
  out.buffer = frame.buffer;
  return out;
}

std::span<const std::byte> SimLineCamera::altered_bytes(const WaitingFrame& frame) {
  if (frame.corrupted == nullptr && frame.wrong_size == nullptr && frame.saturated == nullptr)
    return frame.bytes;
  count(altered_);
  const std::size_t frame_bytes = config_.format.frame_bytes();
  const double share = frame.wrong_size == nullptr ? 1 : frame.wrong_size->size_share;
  const auto size = static_cast<std::size_t>(std::lround(share * static_cast<double>(frame_bytes)));
  const std::span scratch{scratch_.get() + static_cast<std::size_t>(frame.buffer) * scratch_bytes_,
                          scratch_bytes_};
  fill_with_frame(frame.bytes, scratch);
  if (frame.saturated != nullptr)
    saturate_lines(config_.format, scratch.first(frame_bytes), frame.saturated->line_share,
                   frame.noise_seed);
  if (frame.corrupted != nullptr)
    scramble(scratch.first(size), frame.noise_seed);
  return scratch.first(size);
}

hal::Error SimLineCamera::disconnect() {
  look_what_is_plugged_in(clock_.now());
  discard_waiting();
  loans_.void_all();
  set_state(DeviceState::failed);
  return {ErrorCode::disconnected,
          "simulated line camera: it went away while in use; the fault script "
          "has unplugged it, close it and open it again"};
}

void SimLineCamera::discard_waiting() {
  for (; waiting_count_ > 0; --waiting_count_) {
    loans_.cancel(waiting_[oldest_waiting_].buffer);
    oldest_waiting_ = (oldest_waiting_ + 1) % waiting_.size();
  }
}

void SimLineCamera::do_stop() {
  if (state() != DeviceState::streaming)
    return;
  discard_waiting();
  set_state(DeviceState::ready);
}

void SimLineCamera::do_close() {
  discard_waiting();
  scratch_.reset();
  set_state(DeviceState::absent);
}

} // namespace octascope::sim

#include "pipeline/acquisition/volume_thread.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "pipeline/threads/heartbeat.h"
#include "pipeline/threads/hot_path.h"

namespace octascope::pipeline {

using namespace std::chrono_literals;

namespace {

constexpr const char* camera_name = "line_camera";
constexpr const char* trigger_name = "galvo_trigger";

// How long after its sweep's end a volume waits for late B-scans, as a divisor of the sweep.
constexpr int grace_divisor = 6;

// How much longer at most until the camera's thread has looked at the camera that long, as another.
constexpr int look_divisor = 2;

// However slow a scan is: a thread that shows no life for longer is taken for stuck.
constexpr hal::Duration longest_wait = 500ms;

constexpr std::uint32_t none = ~0U;

std::string complaint_about(std::string_view refused, std::uint64_t sequence) {
  if (refused == "late_frame")
    return fmt::format("frame {} came when its B-scan was made already", sequence);
  if (refused == "doubled_frame")
    return fmt::format("frame {} has the time of a sweep that had come already", sequence);
  return fmt::format("frame {} was exposed outside every sweep", sequence);
}

std::vector<Volume> make_pool(const VolumeGeometry& geometry, std::size_t size) {
  Volume volume{geometry};
  volume.occupancy = Occupancy{geometry, blank_depth_bins};
  return std::vector<Volume>(size, volume);
}

} // namespace

VolumeThread::VolumeThread(VolumeThreadSetup setup, hal::GalvoTrigger& trigger,
                           Acquisition& acquisition, hal::LineCamera& camera, hal::Clock& clock,
                           FaultLog& faults, Wakeup& arrived, Wakeup& news)
    : setup_(std::move(setup)), trigger_(trigger), acquisition_(acquisition), camera_(camera),
      clock_(clock), faults_(faults), arrived_(arrived), news_(news),
      volumes_(make_pool(setup_.plan.geometry(), pool_size)), sweeps_(setup_.plan),
      builder_(setup_.plan, setup_.workers, setup_.reconstruct),
      phase_(setup_.plan, clock, faults) {
  for (Construction& construction : constructions_) {
    construction.positions.resize(static_cast<std::size_t>(setup_.plan.b_scans));
    construction.assembler =
        std::make_unique<VolumeAssembler>(setup_.plan.geometry(), setup_.average);
  }
  free_.reserve(pool_size);
  for (std::uint32_t index = 2; index < pool_size; ++index)
    free_.push_back(index);
}

VolumeThread::~VolumeThread() {
  stop();
}

void VolumeThread::start(const ThreadSetup& setup) {
  phase_.start(setup);
  const std::size_t most_jobs = pool_size * static_cast<std::size_t>(setup_.plan.b_scans);
  workers_ = std::make_unique<WorkerPool>(
      setup_.workers, most_jobs, setup,
      [this](std::size_t worker, std::uint32_t job) { reconstruct(worker, job); });
  thread_ = std::thread{[this, setup] {
    if (setup)
      setup({"volumes"});
    run();
  }};
}

void VolumeThread::stop() {
  if (!thread_.joinable())
    return;
  stopping_.store(true, std::memory_order_release);
  arrived_.post();
  thread_.join();
  phase_.stop();
}

const Volume* VolumeThread::do_take_newest() {
  const auto index = triple_buffer_.take();
  return index ? &volumes_[*index] : nullptr;
}

VolumeCounters VolumeThread::do_counters() const {
  return {.planned = counts_.planned,
          .triggered = counts_.triggered,
          .acquired = counts_.acquired,
          .published = counts_.published,
          .skipped = counts_.skipped,
          .lost_lines = counts_.lost_lines,
          .lost_b_scans = counts_.lost_b_scans,
          .lost_volumes = counts_.lost_volumes,
          .unfinished = counts_.unfinished,
          .saturated_lines = counts_.saturated_lines};
}

void VolumeThread::run() {
  next_tick_ = clock_.now();
  while (!stopping_.load(std::memory_order_acquire)) {
    {
      const HotPath hot;
      Heartbeat::beat_here(clock_.now());
      if (clock_.now() >= next_tick_)
        tick();
      const hal::TimePoint looked_until = acquisition_.looked_until();
      while (const auto frame = acquisition_.take())
        place(*frame);
      finish_due_volumes(looked_until);
    }
    arrived_.wait_until(next_deadline());
  }
  // The workers' last jobs hold loans of the camera; those not begun are given back here.
  workers_.reset();
  counts_.unfinished.store(under_way(), std::memory_order_relaxed);
  for (Construction& construction : constructions_) {
    for (Position& position : construction.positions)
      release(position);
  }
  while (const auto frame = acquisition_.take())
    acquisition_.release(frame->buffer);
  trigger_.close();
  Heartbeat::rest_here();
}

void VolumeThread::tick() {
  next_tick_ += setup_.plan.tick_period();
  const hal::TimePoint now = clock_.now();
  const bool was_running = last_number_ > 0;
  // If the thread itself was held up, the ticks that it slept through are lost.
  for (; next_tick_ <= now; next_tick_ += setup_.plan.tick_period()) {
    faults_.add("pipeline", "late_tick",
                "the fixed-rate thread was held up for a whole volume: is something else running, "
                "without real-time priority for us?",
                now);
    counts_.planned.fetch_add(1, std::memory_order_relaxed);
    count_lost_volume();
  }

  if (enough_triggered())
    return;
  // Without a camera there is nothing to sweep for. Before its first frame nothing is lost either.
  if (camera_.state() != hal::DeviceState::streaming || !trigger_ready()) {
    if (was_running) {
      counts_.planned.fetch_add(1, std::memory_order_relaxed);
      count_lost_volume();
    }
    return;
  }
  counts_.planned.fetch_add(1, std::memory_order_relaxed);
  if (const auto armed = trigger_.arm()) {
    open_volume(*armed);
  } else {
    faults_.add(trigger_name, to_string(armed.error().code), armed.error().message, now);
    if (trigger_.state() == hal::DeviceState::failed)
      trigger_.close();
    count_lost_volume();
  }
}

std::uint64_t VolumeThread::under_way() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(constructions_, [](const Construction& c) { return c.open; }));
}

bool VolumeThread::enough_triggered() const {
  return setup_.most_volumes &&
         counts_.published.load(std::memory_order_relaxed) + under_way() >= *setup_.most_volumes;
}

bool VolumeThread::trigger_ready() {
  if (trigger_.state() == hal::DeviceState::ready)
    return true;
  const hal::TimePoint now = clock_.now();
  if (!trigger_retry_.due(now))
    return false;
  const HotPath::Pause opening;
  if (const auto opened = trigger_.open(setup_.trigger); !opened) {
    faults_.add(trigger_name, to_string(opened.error().code), opened.error().message, now);
    trigger_retry_.failure(now);
    return false;
  }
  trigger_retry_.success();
  return true;
}

void VolumeThread::open_volume(hal::TimePoint armed) {
  const hal::TimePoint end = sweeps_.armed(++last_number_, armed);
  counts_.triggered.fetch_add(1, std::memory_order_relaxed);
  if (free_.empty()) { // the workers are three volumes behind
    faults_.add("pipeline", "overrun",
                "reconstruction is slower than the camera: fewer lines or B-scans, or linear "
                "interpolation, would help",
                armed);
    count_lost_volume();
    return;
  }
  const std::uint32_t index = free_.back();
  free_.pop_back();
  Construction& c = constructions_[index];
  c.open = true;
  c.accept_until = end + setup_.plan.sweep_duration() / grace_divisor;
  c.give_up_at.reset();
  c.alignment = SweepAlignment{setup_.plan, phase_.in_use_a_scans()};
  c.sketch = phase_.borrow();
  std::ranges::fill(c.positions, Position{});
  c.sweeps_came = 0;
  c.submitted = 0;
  c.flushed = 0;
  c.finished.store(0, std::memory_order_relaxed);
  c.work_ns.store(0, std::memory_order_relaxed);
  c.saturated_lines.store(0, std::memory_order_relaxed);
  Volume& volume = volumes_[index];
  std::fill(volume.b_scan_states.begin(), volume.b_scan_states.end(), BScanState::missing);
  c.assembler->begin(volume);
  volume.metadata = {};
  volume.metadata.index = last_number_;
  volume.metadata.armed = armed;
  volume.metadata.scan_lag_a_scans = c.alignment.scan_lag_a_scans();
}

void VolumeThread::count_lost_volume() {
  const auto b_scans = static_cast<std::uint64_t>(setup_.plan.b_scans);
  counts_.lost_volumes.fetch_add(1, std::memory_order_relaxed);
  counts_.lost_b_scans.fetch_add(b_scans, std::memory_order_relaxed);
  counts_.lost_lines.fetch_add(static_cast<std::uint64_t>(setup_.plan.sweeps()) *
                                   static_cast<std::uint64_t>(setup_.plan.a_scans),
                               std::memory_order_relaxed);
}

void VolumeThread::place(const hal::LineFrame& frame) {
  const auto slot = sweeps_.place(frame.first_line);
  const auto is_its = [&](std::uint32_t i) {
    return constructions_[i].open && volumes_[i].metadata.index == slot->volume;
  };
  std::uint32_t index = 0;
  while (slot && index < pool_size && !is_its(index))
    ++index;
  const int b_scan = slot ? setup_.plan.b_scan_of(slot->sweep) : 0;
  const auto repeat = static_cast<std::size_t>(slot ? slot->sweep % setup_.plan.repeats : 0);
  Position* position = nullptr;
  if (slot && index < pool_size)
    position = &constructions_[index].positions[static_cast<std::size_t>(b_scan)];
  const char* refused = nullptr;
  if (!slot)
    refused = "unplaced_frame";
  else if (position != nullptr && (position->came >> repeat & 1U) != 0)
    refused = "doubled_frame";
  else if (position == nullptr || position->submitted)
    refused = "late_frame";
  if (refused != nullptr) {
    // The sweep that it should have been counts as lost when its volume is finished.
    const auto complaint = [&] { return complaint_about(refused, frame.sequence); };
    faults_.add(camera_name, refused, complaint, clock_.now());
    acquisition_.release(frame.buffer);
    return;
  }
  Construction& c = constructions_[index];
  VolumeMetadata& metadata = volumes_[index].metadata;
  if (c.sweeps_came == 0)
    metadata.first_line = frame.first_line;
  metadata.last_line = std::max(metadata.last_line, frame.last_line);
  position->frames[repeat] = frame;
  if (setup_.observe)
    setup_.observe(frame);
  position->came |= 1U << repeat;
  ++c.sweeps_came;
  if (std::popcount(position->came) == setup_.plan.repeats)
    submit(index, b_scan);
  flush(index, b_scan - 1);
}

void VolumeThread::submit(std::uint32_t index, int b_scan) {
  Construction& c = constructions_[index];
  c.positions[static_cast<std::size_t>(b_scan)].submitted = true;
  ++c.submitted;
  // Never full: there is a place for every B-scan of the pool.
  workers_->submit(index * static_cast<std::uint32_t>(setup_.plan.b_scans) +
                   static_cast<std::uint32_t>(b_scan));
}

// B-scans before `end` wait no longer for the sweeps that they miss.
void VolumeThread::flush(std::uint32_t index, int end) {
  Construction& c = constructions_[index];
  for (; c.flushed < end; ++c.flushed) {
    const Position& position = c.positions[static_cast<std::size_t>(c.flushed)];
    if (position.came != 0 && !position.submitted)
      submit(index, c.flushed);
  }
}

void VolumeThread::release(Position& position) {
  for (hal::LineFrame& frame : position.frames) {
    if (frame.buffer >= 0)
      acquisition_.release(std::exchange(frame.buffer, -1));
  }
}

void VolumeThread::reconstruct(std::size_t worker, std::uint32_t job) {
  const auto b_scans = static_cast<std::uint32_t>(setup_.plan.b_scans);
  const auto b_scan = static_cast<std::size_t>(job % b_scans);
  Construction& c = constructions_[job / b_scans];
  Volume& volume = volumes_[job / b_scans];
  Position& position = c.positions[b_scan];
  const hal::TimePoint begin = clock_.now();
  Heartbeat::beat_here(begin);
  const int b = static_cast<int>(b_scan);
  const int saturated = builder_.build(
      worker, b, std::span{position.frames}.first(static_cast<std::size_t>(setup_.plan.repeats)),
      c.alignment, c.sketch, c.assembler->own_levels(b));
  volume.b_scan_states[b_scan] = saturated > 0 ? BScanState::saturated : BScanState::good;
  release(position);
  c.assembler->built(b);
  c.saturated_lines.fetch_add(saturated, std::memory_order_relaxed);
  c.work_ns.fetch_add((clock_.now() - begin).count(), std::memory_order_relaxed);
  c.finished.fetch_add(1, std::memory_order_release);
  arrived_.post();
}

std::uint32_t VolumeThread::oldest_open() const {
  std::uint32_t oldest = none;
  for (std::uint32_t i = 0; i < pool_size; ++i) {
    if (constructions_[i].open &&
        (oldest == none || volumes_[i].metadata.index < volumes_[oldest].metadata.index))
      oldest = i;
  }
  return oldest;
}

// Where others had the processor, the camera's frames came in time, and its thread wakes no sooner
// than this one: until it has looked, they are late only here.
bool VolumeThread::more_may_come(Construction& c, hal::TimePoint looked_until) const {
  const hal::TimePoint now = clock_.now();
  if (now < c.accept_until)
    return true;
  if (looked_until >= c.accept_until || camera_.state() != hal::DeviceState::streaming)
    return false;
  if (!c.give_up_at) {
    c.give_up_at = now + setup_.plan.sweep_duration() / look_divisor;
    acquisition_.ask_for_look(c.accept_until);
  }
  return now < *c.give_up_at;
}

void VolumeThread::finish_due_volumes(hal::TimePoint looked_until) {
  for (std::uint32_t i = oldest_open(); i != none; i = oldest_open()) {
    Construction& c = constructions_[i];
    if (c.sweeps_came < setup_.plan.sweeps() && more_may_come(c, looked_until))
      return;
    flush(i, setup_.plan.b_scans);
    if (c.finished.load(std::memory_order_acquire) < c.submitted)
      return;
    finish(i);
  }
}

void VolumeThread::finish(std::uint32_t index) {
  Construction& c = constructions_[index];
  Volume& volume = volumes_[index];
  c.open = false;
  if (c.sketch != nullptr)
    phase_.finished();
  if (c.sweeps_came == 0) {
    if (camera_.state() == hal::DeviceState::streaming) {
      faults_.add(trigger_name, "missed_pulse",
                  "a pulse brought no usable sweep: the scanner missed it, or the camera lost all "
                  "of its frames",
                  clock_.now());
      acquisition_.note_unanswered_pulse();
    }
    count_lost_volume();
    free_.push_back(index);
    return;
  }
  const hal::TimePoint begin = clock_.now();
  c.assembler->finish();
  fill_ledger(volume, c);
  const hal::TimePoint assembled = clock_.now();
  volume.metadata.assemble = assembled - begin;
  volume.metadata.published = assembled;

  const auto [recycled, skipped] = triple_buffer_.publish(index);
  free_.push_back(recycled);
  statistics_.reconstruct.add(hal::Duration{c.work_ns.load(std::memory_order_relaxed)});
  statistics_.assemble.add(assembled - begin);
  statistics_.publish.add(clock_.now() - assembled);
  counts_.acquired.fetch_add(1, std::memory_order_relaxed);
  counts_.published.fetch_add(1, std::memory_order_relaxed);
  if (skipped)
    counts_.skipped.fetch_add(1, std::memory_order_relaxed);
  news_.post();
  if (setup_.observe_volume) // it stays as it is until the next one is published, here
    setup_.observe_volume(volume);
}

void VolumeThread::fill_ledger(Volume& volume, const Construction& c) {
  VolumeMetadata& metadata = volume.metadata;
  metadata.reconstruct = hal::Duration{c.work_ns.load(std::memory_order_relaxed)};
  metadata.lost_b_scans = setup_.plan.b_scans - c.submitted;
  metadata.lost_lines = (setup_.plan.sweeps() - c.sweeps_came) * setup_.plan.a_scans;
  metadata.saturated_lines = c.saturated_lines.load(std::memory_order_relaxed);
  if (metadata.saturated_lines > 0)
    faults_.add(camera_name, "saturation",
                "lines reach the camera's full scale: less light, or a shorter exposure",
                clock_.now(), static_cast<std::uint64_t>(metadata.saturated_lines));
  if (is_at_upper_border(metadata.upper_border))
    faults_.add(
        "picture", "upper_border",
        fmt::format("tissue reaches the upper border in {} of {} A-scans that were looked at: "
                    "what is above it is shown upside down; move the tissue or the reference "
                    "arm until there is a gap above the tissue",
                    metadata.upper_border.lit, metadata.upper_border.looked_at),
        clock_.now());
  counts_.lost_b_scans.fetch_add(static_cast<std::uint64_t>(metadata.lost_b_scans),
                                 std::memory_order_relaxed);
  counts_.lost_lines.fetch_add(static_cast<std::uint64_t>(metadata.lost_lines),
                               std::memory_order_relaxed);
  counts_.saturated_lines.fetch_add(static_cast<std::uint64_t>(metadata.saturated_lines),
                                    std::memory_order_relaxed);
}

hal::TimePoint VolumeThread::next_deadline() const {
  hal::TimePoint deadline = std::min(next_tick_, clock_.now() + longest_wait);
  if (const std::uint32_t i = oldest_open(); i != none)
    deadline =
        std::min(deadline, constructions_[i].give_up_at.value_or(constructions_[i].accept_until));
  return std::max(deadline, clock_.now() + 100us);
}

} // namespace octascope::pipeline

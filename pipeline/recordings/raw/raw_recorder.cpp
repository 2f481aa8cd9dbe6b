#include "pipeline/recordings/raw/raw_recorder.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "pipeline/threads/heartbeat.h"

namespace octascope::pipeline {

namespace {

using namespace std::chrono_literals;

// A crash of the program costs no more than this, a power cut no more than that.
constexpr hal::Duration between_flushes = 200ms;
constexpr hal::Duration between_syncs = 2s;

// What the machine itself needs, for its journal and what the surgeon keeps.
constexpr std::uintmax_t room_left_alone = std::uintmax_t{256} << 20;

constexpr std::size_t fewest_slots = 4;
constexpr std::size_t most_slots = 1024;

std::size_t slots_for(const RawFacts& facts, std::uint64_t most_frames) {
  const std::size_t slots =
      std::clamp(RawRecorder::most_memory / facts.format.frame_bytes(), fewest_slots, most_slots);
  return most_frames > 0 ? std::min<std::uint64_t>(slots, most_frames) : slots;
}

std::int64_t wall_clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

Fault fault_of_writing(const hal::Error& error, Fault other) {
  return error.code == hal::ErrorCode::absent ? Fault::recording_gone : other;
}

} // namespace

RawRecorder::RawRecorder(std::filesystem::path file, RawFacts facts, std::size_t workers,
                         std::uint64_t most_frames, hal::Clock& clock, FaultLog& faults,
                         RawWriterMaker make_writer)
    : file_(std::move(file)), folder_(std::filesystem::absolute(file_).parent_path()),
      facts_(std::move(facts)), most_frames_(most_frames), clock_(clock), faults_(faults),
      make_writer_(std::move(make_writer)), waiting_(workers) {}

hal::Result<> RawRecorder::start(const ThreadSetup& setup) {
  make_slots();
  waiting_for_file_ = true;
  thread_.start({"raw"}, setup, [this] { run(); });
  std::unique_lock lock{mutex_};
  if (!made_.wait_for(lock, patience, [this] { return !waiting_for_file_; })) {
    told_of_waiting_ = true;
    tell_of_waiting();
  } else if (failure_) {
    const hal::Error error = *failure_;
    lock.unlock();
    thread_.stop();
    return tl::make_unexpected(error);
  }
  lock.unlock();
  sync_thread_.start({"raw-sync"}, setup, [this] { sync(); });
  return {};
}

void RawRecorder::tell_of_waiting() {
  faults_.add(
      Fault::recording_waits,
      [this] {
        return fmt::format("{}: its disk has not made the file for {} s; it is waited for, and no "
                           "frame is kept until then",
                           file_.string(), patience.count());
      },
      clock_.now());
}

void RawRecorder::make_slots() {
  slots_.resize(slots_for(facts_, most_frames_));
  free_ = std::make_unique<IndexRing>(slots_.size());
  for (auto& waiting : waiting_)
    waiting = std::make_unique<IndexRing>(slots_.size());
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_[i].frame.resize(facts_.format.frame_bytes());
    if (facts_.has_backgrounds())
      slots_[i].background.resize(static_cast<std::size_t>(facts_.format.samples_per_line));
    free_->push(static_cast<std::uint32_t>(i));
  }
}

// The writing thread. False: it cannot be made; failure_ says why.
bool RawRecorder::make_file() {
  Heartbeat::rest_here(); // a disk may take its time
  auto made = make_writer_(file_, facts_);
  Heartbeat::beat_here(clock_.now());
  const bool is_made = made.has_value();
  if (is_made) {
    writer_ = std::move(*made);
    began_ = flushed_ = clock_.now();
    made_file_.store(true, std::memory_order_relaxed);
    taking_.store(true, std::memory_order_release);
  }
  const std::lock_guard lock{mutex_};
  if (!is_made) {
    failure_ = made.error();
    if (told_of_waiting_)
      faults_.add(Fault::recording_not_begun, failure_->message, clock_.now());
  }
  waiting_for_file_ = false;
  made_.notify_all();
  return is_made;
}

void RawRecorder::stop(const std::string& camera) {
  if (!thread_.started())
    return;
  thread_.stop();
  sync_thread_.stop();
  if (!writer_)
    return;
  const auto finished =
      writer_->finish({.not_kept = not_kept_.load(std::memory_order_relaxed), .camera = camera});
  if (!finished && !failure())
    give_up(fault_of_writing(finished.error(), Fault::recording_not_finished), finished.error());
  writer_.reset();
  taking_.store(false, std::memory_order_release);
}

void RawRecorder::offer(std::size_t worker, const RawFrame& entry, std::span<const std::byte> frame,
                        std::span<const float> background) noexcept {
  if (most_frames_ > 0 && kept_.load(std::memory_order_relaxed) >= most_frames_)
    return;
  offered_.fetch_add(1, std::memory_order_relaxed);
  const bool taking = taking_.load(std::memory_order_acquire);
  const auto index = taking ? free_->pop() : std::nullopt;
  if (!index) {
    if (taking && slots_.size() == most_frames_) // all that are wanted wait already
      offered_.fetch_sub(1, std::memory_order_relaxed);
    else
      not_kept_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  Slot& slot = slots_[*index];
  slot.entry = entry;
  slot.entry.wall_clock_ns = wall_clock_ns();
  std::ranges::copy(frame, slot.frame.begin());
  std::ranges::copy(background, slot.background.begin());
  waiting_[worker]->push(*index); // there is a place for each
  wakeup_.post();
}

RawRecorderStatus RawRecorder::status() const {
  const std::int64_t room = room_.load(std::memory_order_relaxed);
  const bool on = taking_.load(std::memory_order_acquire);
  return {.waiting = waiting_for_file_.load(std::memory_order_acquire),
          .made = made_file_.load(std::memory_order_relaxed),
          .on = on,
          .since = on ? began_ : hal::TimePoint{},
          .offered = offered_.load(std::memory_order_relaxed),
          .kept = kept_.load(std::memory_order_relaxed),
          .not_kept = not_kept_.load(std::memory_order_relaxed),
          .room = room < 0 ? std::nullopt : std::optional{static_cast<std::uint64_t>(room)}};
}

std::optional<hal::Error> RawRecorder::failure() const {
  const std::lock_guard lock{mutex_};
  return failure_;
}

void RawRecorder::run() {
  if (!make_file())
    return;
  bool stopping = false;
  while (!stopping) {
    Heartbeat::beat_here(clock_.now());
    stopping = thread_.stopping(); // what came before it is still written
    write_waiting();
    if (stopping || clock_.now() - flushed_ >= between_flushes)
      flush();
    if (stopping)
      continue;
    Heartbeat::rest_here();
    wakeup_.wait_until(clock_, clock_.now() + between_flushes);
  }
}

void RawRecorder::write_waiting() {
  for (bool found = true; found;) {
    found = false;
    for (const auto& waiting : waiting_) {
      const auto index = waiting->pop();
      if (!index)
        continue;
      found = true;
      Heartbeat::beat_here(clock_.now());
      write(slots_[*index]);
      free_->push(*index);
    }
    if (clock_.now() - flushed_ >= between_flushes)
      flush();
  }
}

void RawRecorder::write(const Slot& slot) {
  if (most_frames_ > 0 && kept_.load(std::memory_order_relaxed) >= most_frames_) {
    offered_.fetch_sub(1, std::memory_order_relaxed); // came too late to be wanted
    return;
  }
  if (!taking_.load(std::memory_order_relaxed) || !has_room()) {
    not_kept_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  if (const auto appended = writer_->append(slot.entry, slot.frame, slot.background); !appended) {
    not_kept_.fetch_add(1, std::memory_order_relaxed);
    give_up(Fault::recording_not_kept, appended.error());
    return;
  }
  kept_.fetch_add(1, std::memory_order_relaxed);
}

void RawRecorder::flush() {
  flushed_ = clock_.now();
  if (!taking_.load(std::memory_order_relaxed))
    return;
  if (const auto flushed = writer_->flush(); !flushed)
    give_up(Fault::recording_not_kept, flushed.error());
}

bool RawRecorder::has_room() {
  std::error_code error;
  const auto room = std::filesystem::space(folder_, error);
  if (error)
    return true;
  const std::uintmax_t left = room.available - std::min(room.available, room_left_alone);
  room_.store(static_cast<std::int64_t>(left / facts_.format.frame_bytes()),
              std::memory_order_relaxed);
  if (left >= facts_.format.frame_bytes())
    return true;
  flush(); // nothing more will
  give_up(Fault::recording_disk_full,
          {hal::ErrorCode::system,
           fmt::format("{}: the recording ended: only {} MB are left on its disk, and {} stay free "
                       "for the machine; free some room",
                       file_.string(), room.available >> 20, room_left_alone >> 20)});
  return false;
}

void RawRecorder::sync() {
  while (!sync_thread_.stopping()) {
    Heartbeat::rest_here(); // a disk may take its time
    sync_wakeup_.wait_until(clock_, clock_.now() + between_syncs);
    if (waiting_for_file_.load(std::memory_order_acquire) && !sync_thread_.stopping())
      tell_of_waiting(); // else its notice would go while no frame is kept
    if (!taking_.load(std::memory_order_acquire))
      continue;
    if (const auto synced = writer_->sync(); !synced)
      give_up(fault_of_writing(synced.error(), Fault::recording_not_kept), synced.error());
  }
}

// What is in the file stays there; stop() marks it as well as it can still be.
void RawRecorder::give_up(Fault fault, const hal::Error& error) {
  taking_.store(false, std::memory_order_release);
  const std::lock_guard lock{mutex_};
  if (failure_)
    return;
  failure_ = error;
  faults_.add(fault, error.message, clock_.now());
}

} // namespace octascope::pipeline

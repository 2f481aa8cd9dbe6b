#include "pipeline/recordings/recorder.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "pipeline/threads/heartbeat.h"

namespace octascope::pipeline {

namespace {

using namespace std::chrono_literals;

// A power cut costs no more than this, and the disk gets larger pieces than a volume.
constexpr hal::Duration between_syncs = 2s;

// What the machine itself needs, for its journal and what the surgeon keeps.
constexpr std::uintmax_t room_left_alone = std::uintmax_t{256} << 20;

// Copies into memory that is there already.
void copy(const Volume& from, Volume& to) {
  std::ranges::copy(from.levels, to.levels.begin());
  std::ranges::copy(from.b_scan_states, to.b_scan_states.begin());
}

Fault fault_of_writing(const hal::Error& error, Fault other) {
  return error.code == hal::ErrorCode::absent ? Fault::recording_gone : other;
}

std::int64_t wall_clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

} // namespace

Recorder::Recorder(const VolumeGeometry& geometry, std::size_t places, hal::Clock& clock,
                   FaultLog& faults, Wakeup& news)
    : geometry_(geometry), clock_(clock), faults_(faults), news_(news), places_(places),
      free_(places), waiting_(places) {}

void Recorder::start(const ThreadSetup& setup) {
  thread_.start({"recorder"}, setup, [this] { run(); });
}

bool Recorder::begin(std::filesystem::path file, RecordingFacts facts) {
  if (state_.load(std::memory_order_acquire) != State::idle)
    return false;
  {
    const std::lock_guard lock{mutex_};
    file_ = std::move(file);
    facts_ = std::move(facts);
    failure_.reset();
  }
  kept_.store(0, std::memory_order_relaxed);
  not_kept_.store(0, std::memory_order_relaxed);
  state_.store(State::beginning, std::memory_order_release);
  wakeup_.post();
  return true;
}

// Of one that is only beginning nothing has been kept yet: it ends once it has begun. It may come
// on at any moment, so that is asked first; and what it takes is taken back last.
void Recorder::end() {
  for (State expected : {State::beginning, State::on})
    state_.compare_exchange_strong(expected, State::ending, std::memory_order_acq_rel);
  taking_.store(0, std::memory_order_release);
  wakeup_.post();
}

void Recorder::offer(const Volume& volume) {
  const std::uint64_t recording = taking_.load(std::memory_order_acquire);
  if (recording == 0)
    return;
  const auto index = free_.pop();
  if (!index) {
    not_kept_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  Place& place = places_[*index];
  copy(volume, place.volume);
  place.entry = entry_of(volume.metadata, wall_clock_ns());
  place.recording = recording;
  waiting_.push(*index); // there is a place for each
  wakeup_.post();
}

RecorderStatus Recorder::status() const {
  const std::uint64_t room = room_.load(std::memory_order_relaxed);
  return {.on = state_.load(std::memory_order_acquire) == State::on,
          .since = hal::TimePoint{hal::Duration{since_ns_.load(std::memory_order_relaxed)}},
          .kept = kept_.load(std::memory_order_relaxed),
          .not_kept = not_kept_.load(std::memory_order_relaxed),
          .room = room > 0 ? std::optional{room} : std::nullopt};
}

std::optional<hal::Error> Recorder::failure() const {
  const std::lock_guard lock{mutex_};
  return failure_;
}

void Recorder::make_places() {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    places_[i].volume = Volume{geometry_};
    free_.push(static_cast<std::uint32_t>(i));
  }
}

void Recorder::run() {
  make_places();
  bool stopping = false;
  while (!stopping) {
    Heartbeat::beat_here(clock_.now());
    stopping = thread_.stopping();
    if (stopping)
      end();
    serve();
    if (stopping || state_.load(std::memory_order_acquire) == State::ending)
      continue;
    Heartbeat::rest_here();
    wakeup_.wait_until(clock_, clock_.now() + between_syncs);
  }
}

// The state goes back to idle last: from then on another one may begin.
void Recorder::serve() {
  if (state_.load(std::memory_order_acquire) == State::beginning)
    come_on();
  write_waiting();
  State expected = State::on;
  if (!writer_ && state_.compare_exchange_strong(expected, State::idle, std::memory_order_acq_rel))
    news_.post();
  if (state_.load(std::memory_order_acquire) == State::ending) {
    write_waiting(); // what came before it was ended
    finish();
    state_.store(State::idle, std::memory_order_release);
    news_.post();
  }
}

// Volumes are taken before it is said to be on: what is offered from then on is kept or counted.
void Recorder::come_on() {
  const bool opened = open();
  if (opened)
    taking_.store(recordings_, std::memory_order_release);
  State expected = State::beginning;
  if (!state_.compare_exchange_strong(expected, opened ? State::on : State::idle,
                                      std::memory_order_acq_rel))
    taking_.store(0, std::memory_order_release); // it was ended meanwhile
  news_.post();
}

bool Recorder::open() {
  RecordingFacts facts;
  {
    const std::lock_guard lock{mutex_};
    open_file_ = file_;
    facts = facts_;
  }
  auto made = RecordingWriter::create(open_file_, facts);
  if (!made) {
    fail(Fault::recording_not_begun, made.error());
    return false;
  }
  writer_.emplace(std::move(*made));
  ++recordings_;
  room_.store(0, std::memory_order_relaxed);
  synced_ = clock_.now();
  since_ns_.store(synced_.time_since_epoch().count(), std::memory_order_relaxed);
  return true;
}

void Recorder::write_waiting() {
  while (const auto index = waiting_.pop()) {
    Heartbeat::beat_here(clock_.now());
    if (writer_ && places_[*index].recording == recordings_)
      write(places_[*index]);
    free_.push(*index);
  }
  if (!writer_ || clock_.now() - synced_ < between_syncs)
    return;
  if (const auto synced = writer_->sync(); !synced)
    give_up(fault_of_writing(synced.error(), Fault::recording_not_kept), synced.error());
  synced_ = clock_.now();
}

void Recorder::write(const Place& place) {
  std::error_code error;
  const auto room = std::filesystem::space(open_file_, error);
  if (!error && room.available < room_left_alone + place.volume.levels.size()) {
    give_up(Fault::recording_disk_full,
            {hal::ErrorCode::system,
             fmt::format("{}: the recording ended: only {} MB are left on its disk, and "
                         "{} stay free for the machine; free some room",
                         open_file_.string(), room.available >> 20, room_left_alone >> 20)});
    return;
  }
  if (!error)
    room_.store((room.available - room_left_alone) / place.volume.levels.size(),
                std::memory_order_relaxed);
  if (const auto appended = writer_->append(place.volume, place.entry); !appended) {
    give_up(Fault::recording_not_kept, appended.error());
    return;
  }
  kept_.fetch_add(1, std::memory_order_relaxed);
}

void Recorder::finish() {
  if (!writer_)
    return;
  const auto finished = writer_->finish({.not_kept = not_kept_.load(std::memory_order_relaxed)});
  writer_.reset();
  if (!finished)
    fail(fault_of_writing(finished.error(), Fault::recording_not_finished), finished.error());
}

// What is in the file stays there, marked as well as it can still be.
void Recorder::give_up(Fault fault, const hal::Error& error) {
  taking_.store(0, std::memory_order_relaxed);
  fail(fault, error);
  static_cast<void>(writer_->finish({.not_kept = not_kept_.load(std::memory_order_relaxed)}));
  writer_.reset();
}

void Recorder::fail(Fault fault, const hal::Error& error) {
  faults_.add(fault, error.message, clock_.now());
  const std::lock_guard lock{mutex_};
  failure_ = error;
}

} // namespace octascope::pipeline

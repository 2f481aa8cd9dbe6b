#include "pipeline/recordings/replay/replay_player.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "pipeline/threads/hot_path.h"

namespace octascope::pipeline {

using namespace std::chrono_literals;

namespace {

// Whoever watches the thread wants to see it alive.
constexpr hal::Duration longest_rest = 500ms;

// Later than this by a slow disk, and the rest of the replay is late by as much: nobody wants to
// see a pause made up for by a rush.
constexpr hal::Duration most_behind = 200ms;

hal::Duration planned_period(const RecordingFacts& facts) {
  const double s = facts.volume_period_s;
  return s > 0 && s < 3600 ? hal::from_seconds(s) : hal::Duration{100ms};
}

std::vector<Volume> make_replay_pool(const VolumeGeometry& geometry) {
  Volume volume{geometry};
  volume.occupancy = Occupancy{geometry, blank_depth_bins};
  return std::vector<Volume>(3, volume);
}

// Its history, so that it was ready just now.
void move_to(VolumeMetadata& metadata, const RecordedVolume& entry, hal::TimePoint now) {
  metadata.published = now;
  metadata.first_line = now - recorded_step(entry.first_line_ns, entry.published_ns);
  metadata.last_line = now - recorded_step(entry.last_line_ns, entry.published_ns);
  metadata.pulsed = metadata.first_line;
  metadata.recorded_ns = entry.wall_clock_ns;
}

// As the pipeline leaves it: whatever the file says of them, what is missing shows nothing.
void complete(Volume& volume) {
  for (int b = 0; b < volume.geometry.b_scans; ++b)
    if (volume.b_scan_states[static_cast<std::size_t>(b)] == BScanState::missing)
      std::ranges::fill(volume.b_scan(b), std::uint8_t{0});
  volume.occupancy.update(volume);
}

} // namespace

hal::Result<ReplaySource> replay_source(RecordingReader reader) {
  if (reader.volumes().empty())
    return hal::fail(hal::ErrorCode::bad_data,
                     "found a recording of no volumes, expected one at least");
  const auto shared = std::make_shared<RecordingReader>(std::move(reader));
  return ReplaySource{
      .facts = shared->facts(),
      .volumes = shared->volumes(),
      .read = [shared](std::size_t n, Volume& volume) { return shared->read(n, volume); }};
}

ReplayPlayer::ReplayPlayer(ReplaySource source, const ReplaySetup& setup, FaultLog& faults,
                           Wakeup& news)
    : source_{std::move(source)}, setup_{setup}, schedule_{source_.volumes,
                                                           planned_period(source_.facts),
                                                           setup.rate},
      faults_{faults}, news_{news}, volumes_{make_replay_pool(source_.facts.geometry)} {}

void ReplayPlayer::seek(std::size_t n) {
  wanted_.store(n, std::memory_order_relaxed);
}

void ReplayPlayer::hold(bool held) {
  hold_.store(held, std::memory_order_relaxed);
}

hal::TimePoint ReplayPlayer::step(hal::TimePoint now) {
  follow_requests(now);
  if (end() != ReplayEnd::none || held_since_)
    return now + longest_rest;
  if (!prepared_) {
    prepare(now);
    return now;
  }
  if (now < due_)
    return std::min(due_, now + longest_rest);
  publish(now);
  return now;
}

void ReplayPlayer::follow_requests(hal::TimePoint now) {
  if (const std::size_t n = wanted_.exchange(nowhere, std::memory_order_relaxed); n != nowhere)
    go_to(std::min(n, schedule_.size() - 1), now);
  else if (!begun_)
    begun_ = now;
  const bool held = hold_.load(std::memory_order_relaxed);
  if (held && !held_since_) {
    held_since_ = now;
  } else if (!held && held_since_) {
    *begun_ += now - *held_since_;
    due_ += now - *held_since_;
    held_since_.reset();
  }
}

void ReplayPlayer::go_to(std::size_t n, hal::TimePoint now) {
  next_ = n;
  prepared_ = false;
  begun_ = now - schedule_.offset(n);
  if (held_since_)
    held_since_ = now;
  last_index_.reset();
  finish(ReplayEnd::none);
}

// Of a file that was cut off meanwhile HDF5 reads zeros, and no error: a volume of which nothing
// came. Such a one is never published, and so was never recorded.
hal::Result<> ReplayPlayer::read_next() {
  Volume& volume = volumes_[reading_];
  return source_.read(next_, volume).and_then([&]() -> hal::Result<> {
    if (volume.missing_b_scans() < volume.geometry.b_scans)
      return {};
    return hal::fail(hal::ErrorCode::bad_data,
                     "volume {}: found none of its {} B-scans, expected one at least: the file is "
                     "damaged or was cut off",
                     next_, volume.geometry.b_scans);
  });
}

void ReplayPlayer::prepare(hal::TimePoint now) {
  if (const auto read = read_next(); !read) {
    faults_.add(Fault::unreadable_volume, read.error().message, now);
    count_gap(source_.volumes[next_].index);
    count_lost(1);
    advance();
    if (++unreadable_ >= schedule_.size())
      finish(ReplayEnd::unreadable);
    return;
  }
  const HotPath hot;
  unreadable_ = 0;
  complete(volumes_[reading_]);
  prepared_ = true;
  due_ = *begun_ + schedule_.offset(next_);
  if (now > due_ + most_behind) {
    *begun_ += now - due_;
    due_ = now;
  }
}

void ReplayPlayer::publish(hal::TimePoint now) {
  const HotPath hot;
  const RecordedVolume& entry = source_.volumes[next_];
  move_to(volumes_[reading_].metadata, entry, now);
  count(entry);
  position_.store(next_, std::memory_order_relaxed);
  const auto [recycled, skipped] = buffer_.publish(reading_);
  reading_ = recycled;
  prepared_ = false;
  if (skipped)
    counts_.skipped.fetch_add(1, std::memory_order_relaxed);
  advance();
  if (counts_.acquired.load(std::memory_order_relaxed) == setup_.most_volumes)
    finish(ReplayEnd::done);
  news_.post();
}

void ReplayPlayer::advance() {
  if (++next_ < schedule_.size())
    return;
  next_ = 0;
  last_index_.reset();
  *begun_ += schedule_.length();
  if (setup_.once)
    finish(counts_.acquired.load(std::memory_order_relaxed) > 0 ? ReplayEnd::done
                                                                : ReplayEnd::unreadable);
}

void ReplayPlayer::count_lost(std::uint64_t volumes) {
  const VolumeGeometry& geometry = source_.facts.geometry;
  const auto b_scans = volumes * static_cast<std::uint64_t>(geometry.b_scans);
  counts_.lost_volumes.fetch_add(volumes, std::memory_order_relaxed);
  counts_.lost_b_scans.fetch_add(b_scans, std::memory_order_relaxed);
  counts_.lost_lines.fetch_add(b_scans * static_cast<std::uint64_t>(geometry.a_scans),
                               std::memory_order_relaxed);
}

// What was lost, or not kept, between the volume before and this one.
void ReplayPlayer::count_gap(std::uint64_t index) {
  if (last_index_ && index > *last_index_)
    count_lost(index - *last_index_ - 1);
  last_index_ = index;
}

void ReplayPlayer::count(const RecordedVolume& entry) {
  count_gap(entry.index);
  const auto positive = [](std::int32_t value) {
    return static_cast<std::uint64_t>(std::max(value, 0));
  };
  counts_.acquired.fetch_add(1, std::memory_order_relaxed);
  counts_.lost_b_scans.fetch_add(positive(entry.lost_b_scans), std::memory_order_relaxed);
  counts_.lost_lines.fetch_add(positive(entry.lost_lines), std::memory_order_relaxed);
  counts_.saturated_lines.fetch_add(positive(entry.saturated_lines), std::memory_order_relaxed);
}

const Volume* ReplayPlayer::do_take_newest() {
  const auto index = buffer_.take();
  return index ? &volumes_[*index] : nullptr;
}

VolumeCounters ReplayPlayer::do_counters() const {
  VolumeCounters counters;
  counters.acquired = counts_.acquired;
  counters.published = counters.acquired;
  counters.skipped = counts_.skipped;
  counters.lost_lines = counts_.lost_lines;
  counters.lost_b_scans = counts_.lost_b_scans;
  counters.lost_volumes = counts_.lost_volumes;
  counters.planned = counters.acquired + counters.lost_volumes;
  counters.saturated_lines = counts_.saturated_lines;
  return counters;
}

} // namespace octascope::pipeline

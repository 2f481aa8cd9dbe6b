#include "pipeline/acquisition/volume_scheduler.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <span>

namespace octascope::pipeline {

using namespace std::chrono_literals;

namespace {

using Action = VolumeDecision::Action;

// How long after its sweep's end a volume waits for late B-scans, as a divisor of the sweep.
constexpr int grace_divisor = 6;

// How much longer at most until the camera's thread has looked at the camera that long, as another.
constexpr int look_divisor = 2;

// However slow a scan is: a thread that shows no life for longer is taken for stuck.
constexpr hal::Duration longest_pause = 500ms;

} // namespace

VolumeScheduler::VolumeScheduler(const ScanPlan& plan, std::optional<std::uint64_t> most_volumes)
    : plan_(plan), most_volumes_(most_volumes), sweeps_(plan) {
  const auto b_scans = static_cast<std::size_t>(plan_.b_scans);
  for (PendingVolume& volume : pending_)
    volume.slots.resize(b_scans);
  to_submit_.reserve(b_scans);
  overdue_.reserve(b_scans);
  free_.reserve(pool_size);
  for (std::uint32_t buffer = 0; buffer < pool_size; ++buffer) {
    if (buffer != first_middle && buffer != first_front)
      free_.push_back(buffer);
  }
}

TickDecision VolumeScheduler::tick(hal::TimePoint now) {
  TickDecision decision;
  next_tick_ += plan_.tick_period();
  for (; next_tick_ <= now; next_tick_ += plan_.tick_period()) {
    ++decision.slept_through;
    count(counts_.planned);
    count_lost_volume();
  }
  decision.pulse = !most_volumes_ ||
                   counts_.published.load(std::memory_order_relaxed) + under_way() < *most_volumes_;
  return decision;
}

std::optional<std::uint32_t> VolumeScheduler::pulsed(hal::TimePoint when,
                                                     std::optional<std::uint32_t> lent) {
  const hal::TimePoint end = begin_pulse(when);
  const auto found =
      std::find_if(free_.rbegin(), free_.rend(), [&](std::uint32_t b) { return b != lent; });
  if (found == free_.rend()) {
    count_lost_volume();
    return std::nullopt;
  }
  const std::uint32_t buffer = *found;
  free_.erase(std::prev(found.base()));
  open(pending_[buffer], end);
  return buffer;
}

// There is a place: what takes no frames any more is finished before the next pulse.
void VolumeScheduler::pass_over(hal::TimePoint when) {
  const hal::TimePoint end = begin_pulse(when);
  const auto places = std::span{pending_}.subspan(pool_size);
  const auto place = std::ranges::find(places, false, &PendingVolume::open);
  if (place == places.end())
    count_lost_volume();
  else
    open(*place, end);
}

hal::TimePoint VolumeScheduler::begin_pulse(hal::TimePoint when) {
  count(counts_.planned);
  last_number_ = counts_.planned.load(std::memory_order_relaxed);
  count(counts_.triggered);
  return sweeps_.pulsed(last_number_, when);
}

void VolumeScheduler::open(PendingVolume& volume, hal::TimePoint end) {
  volume.open = true;
  volume.facts = {.number = last_number_};
  volume.accept_until = end + plan_.sweep_duration() / grace_divisor;
  volume.give_up_at.reset();
  std::ranges::fill(volume.slots, BScanSlot{});
  volume.sweeps_came = 0;
  volume.submitted = 0;
  volume.flushed = 0;
  volume.made.store(0, std::memory_order_relaxed);
  volume.awaits_workers.store(false, std::memory_order_relaxed);
}

void VolumeScheduler::pulse_failed() {
  count(counts_.planned);
  count_lost_volume();
}

void VolumeScheduler::not_ready() {
  if (last_number_ > 0)
    pulse_failed();
}

bool VolumeScheduler::awaits_sweeps(const PendingVolume& volume) const {
  return volume.sweeps_came < plan_.sweeps() && volume.flushed < plan_.b_scans;
}

void VolumeScheduler::count_lost_volume() {
  count(counts_.lost_volumes);
  count(counts_.lost_b_scans, plan_.b_scans);
  count(counts_.lost_lines, std::int64_t{plan_.sweeps()} * plan_.a_scans);
}

std::uint64_t VolumeScheduler::under_way() const {
  return static_cast<std::uint64_t>(std::ranges::count_if(pending_, &PendingVolume::open));
}

std::optional<std::uint32_t> VolumeScheduler::find(std::uint64_t number) const {
  for (std::uint32_t i = 0; i < pending_.size(); ++i) {
    if (pending_[i].open && pending_[i].facts.number == number)
      return i;
  }
  return std::nullopt;
}

std::optional<std::uint32_t> VolumeScheduler::oldest(std::uint32_t begin, std::uint32_t end) const {
  std::optional<std::uint32_t> oldest;
  for (std::uint32_t i = begin; i < end; ++i) {
    if (pending_[i].open && (!oldest || pending_[i].facts.number < pending_[*oldest].facts.number))
      oldest = i;
  }
  return oldest;
}

std::optional<std::uint32_t> VolumeScheduler::oldest_built() const {
  return oldest(0, pool_size);
}

std::optional<std::uint32_t> VolumeScheduler::oldest_passed_over() const {
  return oldest(pool_size, static_cast<std::uint32_t>(pending_.size()));
}

FrameDecision VolumeScheduler::place(hal::TimePoint first_line, hal::TimePoint last_line) {
  to_submit_.clear();
  overdue_.clear();
  const auto sweep = sweeps_.place(first_line);
  if (!sweep)
    return {.verdict = FrameVerdict::outside};
  const auto buffer = find(sweep->volume);
  if (!buffer)
    return {.verdict = FrameVerdict::late};
  PendingVolume& volume = pending_[*buffer];
  const int b_scan = plan_.b_scan_of(sweep->sweep);
  const int repeat = sweep->sweep % plan_.repeats;
  BScanSlot& slot = volume.slots[static_cast<std::size_t>(b_scan)];
  if ((slot.came >> repeat & 1U) != 0)
    return {.verdict = FrameVerdict::doubled};
  if (slot.submitted)
    return {.verdict = FrameVerdict::late};
  if (volume.sweeps_came == 0)
    volume.facts.first_line = first_line;
  volume.facts.last_line = std::max(volume.facts.last_line, last_line);
  slot.came |= 1U << repeat;
  ++volume.sweeps_came;
  if (is_passed_over(*buffer))
    return {.verdict = FrameVerdict::passed_over};
  // One that nothing had come of when it was passed over waits no longer either.
  if (std::popcount(slot.came) == plan_.repeats || b_scan < volume.flushed)
    submit(*buffer, b_scan);
  flush(*buffer, b_scan - 1);
  return {.verdict = FrameVerdict::placed,
          .buffer = *buffer,
          .b_scan = b_scan,
          .repeat = repeat,
          .submit = to_submit_,
          .overdue = overdue_};
}

void VolumeScheduler::submit(std::uint32_t buffer, int b_scan) {
  PendingVolume& volume = pending_[buffer];
  volume.slots[static_cast<std::size_t>(b_scan)].submitted = true;
  ++volume.submitted;
  to_submit_.push_back({buffer, b_scan}); // each B-scan of a volume at most once
}

// B-scans before `end` wait no longer for the sweeps that they miss.
void VolumeScheduler::flush(std::uint32_t buffer, int end) {
  PendingVolume& volume = pending_[buffer];
  for (; volume.flushed < end; ++volume.flushed) {
    const BScanSlot& slot = volume.slots[static_cast<std::size_t>(volume.flushed)];
    if (slot.came == 0)
      overdue_.push_back(volume.flushed);
    else if (!slot.submitted)
      submit(buffer, volume.flushed);
  }
}

VolumeDecision VolumeScheduler::next(hal::TimePoint now, hal::TimePoint looked_until,
                                     bool streaming) {
  to_submit_.clear();
  overdue_.clear();
  if (const auto passed = oldest_passed_over()) {
    const VolumeDecision decision = next_of(*passed, now, looked_until, streaming);
    if (decision.action != Action::wait)
      return decision;
  }
  const auto built = oldest_built();
  return built ? next_of(*built, now, looked_until, streaming) : VolumeDecision{};
}

VolumeDecision VolumeScheduler::next_of(std::uint32_t buffer, hal::TimePoint now,
                                        hal::TimePoint looked_until, bool streaming) {
  PendingVolume& volume = pending_[buffer];
  if (awaits_sweeps(volume)) {
    if (now < volume.accept_until)
      return {};
    // Where others had the processor, the camera's frames came in time, and its thread wakes no
    // sooner than ours: until it has looked, they are late only here.
    if (looked_until < volume.accept_until && streaming) {
      if (!volume.give_up_at) {
        volume.give_up_at = now + plan_.sweep_duration() / look_divisor;
        return {.action = Action::look, .buffer = buffer, .look_until = volume.accept_until};
      }
      if (now < *volume.give_up_at)
        return {};
    }
  }
  if (!is_passed_over(buffer))
    flush(buffer, plan_.b_scans);
  if (!to_submit_.empty())
    return {.action = Action::submit, .buffer = buffer, .submit = to_submit_};
  volume.awaits_workers.store(true);
  if (volume.made.load() < volume.submitted)
    return {};
  return finish(buffer);
}

int VolumeScheduler::b_scans_without_sweep(const PendingVolume& volume) {
  return static_cast<int>(std::ranges::count(volume.slots, 0U, &BScanSlot::came));
}

VolumeDecision VolumeScheduler::finish(std::uint32_t buffer) {
  PendingVolume& volume = pending_[buffer];
  volume.open = false;
  volume.facts.lost_b_scans = b_scans_without_sweep(volume);
  volume.facts.lost_lines = (plan_.sweeps() - volume.sweeps_came) * plan_.a_scans;
  if (volume.sweeps_came == 0) {
    count_lost_volume();
    if (!is_passed_over(buffer))
      free_.push_back(buffer);
    return {.action = Action::lose, .buffer = buffer, .volume = volume.facts};
  }
  count(counts_.lost_b_scans, volume.facts.lost_b_scans);
  count(counts_.lost_lines, volume.facts.lost_lines);
  if (is_passed_over(buffer)) {
    count(counts_.passed_over);
    return {.action = Action::pass, .buffer = buffer, .volume = volume.facts};
  }
  return {.action = Action::publish, .buffer = buffer, .volume = volume.facts};
}

void VolumeScheduler::published(std::uint32_t recycled, bool skipped) {
  free_.push_back(recycled);
  count(counts_.acquired);
  count(counts_.published);
  if (skipped)
    count(counts_.skipped);
}

hal::TimePoint VolumeScheduler::next_wake(hal::TimePoint now) const {
  hal::TimePoint wake = std::min(next_tick_, now + longest_pause);
  for (const auto buffer : {oldest_built(), oldest_passed_over()})
    if (buffer && awaits_sweeps(pending_[*buffer])) {
      const PendingVolume& volume = pending_[*buffer];
      wake = std::min(wake, volume.give_up_at.value_or(volume.accept_until));
    }
  return wake;
}

VolumeCounters VolumeScheduler::counters() const {
  return {.planned = counts_.planned,
          .triggered = counts_.triggered,
          .acquired = counts_.acquired,
          .published = counts_.published,
          .skipped = counts_.skipped,
          .passed_over = counts_.passed_over,
          .lost_lines = counts_.lost_lines,
          .lost_b_scans = counts_.lost_b_scans,
          .lost_volumes = counts_.lost_volumes,
          .unfinished = counts_.unfinished,
          .saturated_lines = counts_.saturated_lines};
}

} // namespace octascope::pipeline

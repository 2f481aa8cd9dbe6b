#include "pipeline/acquisition/volume_thread.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pipeline/threads/heartbeat.h"
#include "pipeline/threads/hot_path.h"
#include "pipeline/volume/flow_scale.h"

namespace octascope::pipeline {

namespace {

using namespace std::chrono_literals;

Fault fault_of(FrameVerdict verdict) {
  switch (verdict) {
  case FrameVerdict::doubled: return Fault::doubled_frame;
  case FrameVerdict::late: return Fault::late_frame;
  case FrameVerdict::outside:
  case FrameVerdict::passed_over:
  case FrameVerdict::placed: break;
  }
  return Fault::unplaced_frame;
}

std::string complaint_about(FrameVerdict verdict, std::uint64_t sequence) {
  if (verdict == FrameVerdict::late)
    return fmt::format("frame {} came when its B-scan was made already", sequence);
  if (verdict == FrameVerdict::doubled)
    return fmt::format("frame {} is one of a sweep that is there already: are the camera's time "
                       "stamps late, or does something beside the scanner trigger it?",
                       sequence);
  return fmt::format("frame {} was exposed outside every sweep", sequence);
}

std::vector<Volume> make_pool(const VolumeGeometry& geometry, std::size_t size, bool with_flow) {
  Volume volume{geometry};
  if (with_flow) {
    volume.add_flow();
    volume.flow_marks = FlowMarks{geometry, blank_depth_bins};
  }
  volume.occupancy = Occupancy{geometry, blank_depth_bins};
  volume.work.resize(volume.b_scan_states.size());
  return std::vector<Volume>(size, volume);
}

// A third of a volume's time: workers with as much of theirs to spare have caught up before the last line.
hal::Duration longest_way(const ScanPlan& plan) {
  constexpr hal::Duration enough = 100ms; // for a volume's picture where nobody is in its way
  return std::min(enough, plan.sweep_duration() / 3);
}

} // namespace

VolumeThread::VolumeThread(VolumeThreadSetup setup, hal::GalvoTrigger& trigger,
                           Acquisition& acquisition, hal::LineCamera& camera, hal::Clock& clock,
                           FaultLog& faults, Wakeup& arrived, Wakeup& news)
    : setup_(std::move(setup)), trigger_(trigger), acquisition_(acquisition), camera_(camera),
      clock_(clock), faults_(faults), arrived_(arrived), news_(news),
      volumes_(make_pool(setup_.plan.geometry(), VolumeScheduler::pool_size,
                         setup_.comparison.has_value())),
      scheduler_(setup_.plan, setup_.most_volumes),
      builder_(setup_.plan, setup_.workers, setup_.reconstruct, std::move(setup_.comparison)),
      scan_lag_(setup_.plan, clock, faults) {
  for (Workplace& workplace : workplaces_) {
    workplace.sweeps.resize(static_cast<std::size_t>(setup_.plan.b_scans));
    workplace.assembler = std::make_unique<VolumeAssembler>(setup_.plan.geometry(), setup_.average);
  }
}

void VolumeThread::start(const ThreadSetup& setup) {
  scan_lag_.start(setup);
  const std::size_t most_jobs = volumes_.size() * static_cast<std::size_t>(setup_.plan.b_scans);
  held_back_.reserve(most_jobs);
  workers_ = std::make_unique<WorkerPool>(
      setup_.workers, most_jobs, setup,
      [this](std::size_t worker, std::uint32_t job) { reconstruct(worker, job); });
  thread_.start({"volumes"}, setup, [this] { run(); });
}

void VolumeThread::stop() {
  thread_.stop();
  scan_lag_.stop();
}

const Volume* VolumeThread::do_take_newest() {
  const auto index = triple_buffer_.take();
  if (!index)
    return nullptr;
  demand_.taken(volumes_[*index].metadata.published);
  return &volumes_[*index];
}

void VolumeThread::do_expect(Showing how) {
  right_of_way_.want(how == Showing::whole);
  demand_.expect(how);
}

void VolumeThread::do_note_drawn() {
  right_of_way_.give_up();
  demand_.drawn(clock_.now());
}

// The assembler's `progress` says what of it may be read.
std::optional<VolumeInMaking> VolumeThread::do_borrow_after(std::uint64_t after) {
  const auto lent = loan_.borrow_after(after);
  if (!lent)
    return std::nullopt;
  return VolumeInMaking{lent->number, &volumes_[lent->buffer],
                        workplaces_[lent->buffer].assembler->progress()};
}

void VolumeThread::run() {
  scheduler_.begin(clock_.now());
  while (!thread_.stopping()) {
    {
      const HotPath hot;
      Heartbeat::beat_here(clock_.now());
      if (scheduler_.tick_due(clock_.now()))
        tick();
      const hal::TimePoint looked_until = acquisition_.looked_until();
      while (const auto frame = acquisition_.take())
        place(*frame);
      finish_due_volumes(looked_until);
      submit_held_back();
    }
    arrived_.wait_until(clock_, next_wake());
  }
  // The workers' last jobs hold loans of the camera; those not begun are given back here.
  workers_.reset();
  scheduler_.end();
  for (Workplace& workplace : workplaces_) {
    for (Sweeps& sweeps : workplace.sweeps)
      release(sweeps);
  }
  while (const auto frame = acquisition_.take())
    acquisition_.release(frame->buffer);
  trigger_.close();
}

void VolumeThread::tick() {
  const hal::TimePoint now = clock_.now();
  const TickDecision decision = scheduler_.tick(now);
  if (decision.slept_through > 0)
    faults_.add(Fault::late_tick,
                "the fixed-rate thread was held up for a whole volume: is something else running, "
                "without real-time priority for us?",
                now, decision.slept_through);
  if (!decision.pulse)
    return;
  // Without a camera there is nothing to sweep for.
  if (camera_.state() == hal::DeviceState::streaming && trigger_ready())
    pulse(now);
  else
    scheduler_.not_ready();
}

// What becomes of a volume is settled before its first frame can come.
void VolumeThread::pulse(hal::TimePoint now) {
  const bool passed_over = passes_over(now);
  const auto pulsed = trigger_.pulse();
  if (!pulsed) {
    faults_.add(Device::galvo_trigger, pulsed.error(), now);
    if (trigger_.state() == hal::DeviceState::failed)
      trigger_.close();
    scheduler_.pulse_failed();
  } else if (passed_over) {
    scheduler_.pass_over(*pulsed);
  } else if (const auto buffer = scheduler_.pulsed(*pulsed, loan_.lent())) {
    begin_volume(*buffer, *pulsed);
  } else {
    faults_.add(Fault::overrun,
                "reconstruction is slower than the camera: fewer lines or B-scans, or linear "
                "interpolation, would help",
                *pulsed);
  }
}

// One that the renderer would not come to, and one for which the workers have not caught up, so that what
// is built is built whole.
bool VolumeThread::passes_over(hal::TimePoint now) const {
  if (demand_.expected() == Showing::nothing ||
      (setup_.wants_every_volume && setup_.wants_every_volume()))
    return false;
  const auto waits_since = triple_buffer_.has_newer() ? std::optional{waits_since_} : std::nullopt;
  return 2 * acquisition_.on_loan() > acquisition_.buffers() ||
         !demand_.would_be_seen(now, setup_.plan.tick_period(), waits_since,
                                scheduler_.is_building());
}

bool VolumeThread::trigger_ready() {
  if (trigger_.state() == hal::DeviceState::ready)
    return true;
  const hal::TimePoint now = clock_.now();
  if (!trigger_retry_.due(now))
    return false;
  const HotPath::Pause opening;
  if (const auto opened = trigger_.open(setup_.trigger); !opened) {
    faults_.add(Device::galvo_trigger, opened.error(), now);
    trigger_retry_.failure(now);
    return false;
  }
  trigger_retry_.success();
  return true;
}

void VolumeThread::begin_volume(std::uint32_t buffer, hal::TimePoint pulsed) {
  Workplace& workplace = workplaces_[buffer];
  workplace.alignment = SweepAlignment{setup_.plan, scan_lag_.in_use_a_scans()};
  workplace.sketch = scan_lag_.borrow();
  std::ranges::fill(workplace.sweeps, Sweeps{});
  workplace.saturated_lines.store(0, std::memory_order_relaxed);
  Volume& volume = volumes_[buffer];
  std::fill(volume.b_scan_states.begin(), volume.b_scan_states.end(), BScanState::missing);
  std::ranges::fill(volume.flow_states, FlowState::none);
  std::ranges::fill(volume.work, BScanWork{});
  workplace.assembler->begin(volume);
  volume.metadata = {};
  volume.metadata.pulsed = pulsed;
  volume.metadata.scan_lag_a_scans = workplace.alignment.scan_lag_a_scans();
  workplace.number = scheduler_.number_of(buffer);
  loan_.open(buffer, workplace.number);
}

void VolumeThread::place(const hal::LineFrame& frame) {
  const FrameDecision decision = scheduler_.place(frame.first_line, frame.last_line);
  if (decision.verdict == FrameVerdict::passed_over) {
    if (setup_.observe)
      setup_.observe(frame);
    acquisition_.release(frame.buffer);
    return;
  }
  if (decision.verdict != FrameVerdict::placed) {
    refuse(frame, decision.verdict);
    return;
  }
  workplaces_[decision.buffer].sweeps[static_cast<std::size_t>(decision.b_scan)]
                                     [static_cast<std::size_t>(decision.repeat)] = frame;
  note_last(volumes_[decision.buffer].metadata, frame);
  if (setup_.observe)
    setup_.observe(frame);
  submit(decision.submit);
  for (const int b_scan : decision.overdue)
    workplaces_[decision.buffer].assembler->overdue(b_scan);
}

// Frames come in order but for a camera's whims.
void VolumeThread::note_last(VolumeMetadata& metadata, const hal::LineFrame& frame) const {
  if (frame.last_line < metadata.last_line)
    return;
  metadata.last_line = frame.last_line;
  metadata.fetched = frame.fetched;
  metadata.placed = clock_.now();
}

// The sweep that it should have been counts as lost when its volume is finished.
void VolumeThread::refuse(const hal::LineFrame& frame, FrameVerdict verdict) {
  const auto complaint = [&] { return complaint_about(verdict, frame.sequence); };
  faults_.add(fault_of(verdict), complaint, clock_.now());
  acquisition_.release(frame.buffer);
}

void VolumeThread::submit(std::span<const BScanJob> jobs) {
  const hal::TimePoint now = clock_.now();
  if (held_back_.empty() && !holds_back(now))
    return begin(jobs);
  if (held_back_.empty())
    held_since_ = now;
  held_back_.insert(held_back_.end(), jobs.begin(), jobs.end()); // room is reserved
  submit_held_back();
}

// Not from workers that are behind already.
void VolumeThread::grant_right_of_way(hal::TimePoint published) {
  const int under_way = static_cast<int>(workers_->workers() + 1) * setup_.plan.repeats;
  if (acquisition_.on_loan() <= under_way)
    right_of_way_.grant(published + longest_way(setup_.plan));
}

// Half of the camera's buffers are left to it.
bool VolumeThread::holds_back(hal::TimePoint now) const {
  return now < right_of_way_.until() && 2 * acquisition_.on_loan() < acquisition_.buffers();
}

hal::TimePoint VolumeThread::next_wake() const {
  const hal::TimePoint wake = scheduler_.next_wake(clock_.now());
  return held_back_.empty() ? wake : std::min(wake, right_of_way_.until());
}

void VolumeThread::submit_held_back() {
  const hal::TimePoint now = clock_.now();
  if (held_back_.empty() || holds_back(now))
    return;
  right_of_way_.hand_over(held_since_, now);
  begin(held_back_);
  held_back_.clear();
}

// Never full: there is a place for every B-scan of the pool.
void VolumeThread::begin(std::span<const BScanJob> jobs) {
  for (const BScanJob& job : jobs)
    workers_->submit(job.buffer * static_cast<std::uint32_t>(setup_.plan.b_scans) +
                     static_cast<std::uint32_t>(job.b_scan));
}

void VolumeThread::release(Sweeps& sweeps) {
  for (hal::LineFrame& frame : sweeps) {
    if (frame.buffer >= 0)
      acquisition_.release(std::exchange(frame.buffer, -1));
  }
}

void VolumeThread::show_converted(std::size_t worker, const Workplace& workplace,
                                  int b_scan) const {
  const Sweeps& sweeps = workplace.sweeps[static_cast<std::size_t>(b_scan)];
  for (std::size_t repeat = 0; repeat < sweeps.size(); ++repeat)
    if (sweeps[repeat].buffer >= 0)
      setup_.observe_converted(worker,
                               {.frame = sweeps[repeat],
                                .volume = workplace.number,
                                .b_scan = b_scan,
                                .repeat = static_cast<int>(repeat),
                                .scan_lag_a_scans = workplace.alignment.scan_lag_a_scans()});
}

void VolumeThread::note_exposure(BScanWork& work, const Sweeps& sweeps) {
  work.first_line = hal::TimePoint::max();
  for (const hal::LineFrame& frame : sweeps)
    if (frame.buffer >= 0) {
      work.first_line = std::min(work.first_line, frame.first_line);
      work.last_line = std::max(work.last_line, frame.last_line);
    }
}

void VolumeThread::reconstruct(std::size_t worker, std::uint32_t job) {
  const auto b_scans = static_cast<std::uint32_t>(setup_.plan.b_scans);
  const std::uint32_t buffer = job / b_scans;
  const auto b_scan = static_cast<std::size_t>(job % b_scans);
  Workplace& workplace = workplaces_[buffer];
  Sweeps& sweeps = workplace.sweeps[b_scan];
  const hal::TimePoint begin = clock_.now();
  Heartbeat::beat_here(begin);
  const int b = static_cast<int>(b_scan);
  note_exposure(volumes_[buffer].work[b_scan], sweeps);
  const int saturated = builder_.build(
      worker, b, std::span{sweeps}.first(static_cast<std::size_t>(setup_.plan.repeats)),
      workplace.alignment, workplace.sketch, workplace.assembler->own_levels(b));
  volumes_[buffer].b_scan_states[b_scan] = saturated > 0 ? BScanState::saturated : BScanState::good;
  if (setup_.observe_converted)
    show_converted(worker, workplace, b);
  release(sweeps);
  if (builder_.compares())
    tell_flow(worker, volumes_[buffer], b);
  workplace.assembler->built(b);
  workplace.saturated_lines.fetch_add(saturated, std::memory_order_relaxed);
  BScanWork& work = volumes_[buffer].work[b_scan]; // the times of exposure may be read by now
  work.begin = begin;
  work.end = clock_.now();
  work.worker = static_cast<std::uint32_t>(worker);
  if (scheduler_.b_scan_made(buffer))
    arrived_.post();
}

// Workers that cannot keep up lose lines at last; before that they go without flow.
bool VolumeThread::is_behind(const BScanWork& work, hal::TimePoint now) const {
  const hal::TimePoint due = std::max(work.last_line, right_of_way_.caught_up());
  return now - due > setup_.plan.sweep_duration() / 8 ||
         4 * acquisition_.on_loan() > 3 * acquisition_.buffers();
}

// Before the B-scan is said to be built, so that whoever sees it sees its flow.
void VolumeThread::tell_flow(std::size_t worker, Volume& volume, int b_scan) {
  const hal::TimePoint begin = clock_.now();
  if (builder_.is_whole(worker) &&
      is_behind(volume.work[static_cast<std::size_t>(b_scan)], begin)) {
    std::ranges::fill(volume.b_scan_flow(b_scan), flow_untold); // its state is FlowState::none
    volume.flow_marks.clear(b_scan);
    statistics_.flow.no_time.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  volume.flow_states[static_cast<std::size_t>(b_scan)] =
      builder_.tell_flow(worker, volume.b_scan_flow(b_scan));
  volume.flow_marks.update(b_scan, volume.b_scan_flow(b_scan));
  statistics_.flow.tell.add(clock_.now() - begin);
}

// Of B-scans that nobody built there is none, and counts what is told of the others.
void VolumeThread::finish_flow(Volume& volume) {
  for (int b = 0; b < volume.geometry.b_scans; ++b)
    if (volume.b_scan_states[static_cast<std::size_t>(b)] == BScanState::missing) {
      std::ranges::fill(volume.b_scan_flow(b), flow_untold);
      volume.flow_marks.clear(b);
    }
  const auto count = [&](FlowState state) {
    return static_cast<std::uint64_t>(std::ranges::count(volume.flow_states, state));
  };
  const std::uint64_t none = count(FlowState::none);
  FlowStatistics& flow = statistics_.flow;
  flow.volumes.fetch_add(none == 0 ? 1 : 0, std::memory_order_relaxed);
  flow.told.fetch_add(count(FlowState::told), std::memory_order_relaxed);
  flow.left_out.fetch_add(count(FlowState::left_out), std::memory_order_relaxed);
  flow.none.fetch_add(none, std::memory_order_relaxed);
}

void VolumeThread::finish_due_volumes(hal::TimePoint looked_until) {
  using Action = VolumeDecision::Action;
  while (true) {
    const VolumeDecision decision =
        scheduler_.next(clock_.now(), looked_until, camera_.state() == hal::DeviceState::streaming);
    switch (decision.action) {
    case Action::wait: return;
    case Action::look: acquisition_.ask_for_look(decision.look_until); break;
    case Action::submit: submit(decision.submit); break;
    case Action::publish: publish(decision.buffer, decision.volume); break;
    case Action::pass: break;
    case Action::lose: lose(decision.buffer); break;
    }
  }
}

void VolumeThread::lose(std::uint32_t buffer) {
  if (buffer < VolumeScheduler::pool_size) { // else it was passed over
    loan_.close(buffer);
    if (workplaces_[buffer].sketch != nullptr)
      scan_lag_.finished();
  }
  if (camera_.state() != hal::DeviceState::streaming)
    return;
  faults_.add(Fault::missed_pulse,
              "a pulse brought no usable sweep: the scanner missed it, or the camera lost all "
              "of its frames",
              clock_.now());
  acquisition_.note_unanswered_pulse();
}

void VolumeThread::publish(std::uint32_t buffer, const FinishedVolume& finished) {
  Workplace& workplace = workplaces_[buffer];
  Volume& volume = volumes_[buffer];
  if (workplace.sketch != nullptr)
    scan_lag_.finished();
  const hal::TimePoint begin = clock_.now();
  workplace.assembler->finish();
  if (volume.has_flow())
    finish_flow(volume);
  fill_ledger(volume, workplace, finished);
  const hal::TimePoint assembled = clock_.now();
  volume.metadata.assemble = assembled - begin;
  volume.metadata.published = assembled;

  grant_right_of_way(assembled);
  const auto [recycled, skipped] = triple_buffer_.publish(buffer);
  loan_.close(recycled);
  if (!skipped)
    waits_since_ = assembled;
  statistics_.reconstruct.add(volume.metadata.reconstruct);
  statistics_.assemble.add(volume.metadata.assemble);
  statistics_.publish.add(clock_.now() - assembled);
  scheduler_.published(recycled, skipped);
  news_.post();
  if (setup_.observe_volume) // it stays as it is until the next one is published, here
    setup_.observe_volume(volume);
}

void VolumeThread::fill_ledger(Volume& volume, const Workplace& workplace,
                               const FinishedVolume& finished) {
  VolumeMetadata& metadata = volume.metadata;
  metadata.index = finished.number;
  metadata.first_line = finished.first_line;
  metadata.last_line = finished.last_line;
  metadata.lost_b_scans = finished.lost_b_scans;
  metadata.lost_lines = finished.lost_lines;
  for (const BScanWork& work : volume.work) {
    metadata.reconstruct += work.end - work.begin;
    metadata.built = std::max(metadata.built, work.end);
  }
  metadata.saturated_lines = workplace.saturated_lines.load(std::memory_order_relaxed);
  scheduler_.count_saturated_lines(metadata.saturated_lines);
  if (metadata.saturated_lines > 0)
    faults_.add(Fault::saturation,
                "lines reach the camera's full scale: less light, or a shorter exposure",
                clock_.now(), static_cast<std::uint64_t>(metadata.saturated_lines));
  if (is_at_upper_border(metadata.upper_border))
    faults_.add(
        Fault::upper_border,
        fmt::format("tissue reaches the upper border in {} of {} A-scans that were looked at: "
                    "what is above it is shown upside down; move the tissue or the reference "
                    "arm until there is a gap above the tissue",
                    metadata.upper_border.lit, metadata.upper_border.looked_at),
        clock_.now());
}

} // namespace octascope::pipeline

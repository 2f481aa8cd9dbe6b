#include <optional>
#include <string>
#include <utility>

#include "firmware-host/report/replay_report.h"
#include "firmware-host/report/replay_text.h"
#include "firmware-host/report/run_outputs.h"
#include "firmware-host/run/run_source.h"
#include "firmware-host/supervision/thread_roles.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/recordings/recording_reader.h"
#include "pipeline/recordings/replay/replay_thread.h"

namespace octascope::firmware_host {

namespace {

using namespace std::chrono_literals;
using pipeline::ReplayEnd;

constexpr hal::Duration pause_said_for = 3s;

class ReplaySource final : public RunSource {
public:
  explicit ReplaySource(const RunContext& run) : RunSource(run) {}

  hal::Result<> open() override;
  hal::Result<> prepare(Devices& devices, DeviceChoices choices) override {
    devices_ = &devices;
    return devices.make_controls(choices, options_, configuration_, clock_);
  }
  pipeline::PatientEye whose() const override {
    return {volumes_->facts().subject, volumes_->facts().eye};
  }
  void configure(RenderLoopSetup& setup) const override {
    const pipeline::RecordingFacts& facts = volumes_->facts();
    setup.geometry = facts.geometry;
    setup.host.simulated = facts.simulated;
    setup.host.replayed = true;
  }
  SourceParts parts() override { return {.volumes = *volumes_}; }
  pipeline::ThreadSetup thread_setup() override {
    return make_thread_setup(clock_, faults_, no_cores_);
  }

  hal::Result<> start() override {
    volumes_->start(thread_setup());
    return {};
  }
  void describe(HostStatus& host, hal::TimePoint now) override;
  std::string_view notice(hal::TimePoint now) const override {
    return now < pause_until_ ? std::string_view{pause_} : std::string_view{};
  }
  void advance(const RenderLoop& loop) override;
  bool done(const RenderLoop& loop) const override;

  void stop() override { volumes_->stop(); }
  hal::Result<> report(const RenderLoop& loop, const RunTimes& times) const override;
  hal::Result<> outcome() const override;

private:
  WorkerCores no_cores_{0, {}, {}};
  pipeline::RecordingEnd recording_end_;
  Devices* devices_ = nullptr;
  std::unique_ptr<pipeline::ReplayThread> volumes_;
  bool held_ = false;
  std::optional<std::size_t> told_position_;
  std::string pause_; // what was left out, while it is said
  hal::TimePoint pause_until_{};
};

hal::Result<> ReplaySource::open() {
  const ReplayOptions& wanted = *options_.replay;
  HAL_TRY(auto reader, pipeline::RecordingReader::open(wanted.file));
  const std::size_t volumes = reader.volumes().size();
  recording_end_ = reader.end();
  auto source = pipeline::replay_source(std::move(reader));
  if (!source)
    return hal::fail(source.error().code, "{}: {}", wanted.file.string(), source.error().message);
  if (wanted.from >= volumes)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--from is {}, expected 0 to {}: {} has {} volumes", wanted.from, volumes - 1,
                     wanted.file.string(), volumes);
  volumes_ = std::make_unique<pipeline::ReplayThread>(
      std::move(*source),
      pipeline::ReplaySetup{
          .rate = wanted.rate, .once = wanted.once, .most_volumes = options_.volumes},
      clock_, faults_, news_);
  volumes_->seek(wanted.from);
  if (const auto& assumed = volumes_->facts().geometry.assumed; assumed.any())
    warn("octascope replay: warning: spacings are assumed, not measured: {}\n", assumed.words());
  return {};
}

void ReplaySource::describe(HostStatus& host, hal::TimePoint now) {
  const std::size_t position = volumes_->position();
  if (told_position_ == position)
    return;
  told_position_ = position;
  const pipeline::ReplaySchedule& schedule = volumes_->schedule();
  const ReplayOptions& wanted = *options_.replay;
  host.source =
      recording_source(wanted.file, volumes_->facts(), position, schedule.size(), wanted.rate);
  if (const hal::Duration left_out = schedule.left_out_before(position); left_out.count() > 0) {
    pause_ = pause_words(left_out);
    pause_until_ = now + pause_said_for;
  }
}

// What is frozen is held, and not left behind: when it goes on, it goes on from there.
void ReplaySource::advance(const RenderLoop& loop) {
  if (const bool frozen = loop.actions().state().frozen; frozen != held_) {
    held_ = frozen;
    volumes_->hold(frozen);
  }
}

bool ReplaySource::done(const RenderLoop& loop) const {
  switch (volumes_->end()) {
  case ReplayEnd::none: return false;
  case ReplayEnd::unreadable: return true;
  case ReplayEnd::done: break;
  }
  return loop.shows_newest();
}

hal::Result<> ReplaySource::report(const RenderLoop& loop, const RunTimes& times) const {
  const hal::Duration lasted = times.ended - times.started;
  return leave_report(
      ReplayReport{.file = options_.replay->file,
                   .facts = volumes_->facts(),
                   .end = recording_end_,
                   .recorded = volumes_->schedule().size(),
                   .control_input = std::string{devices_->control_input().backend()},
                   .display = std::string{devices_->display().backend()},
                   .counters = loop.final_counters(lasted),
                   .quality = loop.statistics().quality.summary(),
                   .duration_s = hal::to_seconds(lasted),
                   .faults = faults_.records(),
                   .started = times.started},
      options_);
}

hal::Result<> ReplaySource::outcome() const {
  if (volumes_->end() != ReplayEnd::unreadable)
    return {};
  return hal::fail(hal::ErrorCode::bad_data,
                   "{}: no volume could be read any more: the file is damaged, or its disk is gone",
                   options_.replay->file.string());
}

} // namespace

std::unique_ptr<RunSource> make_replay_source(const RunContext& context) {
  return std::make_unique<ReplaySource>(context);
}

} // namespace octascope::firmware_host

#include "firmware-host/run/replay.h"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/kept/configuration_choice.h"
#include "firmware-host/devices/device_choice.h"
#include "firmware-host/devices/devices.h"
#include "firmware-host/outputs/picture_writer.h"
#include "firmware-host/report/notice.h"
#include "firmware-host/report/replay_report.h"
#include "firmware-host/report/replay_text.h"
#include "firmware-host/report/run_outputs.h"
#include "firmware-host/report/status_line.h"
#include "firmware-host/run/live_configuration.h"
#include "firmware-host/run/render_loop.h"
#include "firmware-host/run/stop_signal.h"
#include "firmware-host/supervision/thread_roles.h"
#include "hal/linux/monotonic_clock.h"
#include "pipeline/recordings/recording_reader.h"
#include "pipeline/recordings/replay/replay_thread.h"

namespace octascope::firmware_host {

namespace {

using namespace std::chrono_literals;
using pipeline::ReplayEnd;

constexpr hal::Duration pause_said_for = 3s;

class AssembledReplay final : public Replay {
public:
  AssembledReplay(RunOptions options, const ChosenConfiguration& chosen)
      : options_(std::move(options)), configuration_(chosen.configuration),
        live_configuration_(chosen, options_, std::nullopt, clock_, faults_) {}

  hal::Result<> assemble() {
    HAL_TRY(auto controls, load_controls(configuration_));
    HAL_CHECK(open_recording());
    HAL_CHECK(make_vessels());
    auto real = std::make_unique<RealDevices>(configuration_.devices,
                                              plan_of(options_, configuration_), clock_);
    const DeviceChoices choices =
        choose_devices(real->find_for(options_), options_, configuration_.devices);
    devices_ = std::make_unique<Devices>(std::move(real), choices, clock_);
    HAL_CHECK(devices_->make_controls(choices, options_, configuration_, clock_));
    controls_ = std::make_unique<pipeline::ControlThread>(devices_->control_input(), clock_,
                                                          faults_, news_);
    make_render_loop(std::move(controls));
    return {};
  }

  hal::Result<> run(StopSignal& stop_signal) override {
    HAL_CHECK(loop_->open());
    started_ = clock_.now();
    devices_->start_faults(started_);
    const pipeline::ThreadSetup setup = make_thread_setup(clock_, faults_, no_cores_);
    volumes_->start(setup);
    controls_->start(setup);
    show_until_done(stop_signal);
    const std::optional<pipeline::Image> picture =
        options_.snapshot ? loop_->picture() : std::optional<pipeline::Image>{};
    ended_ = clock_.now();
    volumes_->stop();
    controls_->stop();
    return leave_behind(picture);
  }

private:
  hal::Result<> open_recording();
  hal::Result<> make_vessels();
  void make_render_loop(ui::ControlProfile controls);
  void show_until_done(StopSignal& stop_signal);
  bool done() const;
  void follow_hands();
  void update_status();
  void tell_position(hal::TimePoint now);
  std::string_view notice(hal::TimePoint now);
  ReplayReport report() const;
  hal::Result<> leave_behind(const std::optional<pipeline::Image>& picture) const;

  const RunOptions options_;
  const Configuration configuration_;
  hal::linux_backend::MonotonicClock clock_;
  pipeline::FaultLog faults_;
  LiveConfiguration live_configuration_;
  PictureWriter pictures_{".", clock_, faults_};
  WorkerCores no_cores_{0, {}, {}};
  pipeline::Wakeup news_;
  pipeline::RecordingEnd recording_end_;
  std::unique_ptr<Devices> devices_;
  std::unique_ptr<pipeline::ReplayThread> volumes_;
  std::unique_ptr<pipeline::ControlThread> controls_;
  std::unique_ptr<VesselDisplay> vessels_;
  std::unique_ptr<RenderLoop> loop_;
  bool held_ = false;
  std::optional<std::size_t> told_position_;
  std::string pause_; // what was left out, while it is said
  hal::TimePoint pause_until_{};
  HostStatus host_;
  hal::TimePoint started_;
  hal::TimePoint ended_;
};

hal::Result<> AssembledReplay::open_recording() {
  const ReplayOptions& wanted = *options_.replay;
  HAL_TRY(auto reader, pipeline::RecordingReader::open(wanted.file));
  const std::size_t volumes = reader.volumes().size();
  recording_end_ = reader.end();
  auto source = pipeline::replay_source(std::move(reader));
  if (!source)
    return hal::fail(source.error().code,
                     fmt::format("{}: {}", wanted.file.string(), source.error().message));
  if (wanted.from >= volumes)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     fmt::format("--from is {}, expected 0 to {}: {} has {} volumes", wanted.from,
                                 volumes - 1, wanted.file.string(), volumes));
  volumes_ = std::make_unique<pipeline::ReplayThread>(
      std::move(*source),
      pipeline::ReplaySetup{
          .rate = wanted.rate, .once = wanted.once, .most_volumes = options_.volumes},
      clock_, faults_, news_);
  volumes_->seek(wanted.from);
  return {};
}

hal::Result<> AssembledReplay::make_vessels() {
  const pipeline::RecordingFacts& facts = volumes_->facts();
  return make_vessel_display(options_, {facts.subject, facts.eye}, clock_, faults_, news_)
      .map([this](std::unique_ptr<VesselDisplay> made) { vessels_ = std::move(made); });
}

void AssembledReplay::make_render_loop(ui::ControlProfile controls) {
  const pipeline::RecordingFacts& facts = volumes_->facts();
  RenderLoopSetup setup;
  setup.display = display_config(options_, configuration_);
  setup.b_scans = facts.geometry.b_scans;
  setup.view.b_scan = setup.b_scans / 2;
  setup.controls = std::move(controls);
  host_.simulated = facts.simulated;
  host_.whose_recording = whose_recording(facts); // before the first volume has come, too
  host_.configuration = live_configuration_.state();
  setup.host = host_;
  live_configuration_.configure(setup);
  sim::SimControlInput* const simulated = devices_->simulated_controls();
  loop_ = std::make_unique<RenderLoop>(
      RenderLoopParts{
          .display = devices_->display(),
          .clock = clock_,
          .volumes = *volumes_,
          .acquisition = nullptr,
          .scope = nullptr,
          .controls = *controls_,
          .faults = faults_,
          .news = news_,
          .keep_picture =
              [this](pipeline::Image picture) { return pictures_.keep(std::move(picture)); },
          .record = {},
          .simulated_control =
              simulated == nullptr
                  ? std::function<void(const hal::ControlEvent&)>{}
                  : [simulated](const hal::ControlEvent& event) { simulated->inject(event); },
          .threads = make_thread_setup(clock_, faults_, no_cores_),
          .vessels = vessels_.get()},
      std::move(setup));
}

void AssembledReplay::show_until_done(StopSignal& stop_signal) {
  StatusLine line{started_};
  do {
    devices_->apply_faults(clock_.now());
    follow_hands();
    live_configuration_.advance(*loop_);
    update_status();
    if (line.due(loop_->status().now))
      line.print(loop_->status(), loop_->counters());
  } while (loop_->turn() && !done() && !stop_signal.requested());
  line.finish();
}

bool AssembledReplay::done() const {
  if (options_.duration_s && clock_.now() - started_ >= hal::from_seconds(*options_.duration_s))
    return true;
  switch (volumes_->end()) {
  case ReplayEnd::none: return false;
  case ReplayEnd::unreadable: return true;
  case ReplayEnd::done: break;
  }
  return loop_->shows_newest();
}

// What is frozen is held, and not left behind: when it goes on, it goes on from there.
void AssembledReplay::follow_hands() {
  if (auto profile = devices_->new_control_profile())
    live_configuration_.lead_with(std::move(*profile), *loop_);
  if (const auto complaint = devices_->new_keyboard_complaint())
    faults_.add(pipeline::Fault::keyboard_not_opened, *complaint, clock_.now());
  if (const bool frozen = loop_->actions().state().frozen; frozen != held_) {
    held_ = frozen;
    volumes_->hold(frozen);
  }
}

void AssembledReplay::update_status() {
  using pipeline::Device;
  host_.devices = {{{Device::control_input, devices_->control_input().backend(),
                     devices_->control_input().state()},
                    {Device::display, devices_->display().backend(), devices_->display().state()}}};
  host_.device_count = 2;
  const hal::TimePoint now = clock_.now();
  tell_position(now);
  host_.notice = notice(now);
  loop_->tell(host_);
}

void AssembledReplay::tell_position(hal::TimePoint now) {
  const std::size_t position = volumes_->position();
  if (told_position_ == position)
    return;
  told_position_ = position;
  const pipeline::ReplaySchedule& schedule = volumes_->schedule();
  host_.source = recording_source(options_.replay->file, volumes_->facts(), position,
                                  schedule.size(), options_.replay->rate);
  if (const hal::Duration left_out = schedule.left_out_before(position); left_out.count() > 0) {
    pause_ = pause_words(left_out);
    pause_until_ = now + pause_said_for;
  }
}

std::string_view AssembledReplay::notice(hal::TimePoint now) {
  const auto devices = std::span<const ui::DeviceStatus>{host_.devices}.first(host_.device_count);
  if (const auto fault = compose_notice(faults_.records(), devices, now); !fault.empty())
    return fault;
  if (now < pause_until_)
    return pause_;
  if (const auto configuration = live_configuration_.notice(); !configuration.empty())
    return configuration;
  return vessels_ ? vessels_->notice(now) : std::string_view{};
}

ReplayReport AssembledReplay::report() const {
  return {.file = options_.replay->file,
          .facts = volumes_->facts(),
          .end = recording_end_,
          .recorded = volumes_->schedule().size(),
          .control_input = std::string{devices_->control_input().backend()},
          .display = std::string{devices_->display().backend()},
          .counters = loop_->final_counters(ended_ - started_),
          .duration_s = hal::to_seconds(ended_ - started_),
          .faults = faults_.records(),
          .started = started_};
}

hal::Result<> AssembledReplay::leave_behind(const std::optional<pipeline::Image>& picture) const {
  const ReplayReport finished = report();
  fmt::print("{}", to_text(finished));
  if (options_.report) {
    HAL_CHECK(write_report(finished, *options_.report));
    fmt::print("report:   {}\n", options_.report->string());
  }
  HAL_CHECK(leave_snapshot(options_, picture));
  if (volumes_->end() == ReplayEnd::unreadable)
    return hal::fail(hal::ErrorCode::bad_data,
                     fmt::format("{}: no volume could be read any more: the file is damaged, or "
                                 "its disk is gone",
                                 options_.replay->file.string()));
  return {};
}

} // namespace

hal::Result<std::unique_ptr<Replay>> Replay::assemble(const RunOptions& options) {
  HAL_CHECK(check_outputs(options));
  HAL_TRY(auto chosen, choose_configuration(options, std::nullopt));
  auto replay = std::make_unique<AssembledReplay>(options, chosen);
  HAL_CHECK(replay->assemble());
  return replay;
}

} // namespace octascope::firmware_host

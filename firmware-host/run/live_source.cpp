#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "firmware-host/configuration/kept/configuration_choice.h"
#include "firmware-host/devices/calibrated_camera.h"
#include "firmware-host/outputs/run_recorder.h"
#include "firmware-host/reconstruction/reconstruction.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "firmware-host/report/run_outputs.h"
#include "firmware-host/run/camera_hotplug.h"
#include "firmware-host/run/opening_picture.h"
#include "firmware-host/run/process_start.h"
#include "firmware-host/run/raw_recording.h"
#include "firmware-host/run/run_source.h"
#include "firmware-host/supervision/supervision.h"
#include "firmware-host/supervision/thread_roles.h"
#include "firmware-host/terminal/terminal.h"
#include "firmware-host/version/version.h"
#include "hal/linux/realtime.h"
#include "hal/linux/system/system_error.h"
#include "pipeline/acquisition/volume_thread.h"

namespace octascope::firmware_host {

using namespace std::chrono_literals;

namespace {

// Of a machine that starts, or of a device that sends udev events for ever.
constexpr hal::Duration longest_wait_for_udev = 5s;

std::filesystem::path recording_folder(const Configuration& configuration) {
  const auto state = service_folders().state;
  return configuration.recording_folder.value_or(state ? *state / "recordings" : ".");
}

class LiveSource final : public RunSource {
public:
  LiveSource(const RunContext& context, const ChosenConfiguration& chosen,
             CrashReport& crash_report)
      : RunSource(context), supervision_({.folders = service_folders(),
                                          .configuration = chosen.used,
                                          .configuration_state = chosen.state,
                                          .metrics = chosen.configuration.metrics,
                                          .journal = stderr_is_journal()},
                                         crash_report, context.clock, context.faults),
        configuration_text_(chosen.used ? configuration_text(*chosen.used) : std::string{}) {}

  // The trigger goes, and crashes are reported on.
  ~LiveSource() override { supervision_.crash_report().set_last_act(nullptr, nullptr); }

  hal::Result<> prepare(Devices& devices, DeviceChoices choices) override;
  pipeline::PatientEye whose() const override { return {options_.subject, options_.eye}; }
  void configure(RenderLoopSetup& setup) const override;
  SourceParts parts() override {
    return {.volumes = *volumes_,
            .acquisition = acquisition_.get(),
            .scope = scope_.get(),
            .record = [this] { return toggle_recording(); },
            .proof = &supervision_.picture()};
  }
  pipeline::ThreadSetup thread_setup() override {
    return make_thread_setup(clock_, faults_, reconstruction_->worker_cores(),
                             &supervision_.threads());
  }

  void opening_display() override { supervision_.starting("drawing the first picture"); }
  hal::Result<> start() override;

  void describe(HostStatus& host, hal::TimePoint now) override;
  void advance(const RenderLoop& loop) override;
  bool done(const RenderLoop& loop) const override;

  void ending() override { supervision_.stop(); }
  void stop() override;
  hal::Result<> report(const RenderLoop& loop, const RunTimes& times) const override;
  hal::Result<> outcome() const override {
    HAL_CHECK(recordings_->outcome());
    return raw_ ? raw_outcome(*raw_) : hal::Result<>{};
  }

private:
  bool wait_for_udev();
  void look_out_for_camera();
  void heed_camera_hotplug();
  void make_calibrated_camera();
  void make_recordings();
  std::string_view toggle_recording();
  void make_threads();
  void listen_to_scanner();
  RunStatistics account(const RenderLoop& loop) const;

  Supervision supervision_; // outlives every thread
  const std::string configuration_text_;
  ReconstructionCache cache_; // before whatever plans a transform: it brings FFTW's wisdom
  Devices* devices_ = nullptr;
  std::unique_ptr<CalibratedCamera> calibrated_camera_;
  std::unique_ptr<Reconstruction> reconstruction_;
  pipeline::Wakeup arrived_;                   // B-scans, for the fixed-rate thread
  std::unique_ptr<RunRecorder> recordings_;    // outlives the volumes' thread
  std::unique_ptr<pipeline::RawRecorder> raw_; // likewise; null: not asked for
  std::unique_ptr<pipeline::Acquisition> acquisition_;
  std::unique_ptr<pipeline::VolumeThread> volumes_;
  std::unique_ptr<pipeline::ScopeThread> scope_;
  std::unique_ptr<CameraHotplug> camera_hotplug_; // while a twin serves in its place
  bool ends_for_camera_ = false;
};

hal::Result<> LiveSource::prepare(Devices& devices, DeviceChoices choices) {
  devices_ = &devices;
  supervision_.starting("opening the display");
  show_opening_picture(devices.display(), display_config(options_, configuration_),
                       supervision_.is_service(), clock_);
  if (camera_may_come(choices, options_, configuration_.devices) && wait_for_udev())
    choices = choose_devices(devices.find_again(options_), options_, configuration_.devices);
  if (camera_may_come(choices, options_, configuration_.devices))
    look_out_for_camera();
  supervision_.starting("preparing the devices");
  HAL_CHECK(devices.make_others(choices, options_, configuration_, clock_));
  make_calibrated_camera();
  supervision_.crash_report().set_last_act(
      [](void* made) { static_cast<Devices*>(made)->make_trigger_safe(); }, devices_);
  supervision_.starting("measuring the reconstruction");
  HAL_TRY(auto reconstruction, Reconstruction::make(devices, configuration_,
                                                    tells_flow(options_, configuration_), cache_));
  reconstruction_ = std::move(reconstruction);
  make_recordings();
  make_threads();
  return recordings_->check();
}

// A service may be started with the machine: udev is about to give the cameras to their group.
// False: it was done already, and nothing is new.
bool LiveSource::wait_for_udev() {
  if (!supervision_.is_service() || !hal::linux_backend::udev_is_at_work())
    return false;
  supervision_.starting("waiting for the devices");
  const hal::TimePoint latest = clock_.now() + longest_wait_for_udev;
  while (hal::linux_backend::udev_is_at_work() && clock_.now() < latest)
    clock_.sleep_for(20ms);
  return true;
}

void LiveSource::look_out_for_camera() {
  camera_hotplug_ = std::make_unique<CameraHotplug>([this] {
    RealDevices now{configuration_.devices, plan_of(options_, configuration_), clock_};
    return now.find_line_camera().usable;
  });
}

// A service ends for it, and is started anew with it at once; whoever started the program by hand
// is told.
void LiveSource::heed_camera_hotplug() {
  if (!camera_hotplug_ || !camera_hotplug_->came())
    return;
  camera_hotplug_.reset();
  faults_.add(pipeline::Fault::came_late,
              "a line camera is there now; octascope takes it when it is started again, which the "
              "service does by itself",
              clock_.now());
  ends_for_camera_ = supervision_.is_service();
}

// Raw spectra in a file are of a camera that nobody knows: there is nothing to ask for.
void LiveSource::make_calibrated_camera() {
  const std::string& camera = devices_->calibration().camera;
  calibrated_camera_ = std::make_unique<CalibratedCamera>(camera, faults_);
  const auto& file = options_.calibration ? options_.calibration : configuration_.calibration;
  if (file && camera.empty() && !options_.recording)
    warn("octascope run: {}\n", words_on_unnamed_camera(*file));
  if (!file)
    return;
  if (const auto doubt = pipeline::doubt_about_k_table(devices_->calibration(), *file))
    warn("octascope run: {}\n", *doubt);
}

void LiveSource::make_recordings() {
  const pipeline::ScanPlan& plan = devices_->plan();
  if (plan.assumed_spacings.any())
    warn("octascope run: warning: spacings are assumed, not measured: {}; [depth] of a "
         "calibration gives them\n",
         plan.assumed_spacings.words());
  if (options_.record_to && tells_flow(options_, configuration_))
    warn("octascope run: warning: recordings keep no flow, only levels\n");
  recordings_ = std::make_unique<RunRecorder>(
      RecordingSetup{.folder = recording_folder(configuration_),
                     .file = options_.record_to,
                     .facts = {.geometry = plan.geometry(),
                               .volume_period_s = hal::to_seconds(plan.tick_period()),
                               .recorded_by = fmt::format("octascope {}", version()),
                               .begun = {}, // each its own
                               .source = devices_->source(),
                               .simulated = devices_->simulated(),
                               .subject = options_.subject,
                               .eye = options_.eye,
                               .configuration = configuration_text_}},
      clock_, faults_, news_);
}

// What they lack must not be missed when it is too late.
std::string_view LiveSource::toggle_recording() {
  const std::string_view done = recordings_->toggle();
  return done == "begun" && volumes_->has_flow() ? "begun, without flow" : done;
}

void LiveSource::make_threads() {
  const hal::LineCameraConfig camera = devices_->camera_config();
  acquisition_ = std::make_unique<pipeline::Acquisition>(devices_->line_camera(), camera, clock_,
                                                         faults_, arrived_);
  pipeline::VolumeThreadSetup setup =
      reconstruction_->volume_thread_setup(devices_->plan(), camera.buffers);
  setup.trigger = {.pulse_width = configuration_.devices.pulse_width};
  setup.observe_volume = [this](const pipeline::Volume& volume) { recordings_->offer(volume); };
  setup.wants_every_volume = [this] { return options_.raw_to || recordings_->is_on(); };
  setup.most_volumes = options_.volumes;
  if (options_.raw_to) {
    raw_ = std::make_unique<pipeline::RawRecorder>(
        *options_.raw_to, raw_facts(*devices_, *reconstruction_, options_, configuration_text_),
        setup.workers, 0, clock_, faults_);
    offer_frames(setup, *reconstruction_, *raw_);
  }
  volumes_ = std::make_unique<pipeline::VolumeThread>(std::move(setup), devices_->galvo_trigger(),
                                                      *acquisition_, devices_->line_camera(),
                                                      clock_, faults_, arrived_, news_);
  if (hal::ScopeCamera* const scope = devices_->scope_camera())
    scope_ = std::make_unique<pipeline::ScopeThread>(*scope, hal::ScopeCameraConfig{}, clock_,
                                                     faults_, news_);
}

void LiveSource::configure(RenderLoopSetup& setup) const {
  const pipeline::ScanPlan& plan = devices_->plan();
  setup.geometry = plan.geometry();
  setup.freshness = {plan.tick_period(), configuration_.veil_after};
  setup.lines_per_frame = plan.lines_per_frame();
  setup.scan_field = devices_->scan_field();
  setup.host.simulated = devices_->simulated();
  setup.host.source = devices_->source();
  if (configuration_.objective)
    setup.host.source += ", objective " + configuration_.objective->name;
}

hal::Result<> LiveSource::start() {
  if (const auto locked = hal::linux_backend::lock_memory(); !locked)
    faults_.add(pipeline::Fault::memory_not_locked, locked.error().message, clock_.now());
  supervision_.start(process_start(clock_));
  const pipeline::ThreadSetup setup = thread_setup();
  // Raw spectra first: where they cannot begin, nothing is left in the way of another attempt, and
  // the levels' file was looked at before.
  if (raw_)
    HAL_CHECK(raw_->start(setup));
  HAL_CHECK(recordings_->start(setup));
  HAL_CHECK(acquisition_->start(setup));
  volumes_->start(setup);
  if (scope_)
    scope_->start(setup);
  return {};
}

// Consumers first: the acquisition waits for its loans.
void LiveSource::stop() {
  volumes_->stop();
  recordings_->stop();
  if (raw_)
    raw_->stop(devices_->line_camera().identity());
  acquisition_->stop();
  if (scope_)
    scope_->stop();
}

void LiveSource::describe(HostStatus& host, hal::TimePoint now) {
  calibrated_camera_->look(devices_->line_camera(), now);
  host.another_camera = calibrated_camera_->verdict() == CameraVerdict::another;
  host.recording = recordings_->status(now);
  if (raw_)
    add_raw(host.recording, raw_->status(), now);
}

void LiveSource::advance(const RenderLoop& loop) {
  listen_to_scanner();
  heed_camera_hotplug();
  const hal::TimePoint now = clock_.now();
  if (supervision_.wants_status(now))
    supervision_.tell(picture_status(account(loop), now));
}

void LiveSource::listen_to_scanner() {
  if (devices_->new_missed_answers() > 0)
    faults_.add(pipeline::Fault::unanswered_pulse,
                "the scanner did not answer a pulse on its sync line: is it on, and is the line "
                "connected?",
                clock_.now());
}

bool LiveSource::done(const RenderLoop& loop) const {
  const auto& volumes = options_.volumes;
  return ends_for_camera_ ||
         (volumes && volumes_->counters().published >= *volumes && loop.shows_newest());
}

RunStatistics LiveSource::account(const RenderLoop& loop) const {
  return {.devices = *devices_,
          .reconstructor = reconstruction_->reconstructor(),
          .worker_cores = reconstruction_->worker_cores(),
          .volumes = *volumes_,
          .loop = loop,
          .calibrated_camera = *calibrated_camera_};
}

hal::Result<> LiveSource::report(const RenderLoop& loop, const RunTimes& times) const {
  HAL_CHECK(leave_report(report_on(account(loop), times, faults_.records()), options_));
  for (const KeptRecording& recording : recordings_->kept())
    if (recording.is_there() && recording.kept > 0)
      say("recording: {}, {} volumes{}\n", recording.file.string(), recording.kept,
          recording.not_kept > 0 ? fmt::format(", {} not kept", recording.not_kept) : "");
  if (raw_ && raw_->status().kept > 0 && !raw_->failure())
    say("raw spectra: {}\n", raw_summary(*raw_));
  return {};
}

} // namespace

std::unique_ptr<RunSource> make_live_source(const RunContext& context,
                                            const ChosenConfiguration& chosen,
                                            CrashReport& crash_report) {
  return std::make_unique<LiveSource>(context, chosen, crash_report);
}

} // namespace octascope::firmware_host

#include "firmware-host/run/appliance.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <span>
#include <sstream>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/kept/configuration_choice.h"
#include "firmware-host/configuration/kept/configuration_watch.h"
#include "firmware-host/devices/calibrated_camera.h"
#include "firmware-host/devices/device_choice.h"
#include "firmware-host/devices/devices.h"
#include "firmware-host/outputs/picture_writer.h"
#include "firmware-host/outputs/run_recorder.h"
#include "firmware-host/reconstruction/reconstruction.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "firmware-host/report/notice.h"
#include "firmware-host/report/report.h"
#include "firmware-host/report/run_outputs.h"
#include "firmware-host/report/status_line.h"
#include "firmware-host/run/camera_hotplug.h"
#include "firmware-host/run/live_configuration.h"
#include "firmware-host/run/opening_picture.h"
#include "firmware-host/run/process_start.h"
#include "firmware-host/run/render_loop.h"
#include "firmware-host/run/run_statistics.h"
#include "firmware-host/run/stop_signal.h"
#include "firmware-host/supervision/supervision.h"
#include "firmware-host/supervision/thread_roles.h"
#include "firmware-host/version/version.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/realtime.h"
#include "hal/linux/system/system_error.h"
#include "pipeline/acquisition/volume_thread.h"
#include "pipeline/files/png_image.h"

namespace octascope::firmware_host {

using namespace std::chrono_literals;

namespace {

// The line camera's buffers: a volume and a sixth of it is what the workers may fall behind, and
// more than so many drivers do not have.
int camera_buffers(const pipeline::ScanPlan& plan) {
  return std::clamp(plan.sweeps() * 7 / 6, 96, 512);
}

// Of a machine that starts, or of a device that sends udev events for ever.
constexpr hal::Duration longest_wait_for_udev = 5s;

// What another configuration could fix.
bool is_about_configuration(const hal::Error& error) {
  return error.code == hal::ErrorCode::invalid_argument || error.code == hal::ErrorCode::bad_data;
}

// A service has a place for what the surgeon keeps; else it goes where the program was started.
std::filesystem::path picture_folder() {
  const auto state = service_folders().state;
  if (!state)
    return ".";
  std::error_code ignored; // a picture that cannot be kept is a fault of its own
  std::filesystem::create_directories(*state / "pictures", ignored);
  return *state / "pictures";
}

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream{file, std::ios::binary}.rdbuf();
  return text.str();
}

std::filesystem::path recording_folder(const Configuration& configuration) {
  const auto state = service_folders().state;
  return configuration.recording_folder.value_or(state ? *state / "recordings" : ".");
}

class AssembledAppliance final : public Appliance {
public:
  AssembledAppliance(RunOptions options, const ChosenConfiguration& chosen,
                     CrashReport& crash_report)
      : options_(std::move(options)), configuration_(chosen.configuration),
        supervision_({.folders = service_folders(),
                      .configuration = chosen.used,
                      .configuration_state = chosen.state,
                      .metrics = configuration_.metrics,
                      .journal = stderr_is_journal()},
                     crash_report, clock_, faults_),
        live_configuration_(chosen, options_, service_folders().state, clock_, faults_),
        configuration_text_(chosen.used ? text_of(*chosen.used) : std::string{}) {}

  // The trigger goes, and crashes are reported on.
  ~AssembledAppliance() override { supervision_.crash_report().set_last_act(nullptr, nullptr); }

  hal::Result<> assemble() {
    hal::linux_backend::keep_large_blocks_apart();
    HAL_CHECK(check_outputs(options_));
    HAL_TRY(auto controls, load_controls(configuration_));
    control_profile_ = std::move(controls);
    auto real = std::make_unique<RealDevices>(configuration_.devices,
                                              plan_of(options_, configuration_), clock_);
    DeviceChoices choices =
        choose_devices(real->find_for(options_), options_, configuration_.devices);
    devices_ = std::make_unique<Devices>(std::move(real), choices, clock_);
    supervision_.starting("opening the display");
    show_opening_picture(devices_->display(), display_config(options_, configuration_),
                         supervision_.is_service(), clock_);
    if (camera_may_come(choices, options_, configuration_.devices) && wait_for_udev())
      choices = choose_devices(devices_->find_again(options_), options_, configuration_.devices);
    if (camera_may_come(choices, options_, configuration_.devices))
      look_out_for_camera();
    supervision_.starting("preparing the devices");
    HAL_CHECK(devices_->make_others(choices, options_, configuration_, clock_));
    make_calibrated_camera();
    supervision_.crash_report().set_last_act(
        [](void* made) { static_cast<Devices*>(made)->make_trigger_safe(); }, devices_.get());
    supervision_.starting("measuring the reconstruction");
    HAL_TRY(auto reconstruction, Reconstruction::make(*devices_, configuration_, cache_));
    reconstruction_ = std::move(reconstruction);
    if (auto made = make_vessels(); !made) // not before: reading a tree would disturb the measuring
      return made;
    make_recordings();
    make_threads();
    make_render_loop();
    return recordings_->check();
  }

  void follow_configuration(std::unique_ptr<ConfigurationWatch> watch) {
    live_configuration_.follow(std::move(watch));
  }

  hal::Result<> run(StopSignal& stop_signal) override {
    supervision_.starting("drawing the first picture");
    HAL_CHECK(loop_->open());
    if (const auto locked = hal::linux_backend::lock_memory(); !locked)
      faults_.add(pipeline::Fault::memory_not_locked, locked.error().message, clock_.now());
    started_ = clock_.now();
    supervision_.start(process_start(clock_));
    HAL_CHECK(start_threads());
    show_until_done(stop_signal);
    supervision_.stop();
    const std::optional<pipeline::Image> picture =
        options_.snapshot ? loop_->picture() : std::optional<pipeline::Image>{};
    ended_ = clock_.now();
    live_configuration_.finish(*loop_);
    stop_threads();
    return leave_behind(picture);
  }

private:
  bool wait_for_udev();
  void look_out_for_camera();
  void heed_camera_hotplug();
  hal::Result<> make_vessels();
  void make_calibrated_camera();
  void make_recordings();
  void make_threads();
  void make_render_loop();
  hal::Result<> start_threads();
  void stop_threads();
  void show_until_done(StopSignal& stop_signal);
  bool done() const;
  void follow_controls();
  void listen_to_scanner();
  void update_status();
  void tell_supervision();
  RunStatistics account() const;
  hal::Result<> leave_behind(const std::optional<pipeline::Image>& picture) const;

  RunOptions options_;
  Configuration configuration_;
  ui::ControlProfile control_profile_;
  hal::linux_backend::MonotonicClock clock_;
  pipeline::FaultLog faults_;
  Supervision supervision_; // outlives every thread
  LiveConfiguration live_configuration_;
  PictureWriter pictures_{picture_folder(), clock_, faults_};
  ReconstructionCache cache_; // before whatever plans a transform: it brings FFTW's wisdom
  std::unique_ptr<Devices> devices_;
  std::unique_ptr<CalibratedCamera> calibrated_camera_;
  std::unique_ptr<Reconstruction> reconstruction_;
  pipeline::Wakeup arrived_; // B-scans, for the fixed-rate thread
  pipeline::Wakeup news_;    // anything new to show, for the render thread
  std::string configuration_text_;
  std::unique_ptr<RunRecorder> recordings_; // outlives the volumes' thread
  std::unique_ptr<pipeline::Acquisition> acquisition_;
  std::unique_ptr<pipeline::VolumeThread> volumes_;
  std::unique_ptr<pipeline::ScopeThread> scope_;
  std::unique_ptr<pipeline::ControlThread> controls_;
  std::unique_ptr<VesselDisplay> vessels_;
  std::unique_ptr<RenderLoop> loop_;
  std::unique_ptr<CameraHotplug> camera_hotplug_; // while a twin serves in its place
  bool ends_for_camera_ = false;
  HostStatus host_;
  hal::TimePoint started_;
  hal::TimePoint ended_;
};

// A service may be started with the machine: udev is about to give the cameras to their group.
// False: it was done already, and nothing is new.
bool AssembledAppliance::wait_for_udev() {
  if (!supervision_.is_service() || !hal::linux_backend::udev_is_at_work())
    return false;
  supervision_.starting("waiting for the devices");
  const hal::TimePoint latest = clock_.now() + longest_wait_for_udev;
  while (hal::linux_backend::udev_is_at_work() && clock_.now() < latest)
    clock_.sleep_for(20ms);
  return true;
}

void AssembledAppliance::look_out_for_camera() {
  camera_hotplug_ = std::make_unique<CameraHotplug>([this] {
    RealDevices now{configuration_.devices, plan_of(options_, configuration_), clock_};
    return now.find_line_camera().usable;
  });
}

// A service ends for it, and is started anew with it at once; whoever started the program by hand
// is told.
void AssembledAppliance::heed_camera_hotplug() {
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
void AssembledAppliance::make_calibrated_camera() {
  const std::string& camera = devices_->calibration().camera;
  calibrated_camera_ = std::make_unique<CalibratedCamera>(camera, faults_);
  const auto& file = options_.calibration ? options_.calibration : configuration_.calibration;
  if (file && camera.empty() && !options_.recording)
    fmt::print(stderr, "octascope run: {}\n", words_on_unnamed_camera(*file));
}

void AssembledAppliance::make_recordings() {
  const pipeline::ScanPlan& plan = devices_->plan();
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

void AssembledAppliance::make_threads() {
  const hal::LineCameraConfig camera{.format = devices_->format(),
                                     .line_rate_hz = devices_->plan().line_rate_hz,
                                     .buffers = camera_buffers(devices_->plan())};
  acquisition_ = std::make_unique<pipeline::Acquisition>(devices_->line_camera(), camera, clock_,
                                                         faults_, arrived_);
  pipeline::VolumeThreadSetup setup =
      reconstruction_->volume_thread_setup(devices_->plan(), camera.buffers);
  setup.trigger = {.pulse_width = configuration_.devices.pulse_width};
  setup.observe_volume = [this](const pipeline::Volume& volume) { recordings_->offer(volume); };
  setup.most_volumes = options_.volumes;
  volumes_ = std::make_unique<pipeline::VolumeThread>(std::move(setup), devices_->galvo_trigger(),
                                                      *acquisition_, devices_->line_camera(),
                                                      clock_, faults_, arrived_, news_);
  if (hal::ScopeCamera* const scope = devices_->scope_camera())
    scope_ = std::make_unique<pipeline::ScopeThread>(*scope, hal::ScopeCameraConfig{}, clock_,
                                                     faults_, news_);
  controls_ =
      std::make_unique<pipeline::ControlThread>(devices_->control_input(), clock_, faults_, news_);
}

hal::Result<> AssembledAppliance::make_vessels() {
  return make_vessel_display(options_, {options_.subject, options_.eye}, clock_, faults_, news_)
      .map([this](std::unique_ptr<VesselDisplay> made) { vessels_ = std::move(made); });
}

void AssembledAppliance::make_render_loop() {
  RenderLoopSetup setup;
  setup.display = display_config(options_, configuration_);
  setup.view.b_scan = devices_->plan().b_scans / 2;
  setup.controls = control_profile_;
  setup.freshness = {devices_->plan().tick_period(), configuration_.veil_after};
  setup.b_scans = devices_->plan().b_scans;
  setup.lines_per_frame = devices_->plan().lines_per_frame();
  setup.scan_field = devices_->scan_field();
  host_.simulated = devices_->simulated();
  host_.source = devices_->source();
  if (configuration_.objective)
    host_.source += ", objective " + configuration_.objective->name;
  if (!options_.subject.empty())
    host_.source += ", subject " + options_.subject;
  host_.configuration = live_configuration_.state();
  setup.host = host_;
  live_configuration_.configure(setup);
  sim::SimControlInput* const controls = devices_->simulated_controls();
  loop_ = std::make_unique<RenderLoop>(
      RenderLoopParts{
          .display = devices_->display(),
          .clock = clock_,
          .volumes = *volumes_,
          .acquisition = acquisition_.get(),
          .scope = scope_.get(),
          .controls = *controls_,
          .faults = faults_,
          .news = news_,
          .keep_picture =
              [this](pipeline::Image picture) { return pictures_.keep(std::move(picture)); },
          .record = [this] { return recordings_->toggle(); },
          .simulated_control =
              controls == nullptr
                  ? std::function<void(const hal::ControlEvent&)>{}
                  : [controls](const hal::ControlEvent& event) { controls->inject(event); },
          .threads = make_thread_setup(clock_, faults_, reconstruction_->worker_cores(),
                                       &supervision_.threads()),
          .vessels = vessels_.get(),
          .proof = &supervision_.picture()},
      std::move(setup));
}

hal::Result<> AssembledAppliance::start_threads() {
  devices_->start_faults(started_);
  const pipeline::ThreadSetup setup =
      make_thread_setup(clock_, faults_, reconstruction_->worker_cores(), &supervision_.threads());
  HAL_CHECK(recordings_->start(setup));
  HAL_CHECK(acquisition_->start(setup));
  volumes_->start(setup);
  if (scope_)
    scope_->start(setup);
  controls_->start(setup);
  return {};
}

// Consumers first: the acquisition waits for its loans.
void AssembledAppliance::stop_threads() {
  volumes_->stop();
  recordings_->stop();
  acquisition_->stop();
  if (scope_)
    scope_->stop();
  controls_->stop();
}

void AssembledAppliance::show_until_done(StopSignal& stop_signal) {
  StatusLine line{started_};
  do {
    devices_->apply_faults(clock_.now());
    follow_controls();
    listen_to_scanner();
    heed_camera_hotplug();
    live_configuration_.advance(*loop_);
    update_status();
    tell_supervision();
    if (line.due(loop_->status().now))
      line.print(loop_->status(), loop_->counters());
  } while (loop_->turn() && !done() && !stop_signal.requested());
  line.finish();
}

// Where the configuration names no profile, the leading device's is used.
void AssembledAppliance::follow_controls() {
  if (auto profile = devices_->new_control_profile())
    live_configuration_.lead_with(std::move(*profile), *loop_);
  if (const auto complaint = devices_->new_keyboard_complaint())
    faults_.add(pipeline::Fault::keyboard_not_opened, *complaint, clock_.now());
}

void AssembledAppliance::listen_to_scanner() {
  if (devices_->new_missed_answers() > 0)
    faults_.add(pipeline::Fault::unanswered_pulse,
                "the scanner did not answer a pulse on its sync line: is it on, and is the line "
                "connected?",
                clock_.now());
}

bool AssembledAppliance::done() const {
  if (ends_for_camera_)
    return true;
  if (options_.duration_s && clock_.now() - started_ >= hal::from_seconds(*options_.duration_s))
    return true;
  return options_.volumes && volumes_->counters().published >= *options_.volumes &&
         loop_->shows_newest();
}

void AssembledAppliance::update_status() {
  using pipeline::Device;
  host_.devices = {
      {{Device::line_camera, devices_->line_camera().backend(), devices_->line_camera().state()},
       {Device::galvo_trigger, devices_->galvo_trigger().backend(),
        devices_->galvo_trigger().state()},
       {Device::control_input, devices_->control_input().backend(),
        devices_->control_input().state()},
       {Device::display, devices_->display().backend(), devices_->display().state()}}};
  host_.device_count = 4;
  if (const hal::ScopeCamera* const camera = devices_->scope_camera())
    host_.devices[host_.device_count++] = {Device::scope_camera, camera->backend(),
                                           camera->state()};
  const hal::TimePoint now = clock_.now();
  calibrated_camera_->look(devices_->line_camera(), now);
  host_.another_camera = calibrated_camera_->verdict() == CameraVerdict::another;
  host_.recording = recordings_->status(now);
  const auto devices = std::span<const ui::DeviceStatus>{host_.devices}.first(host_.device_count);
  std::string_view notice = compose_notice(faults_.records(), devices, now);
  if (notice.empty())
    notice = live_configuration_.notice();
  host_.notice = notice.empty() && vessels_ ? vessels_->notice(now) : notice;
  loop_->tell(host_);
}

void AssembledAppliance::tell_supervision() {
  const hal::TimePoint now = clock_.now();
  if (supervision_.wants_status(now))
    supervision_.tell(picture_status(account(), now));
}

RunStatistics AssembledAppliance::account() const {
  return {.devices = *devices_,
          .reconstructor = reconstruction_->reconstructor(),
          .worker_cores = reconstruction_->worker_cores(),
          .volumes = *volumes_,
          .loop = *loop_,
          .calibrated_camera = *calibrated_camera_};
}

hal::Result<>
AssembledAppliance::leave_behind(const std::optional<pipeline::Image>& picture) const {
  const RunReport finished = report_on(
      account(), {.process_start = process_start(clock_), .started = started_, .ended = ended_},
      faults_.records());
  fmt::print("{}", to_text(finished));
  if (options_.report) {
    HAL_CHECK(write_report(finished, *options_.report));
    fmt::print("report:   {}\n", options_.report->string());
  }
  for (const KeptRecording& recording : recordings_->kept())
    fmt::print("recording: {}, {} volumes{}\n", recording.file.string(), recording.kept,
               recording.not_kept > 0 ? fmt::format(", {} not kept", recording.not_kept) : "");
  return leave_snapshot(options_, picture);
}

} // namespace

hal::Result<std::unique_ptr<Appliance>> Appliance::assemble(const RunOptions& options,
                                                            CrashReport& crash_report) {
  const auto state = service_folders().state;
  // Before any thread: it blocks a signal.
  auto watch = std::make_unique<ConfigurationWatch>(
      wanted_file(options, state).value_or(std::filesystem::path{}),
      state ? ReloadSignal::heeded : ReloadSignal::ignored);
  auto chosen = choose_configuration(options, state);
  if (!chosen)
    return tl::make_unexpected(chosen.error());
  auto appliance = std::make_unique<AssembledAppliance>(options, *chosen, crash_report);
  auto assembled = appliance->assemble();
  const auto first = assembled;
  while (!assembled) {
    auto next = is_about_configuration(assembled.error()) && state
                    ? next_choice(*chosen, assembled.error().message, options, *state)
                    : std::nullopt;
    if (!next)
      return tl::make_unexpected(first.error());
    chosen = std::move(*next);
    appliance = std::make_unique<AssembledAppliance>(options, *chosen, crash_report);
    assembled = appliance->assemble();
  }
  appliance->follow_configuration(std::move(watch));
  return appliance;
}

} // namespace octascope::firmware_host

#include "firmware-host/appliance.h"

#include <algorithm>
#include <cstdio>
#include <span>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/configuration.h"
#include "firmware-host/device_choice.h"
#include "firmware-host/notice.h"
#include "firmware-host/picture_keeper.h"
#include "firmware-host/process_start.h"
#include "firmware-host/reconstruction_cache.h"
#include "firmware-host/render_loop.h"
#include "firmware-host/report.h"
#include "firmware-host/status_line.h"
#include "firmware-host/stop_signal.h"
#include "firmware-host/thread_roles.h"
#include "firmware-host/twins.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/realtime.h"
#include "hal/linux/window_display.h"
#include "pipeline/atomic_file.h"
#include "pipeline/hot_path.h"
#include "pipeline/png_image.h"
#include "pipeline/reconstructor.h"

namespace octascope::firmware_host {

using namespace std::chrono_literals;

namespace {

// The line camera's buffers: a volume and a sixth of it is what the workers may fall behind, and
// more than so many drivers do not have.
int camera_buffers(const pipeline::ScanPlan& plan) {
  return std::clamp(plan.sweeps() * 7 / 6, 96, 512);
}

class AssembledAppliance final : public Appliance {
public:
  AssembledAppliance(RunOptions options, Configuration configuration)
      : options_(std::move(options)), configuration_(std::move(configuration)) {}

  hal::Result<> assemble() {
    if (auto checked = check_outputs().and_then([this] { return choose_display(); }); !checked)
      return checked;
    auto controls = load_controls(configuration_);
    if (!controls)
      return tl::make_unexpected(controls.error());
    control_profile_ = std::move(*controls);
    auto twins = make_twins(options_, configuration_, clock_);
    if (!twins)
      return tl::make_unexpected(twins.error());
    twins_ = std::move(*twins);
    if (window_ && twins_.concern_display())
      return hal::fail(hal::Fault::invalid_argument,
                       "--faults: a window cannot be made to fail; display faults need --display "
                       "offscreen");
    return make_reconstruction().map([this] {
      make_threads();
      make_render_loop();
    });
  }

  hal::Result<> run(StopSignal& stop_signal) override {
    if (auto opened = loop_->open(); !opened)
      return opened;
    if (const auto locked = hal::linux_backend::lock_memory(); !locked)
      faults_.add("host", "memory_not_locked", locked.error().message, clock_.now());
    started_ = clock_.now();
    if (auto started = start_threads(); !started)
      return started;
    show_until_done(stop_signal);
    const std::optional<pipeline::Image> picture =
        options_.snapshot ? loop_->picture() : std::optional<pipeline::Image>{};
    ended_ = clock_.now();
    stop_threads();
    return leave_behind(picture);
  }

private:
  hal::Result<> check_outputs() const;
  hal::Result<> choose_display();
  hal::Result<> make_reconstruction();
  void make_threads();
  void make_render_loop();
  hal::Result<> start_threads();
  void stop_threads();
  void show_until_done(StopSignal& stop_signal);
  bool done() const;
  void update_status();
  bool simulated() const;
  RunReport report() const;
  hal::Result<> leave_behind(const std::optional<pipeline::Image>& picture) const;

  RunOptions options_;
  Configuration configuration_;
  ui::ControlProfile control_profile_;
  hal::linux_backend::MonotonicClock clock_;
  pipeline::FaultLog faults_;
  PictureKeeper pictures_{".", clock_, faults_};
  ReconstructionCache cache_; // before whatever plans a transform: it brings FFTW's wisdom
  Twins twins_;
  std::unique_ptr<pipeline::Reconstructor> reconstructor_;
  std::vector<pipeline::Reconstructor::Workspace> workspaces_; // one a worker
  std::optional<pipeline::FrameBackgrounds> backgrounds_;      // running ones
  std::unique_ptr<WorkerCores> worker_cores_;
  std::optional<pipeline::NeighbourAverage> average_;
  std::unique_ptr<sim::OffscreenDisplay> offscreen_; // one of the two
  std::unique_ptr<hal::Display> window_;
  pipeline::Wakeup arrived_; // B-scans, for the fixed-rate thread
  pipeline::Wakeup news_;    // anything new to show, for the render thread
  std::unique_ptr<pipeline::Acquisition> acquisition_;
  std::unique_ptr<pipeline::VolumeThread> volumes_;
  std::unique_ptr<pipeline::ScopeThread> scope_;
  std::unique_ptr<pipeline::ControlThread> controls_;
  std::unique_ptr<RenderLoop> loop_;
  hal::TimePoint started_;
  hal::TimePoint ended_;

  hal::Display& display() const { return offscreen_ ? *offscreen_ : *window_; }
};

// What cannot be written is found out now, not after the run; nothing stays behind.
hal::Result<> AssembledAppliance::check_outputs() const {
  for (const auto& file : {options_.snapshot, options_.report}) {
    if (!file)
      continue;
    if (const auto tried = pipeline::AtomicFile::create(*file); !tried)
      return tl::make_unexpected(tried.error());
  }
  if (options_.snapshot && options_.report &&
      options_.snapshot->lexically_normal() == options_.report->lexically_normal())
    return hal::fail(hal::Fault::invalid_argument,
                     fmt::format("--snapshot and --report are both {}, expected two files",
                                 options_.report->string()));
  return {};
}

// Before anything that takes time.
hal::Result<> AssembledAppliance::choose_display() {
  const DeviceChoice choice = choose_devices(survey_hardware(), options_).display;
  if (choice.backend == "offscreen")
    offscreen_ = std::make_unique<sim::OffscreenDisplay>(clock_);
  else if (choice.backend == "window")
    window_ = std::make_unique<hal::linux_backend::WindowDisplay>(clock_);
  else
    return hal::fail(hal::Fault::unsupported,
                     "--display kms: this version cannot drive a console display yet; use "
                     "--display window or --display offscreen");
  return {};
}

hal::Result<> AssembledAppliance::make_reconstruction() {
  auto made = pipeline::Reconstructor::create({.calibration = twins_.calibration,
                                               .format = pipeline::SpectrumFormat{twins_.format},
                                               .a_scans = twins_.plan.converted_lines(),
                                               .memory = &cache_});
  if (!made)
    return tl::make_unexpected(made.error());
  static_cast<void>(cache_.save()); // what was not kept is measured again; the doctor says why
  reconstructor_ = std::make_unique<pipeline::Reconstructor>(std::move(*made));
  auto average = pipeline::NeighbourAverage::create(configuration_.neighbour_weights);
  if (!average)
    return tl::make_unexpected(average.error());
  average_ = *average;
  const std::size_t workers = configuration_.workers > 0
                                  ? configuration_.workers
                                  : std::max(1U, std::thread::hardware_concurrency());
  worker_cores_ = std::make_unique<WorkerCores>(workers, configuration_.worker_cores,
                                                hal::linux_backend::allowed_cores());
  for (std::size_t worker = 0; worker < workers; ++worker)
    workspaces_.push_back(reconstructor_->make_workspace());
  return {};
}

void AssembledAppliance::make_threads() {
  const hal::LineCameraConfig camera{.format = twins_.format,
                                     .line_rate_hz = twins_.plan.line_rate_hz,
                                     .buffers = camera_buffers(twins_.plan)};
  acquisition_ = std::make_unique<pipeline::Acquisition>(*twins_.line_camera, camera, clock_,
                                                         faults_, arrived_);
  if (auto running = reconstructor_->make_running_background())
    backgrounds_.emplace(std::move(*running), reconstructor_->samples(), camera.buffers);
  pipeline::VolumeThreadSetup setup{
      .plan = twins_.plan,
      .trigger = {},
      .workers = workspaces_.size(),
      .reconstruct =
          [this](std::size_t worker, const hal::LineFrame& frame, std::span<std::uint8_t> levels) {
            const auto running = backgrounds_ ? backgrounds_->of(frame) : std::span<const float>{};
            return reconstructor_
                ->reconstruct_b_scan(workspaces_[worker], frame.bytes, levels, running)
                .saturated_lines;
          },
      .observe =
          [this](const hal::LineFrame& frame) {
            if (backgrounds_)
              backgrounds_->take(frame);
          },
      .average = *average_,
      .most_volumes = options_.volumes,
  };
  volumes_ = std::make_unique<pipeline::VolumeThread>(std::move(setup), *twins_.galvo_trigger,
                                                      *acquisition_, *twins_.line_camera, clock_,
                                                      faults_, arrived_, news_);
  if (twins_.scope_camera)
    scope_ = std::make_unique<pipeline::ScopeThread>(*twins_.scope_camera, hal::ScopeCameraConfig{},
                                                     clock_, faults_, news_);
  controls_ =
      std::make_unique<pipeline::ControlThread>(*twins_.control_input, clock_, faults_, news_);
}

void AssembledAppliance::make_render_loop() {
  RenderLoopSetup setup;
  setup.display.width = options_.size ? (*options_.size)[0] : configuration_.width;
  setup.display.height = options_.size ? (*options_.size)[1] : configuration_.height;
  setup.display.fullscreen = configuration_.fullscreen;
  if (configuration_.window) {
    setup.window_from_first_volume = false;
    setup.view.window_offset_db = configuration_.window->offset_db;
    setup.view.window_size_db = configuration_.window->size_db;
  }
  setup.transfers = configuration_.look.transfers;
  setup.view.transfer = configuration_.look.transfer;
  setup.view.colour_map = configuration_.look.colour_map;
  setup.view.technique = configuration_.look.technique;
  setup.view.opacity = configuration_.look.opacity;
  setup.view.b_scan = twins_.plan.b_scans / 2;
  setup.controls = control_profile_;
  setup.freshness = {twins_.plan.tick_period(), configuration_.veil_after};
  setup.b_scans = twins_.plan.b_scans;
  setup.lines_per_frame = twins_.plan.lines_per_frame();
  setup.scan_field = twins_.scan_field;
  setup.status.simulated = simulated();
  setup.status.source_description = twins_.source;
  loop_ = std::make_unique<RenderLoop>(
      RenderLoopParts{
          .display = display(),
          .clock = clock_,
          .volumes = *volumes_,
          .acquisition = *acquisition_,
          .scope = scope_.get(),
          .controls = *controls_,
          .faults = faults_,
          .news = news_,
          .keep_picture =
              [this](pipeline::Image picture) { return pictures_.keep(std::move(picture)); },
          .simulated_control =
              [this](const hal::ControlEvent& event) { twins_.control_input->inject(event); },
          .threads = make_thread_setup(clock_, faults_, *worker_cores_)},
      std::move(setup));
}

hal::Result<> AssembledAppliance::start_threads() {
  twins_.faults->start(started_);
  const pipeline::ThreadSetup setup = make_thread_setup(clock_, faults_, *worker_cores_);
  if (auto started = acquisition_->start(setup); !started)
    return started;
  volumes_->start(setup);
  if (scope_)
    scope_->start(setup);
  controls_->start(setup);
  return {};
}

// Consumers first: the acquisition waits for its loans.
void AssembledAppliance::stop_threads() {
  volumes_->stop();
  acquisition_->stop();
  if (scope_)
    scope_->stop();
  controls_->stop();
}

void AssembledAppliance::show_until_done(StopSignal& stop_signal) {
  StatusLine line{started_};
  do {
    twins_.apply_faults(clock_.now(), offscreen_.get());
    update_status();
    line.update(loop_->status());
  } while (loop_->turn() && !done() && !stop_signal.requested());
  line.finish();
}

bool AssembledAppliance::done() const {
  if (options_.duration_s && clock_.now() - started_ >= hal::from_seconds(*options_.duration_s))
    return true;
  return options_.volumes && volumes_->counters().published >= *options_.volumes &&
         loop_->shows_newest();
}

bool AssembledAppliance::simulated() const {
  return twins_.line_camera->simulated() ||
         (twins_.scope_camera && twins_.scope_camera->simulated());
}

void AssembledAppliance::update_status() {
  ui::Status& status = loop_->editable_status();
  status.devices = {{{"camera", twins_.line_camera->backend(), twins_.line_camera->state()},
                     {"trigger", twins_.galvo_trigger->backend(), twins_.galvo_trigger->state()},
                     {"pedal", twins_.control_input->backend(), twins_.control_input->state()},
                     {"display", display().backend(), display().state()}}};
  status.device_count = 4;
  if (twins_.scope_camera)
    status.devices[status.device_count++] = {"scope", twins_.scope_camera->backend(),
                                             twins_.scope_camera->state()};
  const hal::TimePoint now = clock_.now();
  const auto devices = std::span<const ui::DeviceStatus>{status.devices}.first(status.device_count);
  loop_->set_notice(compose_notice(faults_.records(), devices, now));
}

RunReport AssembledAppliance::report() const {
  RunReport r;
  const pipeline::VolumeCounters counters = volumes_->counters();
  const FrameStatistics& frames = loop_->statistics();
  r.simulated = simulated();
  r.source = twins_.source;
  r.reconstruction_path =
      reconstructor_->path() == pipeline::ReconstructionPath::fused ? "fused" : "fftw";
  r.reconstruction_isa = reconstructor_->isa();
  r.reconstruction_reason = name_of(reconstructor_->path_decision().reason);
  r.reconstruction_times = reconstructor_->path_decision().times;
  r.line_camera = twins_.line_camera->backend();
  r.galvo_trigger = twins_.galvo_trigger->backend();
  r.control_input = twins_.control_input->backend();
  r.scope_camera = twins_.scope_camera ? twins_.scope_camera->backend() : "none";
  r.display = display().backend();
  r.plan = twins_.plan;
  r.phase = volumes_->phase();
  r.worker_cores = worker_cores_->pinned();
  r.acquired = counters.acquired;
  r.published = counters.published;
  r.displayed = frames.volumes_displayed;
  r.skipped = counters.skipped;
  r.lost_lines = counters.lost_lines;
  r.lost_b_scans = counters.lost_b_scans;
  r.lost_volumes = counters.lost_volumes;
  r.saturated_lines = counters.saturated_lines;
  r.duration_s = hal::to_seconds(ended_ - started_);
  r.volumes_per_s = static_cast<double>(counters.published) / r.duration_s;
  r.lines_per_s = static_cast<double>(acquisition_->counters().frames) *
                  twins_.plan.lines_per_frame() / r.duration_s;
  r.frames_per_s = static_cast<double>(frames.frames_drawn) / r.duration_s;
  r.reconstruct = volumes_->statistics().reconstruct.summary();
  r.assemble = volumes_->statistics().assemble.summary();
  r.publish = volumes_->statistics().publish.summary();
  r.upload = frames.upload.summary();
  r.draw = frames.draw.summary();
  r.latency = frames.latency.summary();
  r.control = frames.control.summary();
  r.rays = frames.rays;
  if (frames.first_picture)
    r.first_picture_s = hal::to_seconds(*frames.first_picture - process_start(clock_));
  r.frames_drawn = frames.frames_drawn;
  r.frames_missed = frames.frames_missed;
  r.view = loop_->actions().state();
  r.actions = loop_->actions().counts();
  r.hot_path_allocations = pipeline::HotPath::allocations();
  r.faults = faults_.records();
  r.started = started_;
  return r;
}

hal::Result<>
AssembledAppliance::leave_behind(const std::optional<pipeline::Image>& picture) const {
  const RunReport finished = report();
  fmt::print("{}", to_text(finished));
  if (options_.report) {
    if (auto written = write_report(finished, *options_.report); !written)
      return written;
    fmt::print("report:   {}\n", options_.report->string());
  }
  if (!options_.snapshot)
    return {};
  if (!picture)
    return hal::fail(hal::Fault::absent,
                     fmt::format("{}: not written: the display was gone at the end",
                                 options_.snapshot->string()));
  if (auto written = pipeline::write_png(*options_.snapshot, *picture); !written)
    return written;
  fmt::print("snapshot: {}\n", options_.snapshot->string());
  return {};
}

} // namespace

hal::Result<std::unique_ptr<Appliance>> Appliance::assemble(const RunOptions& options) {
  Configuration configuration;
  if (options.configuration) {
    auto loaded = load_configuration(*options.configuration);
    if (!loaded)
      return tl::make_unexpected(loaded.error());
    configuration = std::move(*loaded);
  }
  auto appliance = std::make_unique<AssembledAppliance>(options, std::move(configuration));
  if (const auto assembled = appliance->assemble(); !assembled)
    return tl::make_unexpected(assembled.error());
  return appliance;
}

} // namespace octascope::firmware_host

#include "firmware-host/run/appliance.h"

#include <span>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/kept/configuration_choice.h"
#include "firmware-host/configuration/kept/configuration_watch.h"
#include "firmware-host/outputs/local_time.h"
#include "firmware-host/outputs/picture_writer.h"
#include "firmware-host/report/notice.h"
#include "firmware-host/report/run_outputs.h"
#include "firmware-host/report/status_line.h"
#include "firmware-host/run/live_configuration.h"
#include "firmware-host/run/process_start.h"
#include "firmware-host/run/run_source.h"
#include "firmware-host/run/stop_signal.h"
#include "firmware-host/supervision/service_manager.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/realtime.h"
#include "pipeline/files/png_image.h"

namespace octascope::firmware_host {

namespace {

using StateFolder = std::optional<std::filesystem::path>;

// What another configuration could fix.
bool is_about_configuration(const hal::Error& error) {
  return error.code == hal::ErrorCode::invalid_argument || error.code == hal::ErrorCode::bad_data;
}

// A service has a place for what the surgeon keeps; else it goes where the program was started.
std::filesystem::path picture_folder(const StateFolder& state) {
  if (!state)
    return ".";
  std::error_code ignored; // a picture that cannot be kept is a fault of its own
  std::filesystem::create_directories(*state / "pictures", ignored);
  return *state / "pictures";
}

class AssembledAppliance final : public Appliance {
public:
  AssembledAppliance(RunOptions options, const ChosenConfiguration& chosen,
                     const StateFolder& state, CrashReport* crash_report)
      : options_(std::move(options)), configuration_(chosen.configuration),
        live_configuration_(chosen, options_, state, clock_, faults_),
        pictures_(picture_folder(state), clock_, faults_) {
    const RunContext context{options_, configuration_, clock_, faults_, news_};
    source_ = options_.replay ? make_replay_source(context)
                              : make_live_source(context, chosen, *crash_report);
  }

  hal::Result<> assemble() {
    hal::linux_backend::keep_large_blocks_apart();
    HAL_CHECK(check_outputs(options_));
    HAL_TRY(auto profile, load_controls(configuration_));
    HAL_CHECK(source_->open());
    auto real = std::make_unique<RealDevices>(configuration_.devices,
                                              plan_of(options_, configuration_), clock_);
    const DeviceChoices choices =
        choose_devices(real->find_for(options_), options_, configuration_.devices);
    devices_ = std::make_unique<Devices>(std::move(real), choices, clock_);
    HAL_CHECK(source_->prepare(*devices_, choices));
    // Not before: reading a tree would disturb what the source measures.
    HAL_TRY(auto vessels,
            make_vessel_display(options_, !options_.replay && tells_flow(options_, configuration_),
                                source_->whose(), clock_, faults_, news_, source_->thread_setup()));
    vessels_ = std::move(vessels);
    controls_ = std::make_unique<pipeline::ControlThread>(devices_->control_input(), clock_,
                                                          faults_, news_);
    make_render_loop(std::move(profile));
    return {};
  }

  void follow_configuration(std::unique_ptr<ConfigurationWatch> watch) {
    live_configuration_.follow(std::move(watch));
  }

  hal::Result<> run(StopSignal& stop_signal) override {
    source_->opening_display();
    HAL_CHECK(loop_->open());
    times_ = {.process_start = process_start(clock_), .started = clock_.now(), .ended = {}};
    devices_->start_faults(times_.started);
    HAL_CHECK(source_->start());
    controls_->start(source_->thread_setup());
    show_until_done(stop_signal);
    source_->ending();
    const std::optional<pipeline::Image> picture =
        options_.snapshot ? loop_->picture() : std::optional<pipeline::Image>{};
    times_.ended = clock_.now();
    live_configuration_.finish(*loop_);
    source_->stop();
    controls_->stop();
    HAL_CHECK(source_->report(*loop_, times_));
    HAL_CHECK(leave_snapshot(options_, picture));
    if (trace_)
      HAL_CHECK(leave_trace(*trace_, options_, times_.started));
    return source_->outcome();
  }

private:
  void make_render_loop(ui::ControlProfile profile);
  void show_until_done(StopSignal& stop_signal);
  bool done() const;
  bool keep(pipeline::Image picture);
  void follow_controls();
  void update_status();
  void describe_devices();
  std::string_view notice(hal::TimePoint now) const;

  const RunOptions options_;
  const Configuration configuration_;
  hal::linux_backend::MonotonicClock clock_;
  pipeline::FaultLog faults_;
  LiveConfiguration live_configuration_;
  PictureWriter pictures_;
  pipeline::Wakeup news_; // anything new to show, for the render thread
  std::unique_ptr<Devices> devices_;
  std::unique_ptr<RunSource> source_; // it watches every thread, and so outlives those below
  std::unique_ptr<pipeline::ControlThread> controls_;
  std::unique_ptr<VesselDisplay> vessels_;
  std::unique_ptr<Trace> trace_; // null: not asked for
  std::unique_ptr<RenderLoop> loop_;
  bool has_cameras_ = false;
  HostStatus host_;
  RunTimes times_;
};

void AssembledAppliance::make_render_loop(ui::ControlProfile profile) {
  SourceParts source = source_->parts();
  has_cameras_ = source.acquisition != nullptr;
  RenderLoopSetup setup;
  setup.display = display_config(options_, configuration_);
  setup.controls = std::move(profile);
  source_->configure(setup);
  setup.view.b_scan = setup.geometry.b_scans / 2;
  setup.view.a_scan = setup.geometry.a_scans / 2;
  setup.view.mark_1_a = setup.geometry.a_scans / 3;
  setup.view.mark_2_a = setup.geometry.a_scans * 2 / 3;
  setup.view.mark_1_depth = setup.view.mark_2_depth = setup.geometry.depths / 3;
  setup.host.configuration = live_configuration_.state();
  setup.host.whose = source_->whose();
  if (options_.trace)
    trace_ = std::make_unique<Trace>(setup.geometry.b_scans);
  live_configuration_.configure(setup);
  host_ = setup.host;
  sim::SimControlInput* const controls = devices_->simulated_controls();
  loop_ = std::make_unique<RenderLoop>(
      RenderLoopParts{
          .display = devices_->display(),
          .clock = clock_,
          .volumes = source.volumes,
          .acquisition = source.acquisition,
          .scope = source.scope,
          .controls = *controls_,
          .faults = faults_,
          .news = news_,
          .keep_picture = [this](pipeline::Image picture) { return keep(std::move(picture)); },
          .record = std::move(source.record),
          .simulated_control =
              controls == nullptr
                  ? std::function<void(const hal::ControlEvent&)>{}
                  : [controls](const hal::ControlEvent& event) { controls->inject(event); },
          .threads = source_->thread_setup(),
          .vessels = vessels_.get(),
          .proof = source.proof,
          .trace = trace_.get()},
      std::move(setup));
}

// With the tree that was traced in it.
bool AssembledAppliance::keep(pipeline::Image picture) {
  if (vessels_)
    vessels_->keep_tree(pictures_.folder());
  return pictures_.keep(std::move(picture));
}

void AssembledAppliance::show_until_done(StopSignal& stop_signal) {
  StatusLine line{times_.started};
  do {
    devices_->apply_faults(clock_.now());
    follow_controls();
    live_configuration_.advance(*loop_);
    update_status();
    source_->advance(*loop_);
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

bool AssembledAppliance::done() const {
  return (options_.duration_s &&
          clock_.now() - times_.started >= hal::from_seconds(*options_.duration_s)) ||
         source_->done(*loop_);
}

void AssembledAppliance::update_status() {
  const hal::TimePoint now = clock_.now();
  describe_devices();
  source_->describe(host_, now);
  host_.time_of_day = local_time_of_day();
  host_.notice = notice(now);
  loop_->tell(host_);
}

void AssembledAppliance::describe_devices() {
  using pipeline::Device;
  host_.device_count = 0;
  const auto add = [this](Device kind, const auto& device) {
    host_.devices[host_.device_count++] = {kind, device.backend(), device.state()};
  };
  if (has_cameras_) {
    add(Device::line_camera, devices_->line_camera());
    add(Device::galvo_trigger, devices_->galvo_trigger());
  }
  add(Device::control_input, devices_->control_input());
  add(Device::display, devices_->display());
  if (const hal::ScopeCamera* const camera = devices_->scope_camera())
    add(Device::scope_camera, *camera);
}

std::string_view AssembledAppliance::notice(hal::TimePoint now) const {
  const auto devices = std::span<const ui::DeviceStatus>{host_.devices}.first(host_.device_count);
  if (const auto fault = compose_notice(faults_.records(), devices, now); !fault.empty())
    return fault;
  if (const auto source = source_->notice(now); !source.empty())
    return source;
  if (const auto configuration = live_configuration_.notice(); !configuration.empty())
    return configuration;
  return vessels_ ? vessels_->notice(now) : std::string_view{};
}

} // namespace

hal::Result<std::unique_ptr<Appliance>> Appliance::assemble(const RunOptions& options,
                                                            CrashReport* crash_report) {
  const StateFolder state = options.replay ? std::nullopt : service_folders().state;
  // Before any thread: it blocks a signal.
  std::unique_ptr<ConfigurationWatch> watch;
  if (!options.replay)
    watch = std::make_unique<ConfigurationWatch>(
        wanted_file(options, state).value_or(std::filesystem::path{}),
        state ? ReloadSignal::heeded : ReloadSignal::ignored);
  auto chosen = choose_configuration(options, state);
  if (!chosen)
    return tl::make_unexpected(chosen.error());
  auto appliance = std::make_unique<AssembledAppliance>(options, *chosen, state, crash_report);
  auto assembled = appliance->assemble();
  const auto first = assembled;
  while (!assembled) {
    auto next = is_about_configuration(assembled.error()) && state
                    ? next_choice(*chosen, assembled.error().message, options, *state)
                    : std::nullopt;
    if (!next)
      return tl::make_unexpected(first.error());
    chosen = std::move(*next);
    appliance = std::make_unique<AssembledAppliance>(options, *chosen, state, crash_report);
    assembled = appliance->assemble();
  }
  if (watch)
    appliance->follow_configuration(std::move(watch));
  return appliance;
}

} // namespace octascope::firmware_host

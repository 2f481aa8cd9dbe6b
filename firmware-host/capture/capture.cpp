#include "firmware-host/capture/capture.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "firmware-host/capture/line_averager.h"
#include "firmware-host/configuration/kept/configuration_choice.h"
#include "firmware-host/devices/devices.h"
#include "firmware-host/reconstruction/reconstruction.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "firmware-host/run/raw_recording.h"
#include "firmware-host/run/stop_signal.h"
#include "firmware-host/supervision/service_manager.h"
#include "firmware-host/supervision/thread_roles.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/linux/monotonic_clock.h"
#include "pipeline/acquisition/acquisition.h"
#include "pipeline/acquisition/volume_thread.h"

namespace octascope::firmware_host {

namespace {

using namespace std::chrono_literals;

constexpr hal::Duration longest_silence = 10s; // with a camera that is only just coming
constexpr hal::Duration between_looks = 20ms;

class Capture {
public:
  explicit Capture(const CaptureOptions& options) : options_(options) {}

  hal::Result<> prepare();
  hal::Result<> run(StopSignal& stop_signal);
  // So that not all of the kept volumes are whole.
  bool lost_sweeps() const;
  void remove_file() const;

private:
  hal::Result<> make_devices(const Configuration& configuration);
  void make_threads(const Configuration& configuration);
  std::uint64_t most_frames() const;
  std::uint64_t kept_lines() const;
  bool done() const;
  hal::Result<> wait_for_file(StopSignal& stop_signal);
  hal::Result<> wait_until_done(StopSignal& stop_signal);
  void show_progress() const;
  hal::Result<> write_mean() const;
  hal::Result<> tell(hal::Result<> waited) const;

  const CaptureOptions& options_;
  hal::linux_backend::MonotonicClock clock_;
  pipeline::FaultLog faults_;
  pipeline::Wakeup arrived_;
  pipeline::Wakeup news_;
  ReconstructionCache cache_;
  std::unique_ptr<Devices> devices_;
  std::unique_ptr<Reconstruction> reconstruction_;
  std::optional<pipeline::RawFacts> facts_;
  std::unique_ptr<pipeline::RawRecorder> recorder_; // of lines as they come
  std::unique_ptr<LineAverager> averager_;          // or this
  std::unique_ptr<pipeline::Acquisition> acquisition_;
  std::unique_ptr<pipeline::VolumeThread> volumes_;
};

hal::Result<> Capture::prepare() {
  HAL_CHECK(check_raw_file(options_.file));
  HAL_TRY(const auto chosen, choose_configuration(options_.run, service_folders().state));
  HAL_CHECK(make_devices(chosen.configuration));
  HAL_TRY(reconstruction_, Reconstruction::make(*devices_, chosen.configuration, false, cache_));
  facts_ = raw_facts(*devices_, *reconstruction_, options_.run,
                     chosen.used ? configuration_text(*chosen.used) : std::string{});
  make_threads(chosen.configuration);
  return {};
}

hal::Result<> Capture::make_devices(const Configuration& configuration) {
  auto real = std::make_unique<RealDevices>(configuration.devices,
                                            plan_of(options_.run, configuration), clock_);
  const DeviceChoices choices =
      choose_devices(real->find_for(options_.run), options_.run, configuration.devices);
  if (camera_may_come(choices, options_.run, configuration.devices))
    return hal::fail(hal::ErrorCode::absent,
                     "no line camera: {}; octascope doctor says more, and --sim captures what a "
                     "simulated one sees",
                     choices.line_camera.reason);
  devices_ = std::make_unique<Devices>(std::move(real), choices, clock_);
  return devices_->make_others(choices, options_.run, configuration, clock_);
}

void Capture::make_threads(const Configuration& configuration) {
  const hal::LineCameraConfig camera = devices_->camera_config();
  acquisition_ = std::make_unique<pipeline::Acquisition>(devices_->line_camera(), camera, clock_,
                                                         faults_, arrived_);
  pipeline::VolumeThreadSetup setup =
      reconstruction_->volume_thread_setup(devices_->plan(), camera.buffers);
  setup.trigger = {.pulse_width = configuration.devices.pulse_width};
  if (!options_.lines)
    setup.most_volumes = options_.volumes;
  if (options_.average) {
    averager_ = std::make_unique<LineAverager>(pipeline::SpectrumFormat{facts_->format},
                                               facts_->kept_lines(), setup.workers,
                                               options_.lines.value_or(0));
    setup.observe_converted = [this](std::size_t worker, const pipeline::PlacedFrame& placed) {
      averager_->add(worker, placed.frame.bytes);
    };
  } else {
    recorder_ = std::make_unique<pipeline::RawRecorder>(options_.file, *facts_, setup.workers,
                                                        most_frames(), clock_, faults_);
    offer_frames(setup, *reconstruction_, *recorder_);
  }
  volumes_ = std::make_unique<pipeline::VolumeThread>(std::move(setup), devices_->galvo_trigger(),
                                                      *acquisition_, devices_->line_camera(),
                                                      clock_, faults_, arrived_, news_);
}

std::uint64_t Capture::most_frames() const {
  const auto lines = static_cast<std::uint64_t>(facts_->kept_lines());
  return options_.lines ? (*options_.lines + lines - 1) / lines
                        : options_.volumes * static_cast<std::uint64_t>(facts_->plan.sweeps());
}

std::uint64_t Capture::kept_lines() const {
  return averager_ ? averager_->lines()
                   : recorder_->status().kept * static_cast<std::uint64_t>(facts_->kept_lines());
}

bool Capture::done() const {
  return options_.lines ? kept_lines() >= *options_.lines
                        : volumes_->counters().published >= options_.volumes;
}

// Nobody looks on: frames that come before it would be asked for in vain.
hal::Result<> Capture::wait_for_file(StopSignal& stop_signal) {
  if (recorder_->status().waiting)
    warn("octascope capture: {}: its disk has not made the file yet; it is waited for; "
         "Ctrl+C gives it up, twice where the disk goes on hanging\n",
         options_.file.string());
  while (recorder_->status().waiting && !stop_signal.requested())
    clock_.sleep_for(between_looks);
  if (auto failure = recorder_->failure())
    return tl::make_unexpected(std::move(*failure));
  if (stop_signal.requested())
    return hal::fail(hal::ErrorCode::timed_out, "it was ended before any line was there");
  return {};
}

hal::Result<> Capture::wait_until_done(StopSignal& stop_signal) {
  std::uint64_t before = 0;
  hal::TimePoint progressed = clock_.now();
  while (!done()) {
    if (stop_signal.requested())
      return hal::fail(hal::ErrorCode::timed_out, "it was ended before all lines were there");
    if (recorder_ && recorder_->failure())
      return {}; // raw_outcome() tells of it
    const std::uint64_t now = kept_lines();
    if (now > before)
      progressed = clock_.now();
    before = now;
    if (clock_.now() - progressed > longest_silence)
      return hal::fail(hal::ErrorCode::timed_out,
                       "no lines came for {} s: is the camera on, and does the scanner's trigger "
                       "start it? octascope doctor says more",
                       std::chrono::duration_cast<std::chrono::seconds>(longest_silence).count());
    show_progress();
    static_cast<void>(volumes_->take_newest());
    devices_->apply_faults(clock_.now());
    clock_.sleep_for(between_looks);
  }
  return {};
}

void Capture::show_progress() const {
  if (::isatty(STDERR_FILENO) == 0)
    return;
  firmware_host::show_progress(
      options_.lines
          ? fmt::format("{} of {} lines", std::min(kept_lines(), *options_.lines), *options_.lines)
          : fmt::format("{} of {} volumes", volumes_->counters().published, options_.volumes));
}

hal::Result<> Capture::run(StopSignal& stop_signal) {
  const pipeline::ThreadSetup threads =
      make_thread_setup(clock_, faults_, reconstruction_->worker_cores());
  devices_->start_faults(clock_.now());
  hal::Result<> started;
  if (recorder_) {
    HAL_CHECK(recorder_->start(threads));
    started = wait_for_file(stop_signal);
  }
  if (started)
    started = acquisition_->start(threads);
  if (!started) {
    if (recorder_)
      recorder_->stop({});
    remove_file();
    return started;
  }
  volumes_->start(threads);
  auto waited = wait_until_done(stop_signal);
  if (::isatty(STDERR_FILENO) != 0)
    firmware_host::show_progress("");
  volumes_->stop();
  if (recorder_)
    recorder_->stop(devices_->line_camera().identity());
  else if (averager_->lines() > 0)
    HAL_CHECK(write_mean());
  acquisition_->stop();
  return tell(std::move(waited));
}

// Never one that is not of this capture.
void Capture::remove_file() const {
  if (!recorder_ || !recorder_->status().made)
    return;
  std::error_code error;
  std::filesystem::remove(options_.file, error);
}

bool Capture::lost_sweeps() const {
  return recorder_ && !options_.lines && volumes_->counters().lost_lines > 0;
}

// The file holds one frame of one line.
hal::Result<> Capture::write_mean() const {
  pipeline::RawFacts facts = *facts_;
  facts.averaged_lines = static_cast<int>(
      std::min<std::uint64_t>(averager_->lines(), std::numeric_limits<int>::max()));
  facts.format.lines_per_frame = 1;
  facts.format.sample_type = hal::SampleType::f32;
  HAL_TRY(auto writer, pipeline::RawWriter::create(options_.file, facts));
  const std::vector<float> mean = averager_->mean();
  HAL_CHECK(writer.append({}, std::as_bytes(std::span{mean}), {}));
  return writer.finish({.camera = devices_->line_camera().identity()});
}

hal::Result<> Capture::tell(hal::Result<> waited) const {
  for (const pipeline::FaultRecord& fault : faults_.records())
    warn("octascope capture: {}: {}\n", facts_of(facts_of(fault.kind).device).name, fault.message);
  if (!waited && kept_lines() == 0) {
    remove_file();
    return waited;
  }
  if (recorder_)
    HAL_CHECK(raw_outcome(*recorder_));
  if (kept_lines() > 0 && recorder_)
    say("capture: {} of {} lines of {} samples{}\n", raw_summary(*recorder_), facts_->kept_lines(),
        facts_->format.samples_per_line, facts_->simulated ? ", SIMULATED" : "");
  else if (kept_lines() > 0)
    say("capture: {}, the mean of {} lines of {} samples{}\n", options_.file.string(), kept_lines(),
        facts_->format.samples_per_line, facts_->simulated ? ", SIMULATED" : "");
  if (averager_ && averager_->saturated_lines() > 0)
    warn("octascope capture: warning: {} of the lines are saturated, and so is their mean: less "
         "light, or a shorter exposure\n",
         averager_->saturated_lines());
  return waited;
}

} // namespace

hal::Result<> capture(const CaptureOptions& options, StopSignal& stop_signal) {
  constexpr int most_attempts = 3; // a busy machine loses a sweep now and then
  for (int attempt = 1;; ++attempt) {
    Capture capture{options};
    HAL_CHECK(capture.prepare());
    auto done = capture.run(stop_signal);
    if (!done || !capture.lost_sweeps())
      return done;
    if (attempt == most_attempts)
      return hal::fail(hal::ErrorCode::bad_data,
                       "{}: lines were lost in each of {} captures, so that volumes are not whole; "
                       "give the machine less other work, or lower the line rate",
                       options.file.string(), most_attempts);
    warn("octascope capture: lines were lost; it is captured once more\n");
    capture.remove_file();
  }
}

} // namespace octascope::firmware_host

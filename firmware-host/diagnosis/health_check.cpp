#include "firmware-host/diagnosis/health_check.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include "firmware-host/configuration/configuration_check.h"
#include "firmware-host/devices/calibrated_camera.h"
#include "firmware-host/devices/device_choice.h"
#include "firmware-host/devices/real_devices.h"
#include "firmware-host/diagnosis/hardware_checks.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/realtime.h"
#include "hal/linux/system/system_files.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/scan/scan_plan.h"
#include "sim/devices/offscreen_display.h"
#include "sim/spectrometer/spectrometer.h"
#include "ui/gl/context_info.h"
#include "ui/volume/volume_texture.h"

namespace octascope::firmware_host {

using namespace std::chrono_literals;

namespace {

constexpr const char* allow_realtime_command =
    "printf '@video - rtprio 49\\n@video - memlock unlimited\\n' | sudo tee "
    "/etc/security/limits.d/octascope.conf";

constexpr double gib = 1024.0 * 1024.0 * 1024.0;

HealthCheck good(std::string_view subject, std::string found) {
  return {std::string{subject}, Verdict::good, std::move(found), ""};
}

HealthCheck check_cores() {
  const unsigned cores = std::thread::hardware_concurrency();
  const std::string found = fmt::format("{} processor cores", cores);
  if (cores >= 2)
    return good("processor", found);
  return {"processor", Verdict::limited, found,
          "use a machine with two cores or more: acquisition and drawing share one here"};
}

HealthCheck check_realtime() {
  hal::Result<> made;
  std::thread{[&made] { made = hal::linux_backend::make_this_thread_realtime(1); }}.join();
  if (made)
    return good("real-time priority", "SCHED_FIFO is allowed");
  rlimit limit{};
  ::getrlimit(RLIMIT_RTPRIO, &limit);
  constexpr rlim_t needed = 49;
  const std::string found =
      limit.rlim_cur >= needed
          ? std::string{"not allowed, though this user's limit is high enough (a container?)"}
          : fmt::format("not allowed: this user's limit is {}, {} is needed", limit.rlim_cur,
                        needed);
  return {"real-time priority", Verdict::limited, found,
          fmt::format("{}, then log out and in again; in the service unit LimitRTPRIO={}",
                      allow_realtime_command, needed)};
}

HealthCheck check_locked_memory() {
  const auto locked = hal::linux_backend::lock_memory();
  munlockall();
  if (locked)
    return good("locked memory", "mlockall is allowed");
  return {"locked memory", Verdict::limited, "not allowed: " + locked.error().message,
          fmt::format("{}, then log out and in again; in the service unit LimitMEMLOCK=infinity",
                      allow_realtime_command)};
}

HealthCheck check_memory() {
  constexpr double needed_gib = 1.5;
  const std::string kib = hal::linux_backend::text_after("MemAvailable:", "/proc/meminfo");
  const double available_gib = std::strtod(kib.c_str(), nullptr) * 1024 / gib;
  const std::string found = fmt::format("{:.1f} GiB available", available_gib);
  if (available_gib >= needed_gib)
    return good("memory", found);
  return {
      "memory", Verdict::limited, found,
      fmt::format("free some, {} GiB are needed for buffers and the simulated loop", needed_gib)};
}

// How late absolute sleeps of 1 ms wake: what every tick suffers.
HealthCheck check_clock(hal::Clock& clock) {
  constexpr std::size_t sleeps = 200;
  std::array<hal::Duration, sleeps> late{};
  std::thread{[&] {
    static_cast<void>(hal::linux_backend::make_this_thread_realtime(1)); // as the ticks run
    hal::TimePoint deadline = clock.now();
    for (hal::Duration& l : late) {
      deadline += 1ms;
      clock.sleep_until(deadline);
      l = clock.now() - deadline;
    }
  }}.join();
  std::ranges::sort(late);
  const double median_ms = hal::to_ms(late[sleeps / 2]);
  const double p99_ms = hal::to_ms(late[sleeps * 99 / 100]);
  const std::string found =
      fmt::format("sleeps end {:.3f} ms late, 99 % within {:.3f} ms", median_ms, p99_ms);
  constexpr double bearable_ms = 2;
  if (p99_ms <= bearable_ms)
    return good("clock", found);
  return {"clock", Verdict::limited, found,
          "ticks will jitter: allow real-time priority, and run nothing else on this machine"};
}

HealthCheck check_disk() {
  std::error_code error;
  const auto space = std::filesystem::space(".", error);
  const double free_gib = error ? 0 : static_cast<double>(space.available) / gib;
  const std::string found = fmt::format("{:.1f} GiB free in this folder", free_gib);
  if (free_gib >= 1)
    return good("disk", found);
  return {"disk", Verdict::limited, found, "free some: snapshots and reports need room"};
}

HealthCheck check_graphics(hal::Clock& clock) {
  sim::OffscreenDisplay display{clock};
  if (const auto opened = display.open({.width = 64, .height = 64}); !opened)
    return {"graphics", Verdict::fails, "no GLES 3 context", opened.error().message};
  const ui::gl::ContextInfo info = ui::gl::describe_context();
  display.close();
  const std::string found = fmt::format("{}, {}", info.renderer, info.version);
  if (!info.software)
    return good("graphics", found);
  return {
      "graphics", Verdict::limited, found,
      "the processor draws: fine for trying out, fewer frames a second; with a GPU, install its "
      "Mesa driver and add the user to the groups video and render"};
}

// With what `run` takes unless told otherwise: the simulated spectrometer's lines and curves.
hal::Result<pipeline::Reconstructor> make_default_reconstructor(ReconstructionCache& cache) {
  HAL_TRY(const auto spectrometer, sim::Spectrometer::make({}));
  const pipeline::ScanPlan plan;
  pipeline::ReconstructionSetup setup{.calibration = pipeline::Calibration::identity(plan.samples),
                                      .format = {plan.samples, hal::SampleType::u16},
                                      .a_scans = plan.a_scans,
                                      .memory = &cache};
  setup.calibration.positions = spectrometer.true_k_positions();
  setup.calibration.dispersion_rad = spectrometer.true_dispersion_rad();
  return pipeline::Reconstructor::create(setup);
}

std::string describe(const pipeline::Reconstructor& reconstructor) {
  const bool fused = reconstructor.path() == pipeline::ReconstructionPath::fused;
  const pipeline::PathDecision& decision = reconstructor.path_decision();
  std::string text = fmt::format("{} path, {}", fused ? "fused" : "FFTW's", reconstructor.isa());
  if (decision.times)
    text += fmt::format("; ns a line of {} samples: fused {:.0f}, FFTW's {:.0f}, {}",
                        reconstructor.samples(), decision.times->fused_ns, decision.times->fftw_ns,
                        name_of(decision.reason));
  return text;
}

HealthCheck check_reconstruction() {
  constexpr const char* subject = "reconstruction";
  ReconstructionCache cache;
  const auto reconstructor = make_default_reconstructor(cache);
  if (!reconstructor)
    return {subject, Verdict::fails, "cannot be made", reconstructor.error().message};
  const std::string found = describe(*reconstructor);
  if (const auto saved = cache.save(); !saved)
    return {subject, Verdict::limited, found + " but not kept",
            saved.error().message + "; until then every start measures again"};
  const bool remembered = reconstructor->path_decision().reason == pipeline::PathReason::remembered;
  return good(subject, fmt::format("{}{} {}", found, remembered ? " from" : ", kept in",
                                   cache.file().string()));
}

HealthCheck check_devices(hal::Clock& clock) {
  const auto choices = choices_of_run({}, clock);
  if (!choices)
    return {"configuration", Verdict::fails, "refused", choices.error().message};
  std::string twins;
  for (const DeviceChoice& choice : choices->all()) {
    if (choice.backend == "sim")
      twins += (twins.empty() ? "" : ", ") + std::string{facts_of(choice.device).key};
  }
  if (twins.empty())
    return good("devices", "all real");
  return {"devices", Verdict::limited, "simulated: " + twins,
          "see octascope devices for what is plugged in and why it is not used"};
}

// Of a configuration without complaints.
std::optional<HealthCheck> check_camera_of_calibration(const std::filesystem::path& file) {
  const auto configuration = load_configuration(file);
  if (!configuration || !configuration->calibration)
    return std::nullopt;
  const auto camera = pipeline::calibration_camera(*configuration->calibration);
  if (!camera || !camera->empty())
    return std::nullopt;
  return good("calibration", words_on_unnamed_camera(*configuration->calibration));
}

// Likewise.
std::optional<HealthCheck> check_k_table(const std::filesystem::path& file) {
  const auto configuration = load_configuration(file);
  if (!configuration || !configuration->calibration)
    return std::nullopt;
  const int samples = configuration->plan.value_or(pipeline::ScanPlan{}).samples;
  const auto calibration = pipeline::Calibration::load(*configuration->calibration, samples);
  if (!calibration)
    return std::nullopt;
  if (auto doubt = pipeline::doubt_about_k_table(*calibration, *configuration->calibration))
    return HealthCheck{"calibration", Verdict::limited, std::move(*doubt),
                       "see docs/CALIBRATION.md, The k curve"};
  return std::nullopt;
}

// Likewise. Without GL here there may be some where it is used.
std::optional<HealthCheck> check_volume_size(const std::filesystem::path& file) {
  const auto configuration = load_configuration(file);
  hal::linux_backend::MonotonicClock clock;
  sim::OffscreenDisplay display{clock};
  if (!configuration || !display.open({.width = 64, .height = 64}))
    return std::nullopt;
  const auto plan = configuration->plan.value_or(pipeline::ScanPlan{});
  const auto fits = ui::VolumeTexture::check_size(plan.geometry());
  if (fits)
    return std::nullopt;
  return HealthCheck{"graphics", Verdict::fails, fits.error().message,
                     "lower them, or show it with a GPU that has larger textures"};
}

} // namespace

std::vector<HealthCheck> check_health(hal::Clock& clock) {
  std::vector<HealthCheck> checks{check_cores(),          check_memory(),       check_realtime(),
                                  check_locked_memory(),  check_clock(clock),   check_disk(),
                                  check_reconstruction(), check_graphics(clock)};
  for (HealthCheck& check : check_hardware(survey_hardware()))
    checks.push_back(std::move(check));
  checks.push_back(check_devices(clock));
  return checks;
}

std::vector<HealthCheck> check_configuration(const std::optional<std::filesystem::path>& file) {
  RunOptions options;
  options.configuration = file;
  const auto used = configuration_file(options);
  if (!used)
    return {{"configuration", Verdict::limited,
             fmt::format("{} is not there: what is built in", machine_configuration),
             "copy example.toml there (from deploy, or /usr/share/doc/octascope) and say what "
             "this machine has"}};
  std::vector<HealthCheck> checks;
  for (std::string& complaint : configuration_complaints(*used))
    checks.push_back(
        {"configuration", Verdict::fails, std::move(complaint),
         "fix it; docs/CONFIGURATION.md (in /usr/share/doc/octascope) has every key, and "
         "so has man octascope.toml"});
  if (checks.empty()) {
    if (auto too_large = check_volume_size(*used))
      checks.push_back(std::move(*too_large));
    else
      checks.push_back(good("configuration", used->string()));
    for (const auto& check : {check_camera_of_calibration(*used), check_k_table(*used)})
      if (check)
        checks.push_back(*check);
  }
  return checks;
}

} // namespace octascope::firmware_host

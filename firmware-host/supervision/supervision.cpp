#include "firmware-host/supervision/supervision.h"

#include <algorithm>
#include <fstream>
#include <span>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <syslog.h>

#include "firmware-host/terminal/terminal.h"
#include "hal/linux/realtime.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

namespace {

constexpr hal::Duration step_period = 100ms;
constexpr hal::Duration first_step_period =
    10ms; // the rest of the machine's start waits for the picture
constexpr hal::Duration look_period = 1s;
constexpr hal::Duration metrics_period = 10s;

// Where pictures and reports of crashes go; without a service, nothing is watched.
std::vector<fs::path> written_folders(const ServiceFolders& folders) {
  return folders.state ? std::vector{*folders.state} : std::vector<fs::path>{};
}

FaultJournal::Sink sink_of(const SupervisionSetup& setup) {
  return setup.journal ? FaultJournal::Sink{send_to_journal}
                       : FaultJournal::Sink{[](const JournalEntry&) {}};
}

void note(const SupervisionSetup& setup, int priority, const std::string& message) {
  if (setup.journal)
    send_to_journal({priority, message});
  else
    warn("octascope run: {}\n", message);
}

std::string text_of(const fs::path& file) {
  std::ifstream in{file};
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

hal::Result<> write_whole(const fs::path& file, const std::string& text) {
  HAL_TRY(auto out, pipeline::AtomicFile::create(file));
  return out.write_at(0, std::as_bytes(std::span{text})).and_then([&] { return out.commit(); });
}

} // namespace

Supervision::Supervision(SupervisionSetup setup, CrashReport& crash_report, hal::Clock& clock,
                         pipeline::FaultLog& faults)
    : setup_{std::move(setup)}, crash_report_{crash_report}, clock_{clock}, faults_{faults},
      watchdog_{manager_.watchdog_interval()}, host_{{.written = written_folders(setup_.folders)}},
      journal_{sink_of(setup_)} {}

Supervision::~Supervision() {
  stop();
}

void Supervision::check_last_run() {
  marker_.emplace(*setup_.folders.state);
  switch (marker_->last_run()) {
  case RunMarker::LastRun::orderly: return;
  case RunMarker::LastRun::power_lost:
    note(setup_, LOG_NOTICE,
         "the machine was switched off, or hung, while octascope ran last time");
    return;
  case RunMarker::LastRun::crashed: break;
  }
  const auto reports = crash_reports(crash_folder(*setup_.folders.state));
  const std::string message =
      reports.empty() ? std::string{"restarted after a crash that left no report: it was killed"}
                      : fmt::format("restarted after a crash; the newest report is {}",
                                    reports.back().string());
  faults_.add(pipeline::Fault::restarted_after_crash, message, clock_.now());
  if (!setup_.journal) // there, it is told with the other faults
    note(setup_, LOG_WARNING, message);
}

void Supervision::start(hal::TimePoint process_start) {
  process_start_ = process_start;
  if (setup_.configuration)
    crash_report_.set_configuration(setup_.configuration->string(), text_of(*setup_.configuration));
  if (setup_.folders.state)
    check_last_run();
  if (setup_.folders.runtime) {
    auto server = StatusServer::start(*setup_.folders.runtime / status_socket_name,
                                      [this] { return to_json(status()); });
    if (server)
      server_ = std::move(*server);
    else
      faults_.add(pipeline::Fault::no_status_socket, server.error().message, clock_.now());
  }
  const auto set_up = [](pipeline::ThreadRole) {
    hal::linux_backend::name_this_thread("octa-supervise");
    CrashReport::prepare_this_thread();
  };
  thread_.start({"supervise"}, set_up, [this] { run(); });
}

void Supervision::stop() {
  if (!thread_.started())
    return;
  thread_.stop();
  manager_.stopping();
  server_.reset();
}

void Supervision::tell(PictureStatus status) {
  next_status_ = status.told + look_period;
  crash_report_.set_status(to_line(status));
  const std::lock_guard lock{mutex_};
  told_ = std::move(status);
}

void Supervision::run() {
  while (!thread_.stopping()) {
    step(clock_.now());
    wakeup_.wait_until(clock_, clock_.now() + (ready_ ? step_period : first_step_period));
  }
  journal_.update(faults_.records(), clock_.now()); // what struck on the way to the end
}

void Supervision::step(hal::TimePoint now) {
  if (!ready_ && picture_.frames() > 0) {
    ready_ = true;
    manager_.set_watchdog(
        std::max(patience_before_settled, manager_.watchdog_interval().value_or(hal::Duration{})));
    manager_.ready();
  }
  if (setup_.journal && !volume_told_ && picture_.volume_frames() > 0) {
    volume_told_ = true;
    note(setup_, LOG_INFO,
         fmt::format("the first volume is in the picture, {:.1f} s after the start",
                     hal::to_seconds(now - process_start_)));
  }
  if (watchdog_.settles(picture_.volume_frames(), now))
    manager_.set_watchdog(*manager_.watchdog_interval());
  if (watchdog_.due(picture_.steps(), now))
    manager_.kick();
  if (now < next_look_)
    return;
  next_look_ = now + look_period;
  look(now);
}

void Supervision::look(hal::TimePoint now) {
  threads_.complain(faults_, now);
  static_cast<void>(hal::linux_backend::demote_runaways(longest_without_wait));
  host_.look(faults_, now);
  journal_.update(faults_.records(), now);
  std::optional<std::string> line;
  {
    const std::lock_guard lock{mutex_};
    host_findings_ = host_.findings();
    if (told_)
      line = to_line(*told_);
  }
  if (line)
    manager_.status(*line);
  if (now >= next_metrics_) {
    next_metrics_ = now + metrics_period;
    write_metrics(now);
  }
}

void Supervision::write_metrics(hal::TimePoint now) {
  std::optional<fs::path> file = setup_.metrics;
  if (!file && setup_.folders.runtime)
    file = *setup_.folders.runtime / "metrics.prom";
  if (!file)
    return;
  if (const auto written = write_whole(*file, to_metrics(status())); !written)
    faults_.add(pipeline::Fault::metrics_not_written, written.error().message, now);
}

ApplianceStatus Supervision::status() const {
  ApplianceStatus s;
  s.now = clock_.now();
  s.uptime_s = hal::to_seconds(s.now - process_start_);
  s.configuration = setup_.configuration ? setup_.configuration->string() : "";
  s.configuration_state = setup_.configuration_state;
  s.threads = threads_.states(s.now);
  s.faults = faults_.records();
  const std::lock_guard lock{mutex_};
  s.picture = told_;
  s.resident_bytes = host_findings_.resident_bytes;
  s.temperature_c = host_findings_.temperature_c;
  return s;
}

} // namespace octascope::firmware_host

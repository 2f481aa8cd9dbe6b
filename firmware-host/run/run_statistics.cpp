#include "firmware-host/run/run_statistics.h"

#include <span>
#include <utility>

#include "firmware-host/devices/calibrated_camera.h"
#include "firmware-host/devices/devices.h"
#include "firmware-host/run/render_loop.h"
#include "firmware-host/supervision/thread_roles.h"
#include "pipeline/acquisition/acquisition.h"
#include "pipeline/acquisition/volume_thread.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/threads/hot_path.h"

namespace octascope::firmware_host {

namespace {

void add_devices(RunReport& report, const Devices& devices) {
  report.simulated = devices.simulated();
  report.source = devices.source();
  report.line_camera = devices.line_camera().backend();
  report.galvo_trigger = devices.galvo_trigger().backend();
  report.control_input = devices.control_input().backend();
  report.scope_camera = devices.scope_camera() ? devices.scope_camera()->backend() : "none";
  report.display = devices.display().backend();
  report.plan = devices.plan();
}

CalibrationAccount calibration_account(const CalibratedCamera& camera) {
  return {camera.calibrated(), camera.open(), std::string{to_string(camera.verdict())}};
}

void add_reconstruction(RunReport& report, const pipeline::Reconstructor& reconstructor) {
  report.reconstruction_path =
      reconstructor.path() == pipeline::ReconstructionPath::fused ? "fused" : "fftw";
  report.reconstruction_isa = reconstructor.isa();
  report.reconstruction_reason = name_of(reconstructor.path_decision().reason);
  report.reconstruction_times = reconstructor.path_decision().times;
}

void add_volumes(RunReport& report, const pipeline::VolumeThread& volumes) {
  const pipeline::VolumeCounters counters = volumes.counters();
  report.phase = volumes.phase();
  report.planned = counters.planned;
  report.acquired = counters.acquired;
  report.published = counters.published;
  // What waits for the renderer at the end is never taken either.
  report.skipped = counters.skipped + (volumes.has_newer() ? 1 : 0);
  report.unfinished = counters.unfinished;
  report.lost_lines = counters.lost_lines;
  report.lost_b_scans = counters.lost_b_scans;
  report.lost_volumes = counters.lost_volumes;
  report.saturated_lines = counters.saturated_lines;
  report.reconstruct = volumes.statistics().reconstruct.summary();
  report.assemble = volumes.statistics().assemble.summary();
  report.publish = volumes.statistics().publish.summary();
}

void add_frames(RunReport& report, const FrameStatistics& frames) {
  report.displayed = frames.volumes_displayed;
  report.undisplayed = frames.volumes_taken - frames.volumes_displayed;
  report.upload = frames.upload.summary();
  report.draw = frames.draw.summary();
  report.latency = frames.latency.summary();
  report.control = frames.control.summary();
  report.rays = frames.rays;
  report.frames_drawn = frames.frames_drawn;
  report.frames_missed = frames.frames_missed;
}

void add_rates(RunReport& report, const RunStatistics& run) {
  const auto per_s = [&report](auto count) {
    return static_cast<double>(count) / report.duration_s;
  };
  report.volumes_per_s = per_s(report.published);
  report.lines_per_s =
      per_s(run.acquisition.counters().frames) * run.devices.plan().lines_per_frame();
  report.frames_per_s = per_s(report.frames_drawn);
}

} // namespace

PictureStatus picture_status(const RunStatistics& run, hal::TimePoint now) {
  const ui::Status& shown = run.loop.status();
  const FrameStatistics& frames = run.loop.statistics();
  const pipeline::VolumeCounters counters = run.volumes.counters();
  PictureStatus status{.told = now,
                       .simulated = run.devices.simulated(),
                       .source = run.devices.source(),
                       .freshness = shown.freshness,
                       .lines_per_s = shown.lines_per_s,
                       .volumes_per_s = shown.volumes_per_s,
                       .frames_per_s = shown.frames_per_s,
                       .acquired = counters.acquired,
                       .published = counters.published,
                       .displayed = frames.volumes_displayed,
                       .skipped = counters.skipped,
                       .lost_lines = counters.lost_lines,
                       .lost_b_scans = counters.lost_b_scans,
                       .lost_volumes = counters.lost_volumes,
                       .saturated_lines = counters.saturated_lines,
                       .frames_drawn = frames.frames_drawn,
                       .frames_missed = frames.frames_missed,
                       .latency = frames.latency.summary(),
                       .notice = shown.notice,
                       .calibration = calibration_account(run.calibrated_camera)};
  for (const ui::DeviceStatus& device : std::span{shown.devices}.first(shown.device_count))
    status.devices.push_back(
        {std::string{facts_of(device.device).name}, std::string{device.backend}, device.state});
  return status;
}

RunReport report_on(const RunStatistics& run, const RunTimes& times,
                    std::vector<pipeline::FaultRecord> faults) {
  RunReport report;
  add_devices(report, run.devices);
  add_reconstruction(report, run.reconstructor);
  report.calibration = calibration_account(run.calibrated_camera);
  report.worker_cores = run.worker_cores.pinned();
  add_volumes(report, run.volumes);
  const FrameStatistics& frames = run.loop.statistics();
  add_frames(report, frames);
  report.started = times.started;
  report.duration_s = hal::to_seconds(times.ended - times.started);
  add_rates(report, run);
  if (frames.first_picture)
    report.first_picture_s = hal::to_seconds(*frames.first_picture - times.process_start);
  report.view = run.loop.actions().state();
  report.actions = run.loop.actions().counts();
  report.hot_path_allocations = pipeline::HotPath::allocations();
  report.faults = std::move(faults);
  return report;
}

} // namespace octascope::firmware_host

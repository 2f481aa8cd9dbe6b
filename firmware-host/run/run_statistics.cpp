#include "firmware-host/run/run_statistics.h"

#include <span>
#include <utility>

#include "firmware-host/devices/calibrated_camera.h"
#include "firmware-host/devices/devices.h"
#include "firmware-host/run/render_loop.h"
#include "firmware-host/supervision/thread_roles.h"
#include "pipeline/acquisition/volume_thread.h"
#include "pipeline/reconstruction/reconstructor.h"

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
  report.scan_lag = volumes.scan_lag();
  report.reconstruct = volumes.statistics().reconstruct.summary();
  report.assemble = volumes.statistics().assemble.summary();
  report.publish = volumes.statistics().publish.summary();
  if (!volumes.has_flow())
    return;
  const pipeline::FlowStatistics& flow = volumes.statistics().flow;
  report.flow = FlowSummary{.angiograms = flow.volumes.load(),
                            .told = flow.told.load(),
                            .left_out = flow.left_out.load(),
                            .none = flow.none.load(),
                            .no_time = flow.no_time.load(),
                            .tell = flow.tell.summary()};
}

void add_frames(RunReport& report, const FrameStatistics& frames) {
  report.upload = frames.upload.summary();
  report.draw = frames.draw.summary();
  report.control = frames.control.summary();
  for (std::size_t i = 0; i < stage_count; ++i) {
    report.stages[i].lengths = frames.stages[i].summary();
    frames.stages[i].histogram(StageSummary::most_ms, report.stages[i].histogram);
  }
  report.quality = frames.quality.summary();
  report.rays = frames.rays;
}

void add_picture(RunReport& report, const ui::Status& shown) {
  report.picture = {.freshness = shown.freshness,
                    .notice = shown.notice,
                    .missing_b_scans = shown.missing_b_scans,
                    .saturated_lines = shown.saturated_lines,
                    .another_camera = shown.another_camera};
}

} // namespace

PictureStatus picture_status(const RunStatistics& run, hal::TimePoint now) {
  const ui::Status& shown = run.loop.status();
  PictureStatus status{.told = now,
                       .simulated = run.devices.simulated(),
                       .source = run.devices.source(),
                       .freshness = shown.freshness,
                       .counters = run.loop.counters(),
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
  report.line_latency = run.loop.line_latency();
  if (const auto trees = run.loop.traced_trees())
    report.trees = {trees->traced, trees->refused, trees->took};
  add_picture(report, run.loop.status());
  report.started = times.started;
  report.duration_s = hal::to_seconds(times.ended - times.started);
  report.counters = run.loop.final_counters(times.ended - times.started);
  if (frames.first_picture)
    report.first_picture_s = hal::to_seconds(*frames.first_picture - times.process_start);
  report.view = run.loop.actions().state();
  report.actions = run.loop.actions().counts();
  report.faults = std::move(faults);
  return report;
}

} // namespace octascope::firmware_host

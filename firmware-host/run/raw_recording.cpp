#include "firmware-host/run/raw_recording.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "firmware-host/outputs/local_time.h"
#include "firmware-host/outputs/run_recorder.h"
#include "firmware-host/version/version.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

pipeline::RawFacts raw_facts(const Devices& devices, const Reconstruction& reconstruction,
                             const RunOptions& options, std::string configuration_text) {
  hal::LineFormat format = devices.format();
  format.lines_per_frame = devices.plan().lines_per_frame();
  const pipeline::Reconstructor& reconstructor = reconstruction.reconstructor();
  return {.format = format,
          .plan = devices.plan(),
          .averaged_lines = 0,
          .recorded_by = fmt::format("octascope {}", version()),
          .begun = now_in_iso_8601(),
          .source = devices.source(),
          .simulated = devices.simulated(),
          .subject = options.subject,
          .eye = options.eye,
          .configuration = std::move(configuration_text),
          .calibration = reconstruction.calibration(),
          .path = reconstructor.path() == pipeline::ReconstructionPath::fused ? "fused" : "fftw",
          .isa = reconstructor.isa()};
}

void offer_frames(pipeline::VolumeThreadSetup& setup, const Reconstruction& reconstruction,
                  pipeline::RawRecorder& recorder) {
  setup.observe_converted = [&](std::size_t worker, const pipeline::PlacedFrame& placed) {
    const hal::LineFrame& frame = placed.frame;
    recorder.offer(worker,
                   {.volume = placed.volume,
                    .b_scan = placed.b_scan,
                    .repeat = placed.repeat,
                    .sequence = frame.sequence,
                    .first_line_ns = frame.first_line.time_since_epoch().count(),
                    .last_line_ns = frame.last_line.time_since_epoch().count(),
                    .scan_lag_a_scans = placed.scan_lag_a_scans},
                   frame.bytes, reconstruction.background_of(frame));
  };
}

void add_raw(ui::RecordingStatus& status, const pipeline::RawRecorderStatus& raw,
             hal::TimePoint now) {
  if (!raw.on)
    return;
  const hal::Duration lasted = now - raw.since;
  status.on = true;
  status.lasted = std::max(status.lasted, lasted);
  status.not_kept += raw.not_kept;
  const auto room = time_left(lasted, raw.kept, raw.room);
  if (room && (!status.room || *room < *status.room))
    status.room = room;
}

hal::Result<> check_raw_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored))
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "{} is there already, and a recording is never written over: choose another "
                     "name, or remove it",
                     file.string());
  HAL_CHECK(pipeline::AtomicFile::create(file));
  return {};
}

std::string raw_summary(const pipeline::RawRecorder& recorder) {
  const pipeline::RawRecorderStatus status = recorder.status();
  return fmt::format("{}, {} frames{}", recorder.file().string(), status.kept,
                     status.not_kept > 0 ? fmt::format(", {} not kept", status.not_kept) : "");
}

hal::Result<> raw_outcome(const pipeline::RawRecorder& recorder) {
  const pipeline::RawRecorderStatus status = recorder.status();
  const std::string holds = status.kept > 0 ? fmt::format("it holds {} frames", status.kept)
                                            : std::string{"it holds no frame"};
  if (const auto failure = recorder.failure())
    return hal::fail(failure->code, "{}; {}", failure->message, holds);
  if (status.kept == 0)
    return hal::fail(hal::ErrorCode::bad_data, "{}: {}: {}", recorder.file().string(), holds,
                     status.not_kept > 0 ? fmt::format("its disk was too slow for the {} that came",
                                                       status.not_kept)
                                         : std::string{"none came while it was recorded"});
  return {};
}

} // namespace octascope::firmware_host

// What a run has done so far, gathered from its parts: for the report and `octascope status`.
#pragma once

#include <vector>

#include "firmware-host/report/report.h"
#include "firmware-host/supervision/appliance_status.h"
#include "hal/clock.h"

namespace octascope::pipeline {
class Reconstructor;
class VolumeThread;
} // namespace octascope::pipeline

namespace octascope::firmware_host {

class CalibratedCamera;
class Devices;
class RenderLoop;
class WorkerCores;

// Everything is borrowed for the call only.
struct RunStatistics {
  const Devices& devices;
  const pipeline::Reconstructor& reconstructor;
  const WorkerCores& worker_cores;
  const pipeline::VolumeThread& volumes;
  const RenderLoop& loop;
  const CalibratedCamera& calibrated_camera;
};

// At any time, on the render thread.
PictureStatus picture_status(const RunStatistics& run, hal::TimePoint now);

struct RunTimes {
  hal::TimePoint process_start, started, ended;
};

// After the threads have ended: before, the counts need not balance.
RunReport report_on(const RunStatistics& run, const RunTimes& times,
                    std::vector<pipeline::FaultRecord> faults);

} // namespace octascope::firmware_host

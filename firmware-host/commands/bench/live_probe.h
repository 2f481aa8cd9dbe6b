// Runs the whole program on its twins for a few seconds, while a knob turns continuously or tells
// flow, and reads its report.
#pragma once

#include "firmware-host/commands/bench/flow/bench_flow.h"
#include "firmware-host/ledger/shown_quality.h"
#include "hal/result.h"

namespace octascope::firmware_host {

struct LiveFigures {
  double start_to_first_picture_ms = 0; // from process start
  double frames_per_s = 0;              // while the view turns
  QualitySummary turning_quality{};     // meanwhile
  double knob_to_frame_ms_p50 = 0;      // turn of the knob → end of the first frame that shows it
  double knob_to_frame_ms_p95 = 0;
  double latency_ms_p50 = 0; // camera's timestamp of a volume's last line → end of its first frame
  double latency_ms_p95 = 0;
  double resting_latency_ms_p50 = 0; // the same while the view is at rest
  double resting_latency_ms_p95 = 0;
  QualitySummary resting_quality{};
  double lost_volumes = 0;
};

// Takes about twice `seconds`.
hal::Result<LiveFigures> probe_live(int width, int height, double seconds);

// Ten seconds of perfused tissue that moves, at 1280×720; at 215 kHz, with 4 repeats at 860 kHz, so
// that there are as many volumes a second as without repeats at 215 kHz.
hal::Result<LiveFlowFigures> probe_flow(int repeats);

} // namespace octascope::firmware_host

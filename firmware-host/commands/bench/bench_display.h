// octascope bench display: measures how long each technique takes to draw a volume on this machine,
// checks the pictures, and measures the whole appliance.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/commands/bench/live_probe.h"
#include "hal/result.h"
#include "pipeline/volume/volume.h"
#include "ui/view/draw_quality.h"
#include "ui/view/technique.h"

namespace octascope::firmware_host {

struct DisplayBenchOptions {
  // Width and height, from the smallest to the largest.
  std::vector<std::array<int, 2>> sizes{{640, 360}, {1280, 720}, {1920, 1080}};
  std::optional<ui::Technique> technique;    // none: all
  std::optional<ui::RayBackend> rays;        // for techniques that cast rays; none: both
  double seconds = 90;                       // approximate time spent drawing
  std::optional<std::filesystem::path> dump; // folder for pictures and the volume
  bool live = true;                          // also run the appliance
};

struct DisplayBenchCase {
  ui::Technique technique = ui::Technique::rays;
  ui::RayBackend backend = ui::RayBackend::shader; // always this for slices, planes and surface
  int width = 1280;
  int height = 720;
  int steps = 512; // along the longest edge of the volume
  bool opaque = true;
  bool flow = false; // what flows is drawn, too
};

struct DisplayBenchResult {
  DisplayBenchCase what;
  int frames = 0; // each drawn anew, cycling through eight directions; at least 4
  double ms_p50 = 0;
  double ms_p95 = 0;
  // Mean absolute difference over the picture, of 255: from the same technique on the other backend
  // or, for slices and planes, from cast rays; at the smallest size.
  std::optional<double> difference;
};

struct DisplayBenchReport {
  std::string cpu;
  std::string gl_renderer;
  pipeline::VolumeGeometry geometry;
  double window_offset_db = 0;
  double window_size_db = 0;
  std::vector<DisplayBenchResult> cases;
  double upload_ms_p50 = 0;
  std::optional<double> upload_with_flow_ms_p50; // where the volume has flow
  double occupancy_ms_per_b_scan = 0;
  std::optional<LiveFigures> live;
};

// Of a volume that has flow, each case is measured without it and with it.
hal::Result<DisplayBenchReport> bench_display(const pipeline::Volume& volume,
                                              const DisplayBenchOptions& options);

std::string to_json(const DisplayBenchReport& report);

} // namespace octascope::firmware_host

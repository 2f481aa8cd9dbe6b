// octascope bench chain: the highest line rate that the whole chain holds on this machine without a
// loss, on its twins, and what it shows at that rate and others, at which quality.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/ledger/shown_quality.h"
#include "hal/result.h"

namespace octascope::firmware_host {

struct ChainOptions {
  double seconds = 240; // the last measurement may end a few seconds later
  std::array<int, 2> size{1280, 720};
};

// Of all figures. The view rests and shows what is configured by default.
struct ChainConditions {
  std::string cpu;
  int cores = 1;
  std::array<int, 2> size{};  // of the picture, offscreen
  double displayed_run_s = 0; // start included
  double given_run_s = 0; // of the first format at given rates, so that the start counts for less
  double undisplayed_run_s = 0;
};

ChainConditions conditions_of(const ChainOptions& options);

struct ChainFormat {
  int samples = 1024;
  int a_scans = 300;
  int b_scans = 80;
};

struct ChainCase {
  ChainFormat format;
  bool display = true; // else volumes are taken and not drawn
  double line_rate_hz = 215e3;
  bool rolling = false; // each B-scan is shown as it comes; else whole volumes
};

struct ChainLatency {
  double p50_ms, p95_ms, p99_ms; // a volume's last line, or every line → end of the first frame
                                 // that shows it
};

struct ChainFigures {
  std::uint64_t lost_lines = 0; // kept ones; those of lost B-scans and volumes included
  double volumes_per_s = 0;     // that came
  double passed_over_per_s = 0; // of those, not reconstructed, as nobody would have seen them
  double shown_per_s = 0;       // volumes
  double frames_per_s = 0;
  std::optional<ChainLatency> latency{}; // where volumes were shown
  std::optional<ChainLatency> line_latency{};
  QualitySummary quality{};
  double stolen = 0; // share of the processors' time that the host of this machine took
};

enum class RateSign : std::uint8_t {
  highest, // the highest at which two of three runs lost nothing; figures of the last of them
  held,    // likewise, but the time was over before a higher one was tried
  given,
};

struct ChainResult {
  ChainCase what;
  ChainFigures figures;
  RateSign sign = RateSign::given;
};

struct ChainReport {
  ChainConditions conditions;
  std::vector<ChainResult> cases; // first those of given rates
  double reconstruct_only_hz =
      0; // the highest of all formats; 0: none held, or none was tried in time
  double with_display_hz = 0;
};

// `tell` is called with every case as soon as it is known.
hal::Result<ChainReport> bench_chain(const ChainOptions& options,
                                     const std::function<void(const ChainResult&)>& tell);

std::string to_json(const ChainReport& report);

} // namespace octascope::firmware_host

// Which reconstruction path is chosen, why, and the stored timings.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

namespace octascope::pipeline {

enum class ReconstructionPath : std::uint8_t {
  automatic, // the faster one
  fftw,
  fused, // falls back to fftw where it does not apply
};

// Time of one line on either path.
struct PathTimes {
  double fused_ns = 0;
  double fftw_ns = 0;
};

enum class PathReason : std::uint8_t {
  asked,      // the caller wanted this one
  only,       // the fused path does not apply
  measured,   // the faster one, timed just now
  remembered, // the faster one, timed before
};
std::string_view name_of(PathReason reason);

struct PathDecision {
  PathReason reason = PathReason::only;
  std::optional<PathTimes> times; // of `measured` and `remembered`
};

// Keeps measured times from one start to the next. The pipeline knows no folders, so the caller who
// makes a Reconstructor may lend it one. `line_case` names what the times depend on besides the
// machine: samples, type, interpolation, dispersion and instruction set. Neither function may fail:
// times that cannot be kept are measured again.
class PathMemory {
public:
  virtual ~PathMemory() = default;
  virtual std::optional<PathTimes> recall(std::string_view line_case) = 0;
  virtual void remember(std::string_view line_case, const PathTimes& times) = 0;
};

// The least time of several alternating runs of both paths, each over `lines` lines: other load
// then disturbs both alike.
PathTimes benchmark_paths(const std::function<void()>& fused, const std::function<void()>& fftw,
                          int lines);

} // namespace octascope::pipeline

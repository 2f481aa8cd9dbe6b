#include "pipeline/reconstruction/reconstructor.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "pipeline/reconstruction/fftw_path.h"
#include "pipeline/reconstruction/fused/fused_path.h"
#include "pipeline/reconstruction/line_kernels.h"

namespace octascope::pipeline {

using hal::ErrorCode;

static_assert(std::endian::native == std::endian::little, "frames are little-endian");

namespace {

hal::Result<> check(const ReconstructionSetup& setup) {
  const auto refuse = [](std::string_view message) {
    return hal::fail(ErrorCode::invalid_argument, "reconstruction: {}", message);
  };
  if (setup.format.samples != setup.calibration.samples)
    return refuse(fmt::format("lines have {} samples, the calibration is for {}",
                              setup.format.samples, setup.calibration.samples));
  if (setup.a_scans < 1 || setup.a_scans > 65536)
    return refuse(fmt::format("a_scans is {}, expected 1 to 65536", setup.a_scans));
  if (const auto format = setup.format.validate(); !format)
    return refuse(format.error().message);
  return setup.calibration.validate().and_then(
      [&] { return setup.calibration.fixed_pattern.validate(setup.a_scans); });
}

// Nothing where the fused path does not apply.
std::optional<FusedPath> make_fused(const ReconstructionSetup& setup) {
  const Calibration& calibration = setup.calibration;
  if (setup.path == ReconstructionPath::fftw || setup.format.type == hal::SampleType::f32 ||
      calibration.zero_padding > 1 || calibration.fixed_pattern.mode != FixedPatternMode::none)
    return std::nullopt;
  return FusedPath::make(calibration, static_cast<int>(bytes_per_sample(setup.format.type)),
                         setup.format.right_shift, setup.fused_isa);
}

// What the times of both paths depend on.
std::string line_case(const ReconstructionSetup& setup, const FusedPath& fused) {
  constexpr std::string_view interpolations[] = {"linear", "cubic", "sinc8"};
  const Calibration& calibration = setup.calibration;
  const bool resampled =
      calibration.positions != Calibration::identity(calibration.samples).positions;
  const bool summed = calibration.background_mode == BackgroundMode::mean;
  return fmt::format("{} {}{} {} {} {} {}", setup.format.samples, to_string(setup.format.type),
                     setup.format.right_shift > 0 ? " shifted" : "",
                     resampled ? interpolations[static_cast<std::size_t>(calibration.interpolation)]
                               : "unresampled",
                     calibration.dispersion_rad.empty() ? "real" : "dispersion",
                     summed ? "mean" : "given", fused.isa());
}

// `levels` [line][z]: each saturated line becomes the lower, at each depth, of itself and the
// brighter of the nearest unsaturated lines before and behind it. Where there is none, all stay.
template <class Level>
void limit_lines(std::span<const std::uint8_t> saturated, Level* levels, std::size_t depths) {
  const std::size_t lines = saturated.size();
  const auto next_good = [&](std::size_t line) {
    while (line < lines && saturated[line] != 0)
      ++line;
    return line;
  };
  std::size_t before = lines; // none
  std::size_t behind = next_good(0);
  if (behind == lines)
    return;
  for (std::size_t a = 0; a < lines; ++a) {
    if (saturated[a] == 0) {
      before = a;
      continue;
    }
    if (behind < a)
      behind = next_good(a);
    const Level* left = levels + (before < lines ? before : behind) * depths;
    const Level* right = levels + (behind < lines ? behind : before) * depths;
    Level* line = levels + a * depths;
    for (std::size_t z = 0; z < depths; ++z)
      line[z] = std::min(line[z], std::max(left[z], right[z]));
  }
}

template <class Level> Level* levels_of(Level* levels) {
  return levels;
}
std::uint8_t* levels_of(const BinsAndLevels& both) {
  return both.levels;
}

} // namespace

// Everything that is the same for all B-scans.
struct Reconstructor::Plan {
  SpectrumFormat format;
  int a_scans;
  int depths;
  bool limit_saturated_lines;
  BackgroundMode background_mode;
  std::vector<float> recorded_background;
  FftwPath fftw;
  std::optional<FusedPath> fused; // used where there is one
  PathDecision decision;

  std::unique_ptr<Workspace::Buffers> make_buffers() const;
  void choose_path(const ReconstructionSetup& setup);
  PathTimes measure_paths() const;

  template <class Count>
  const float* background_of(Workspace::Buffers& buffers, const Count* counts, int lines,
                             std::span<const float> running) const noexcept;
  void set_background(const FusedPath& path, Workspace::Buffers& buffers,
                      const float* background) const noexcept;
  template <class Count, class Levels>
  int run(const std::optional<FusedPath>& path, Workspace::Buffers& buffers, int lines,
          std::span<const std::byte> frame, Levels levels,
          std::span<const float> running) const noexcept;
  template <class Levels>
  int dispatch(const std::optional<FusedPath>& path, Workspace::Buffers& buffers, int lines,
               std::span<const std::byte> frame, Levels levels,
               std::span<const float> running) const noexcept;
  template <class Levels>
  BScanOutcome b_scan(Workspace::Buffers& buffers, std::span<const std::byte> frame, Levels levels,
                      std::span<const float> running) const noexcept;
};

struct Reconstructor::Workspace::Buffers {
  LineMean mean;
  std::vector<float> background;
  std::vector<std::uint8_t> saturated; // by line
  FftwPath::Buffers fftw;
  std::optional<FusedPath::Buffers> fused;
};

std::unique_ptr<Reconstructor::Workspace::Buffers> Reconstructor::Plan::make_buffers() const {
  std::unique_ptr<Workspace::Buffers> buffers{new Workspace::Buffers{
      LineMean{format.samples}, std::vector<float>(static_cast<std::size_t>(format.samples)),
      std::vector<std::uint8_t>(static_cast<std::size_t>(a_scans)), fftw.make_buffers(),
      std::nullopt}};
  if (background_mode == BackgroundMode::file)
    buffers->background = recorded_background;
  if (fused) {
    buffers->fused = fused->make_buffers();
    fused->set_background(buffers->background.data(), *buffers->fused);
  }
  return buffers;
}

template <class Count>
const float* Reconstructor::Plan::background_of(Workspace::Buffers& buffers, const Count* counts,
                                                int lines,
                                                std::span<const float> running) const noexcept {
  if (background_mode == BackgroundMode::running && !running.empty()) {
    assert(running.size() == buffers.background.size());
    return running.data();
  }
  if (background_mode == BackgroundMode::mean || background_mode == BackgroundMode::running) {
    buffers.mean.measure(counts, lines, format.right_shift);
    std::ranges::transform(buffers.mean.values(), buffers.background.begin(),
                           [](double mean) { return static_cast<float>(mean); });
  }
  return buffers.background.data();
}

// One that was recorded is set for good.
void Reconstructor::Plan::set_background(const FusedPath& path, Workspace::Buffers& buffers,
                                         const float* background) const noexcept {
  if (background_mode == BackgroundMode::mean || background_mode == BackgroundMode::running)
    path.set_background(background, *buffers.fused);
}

template <class Count, class Levels>
int Reconstructor::Plan::run(const std::optional<FusedPath>& path, Workspace::Buffers& buffers,
                             int lines, std::span<const std::byte> frame, Levels levels,
                             std::span<const float> running) const noexcept {
  const auto* counts = reinterpret_cast<const Count*>(frame.data());
  const float* background = background_of(buffers, counts, lines, running);
  if constexpr (!std::is_same_v<Count, float>) {
    if (path) {
      set_background(*path, buffers, background);
      return path->reconstruct(frame.data(), lines, format.full_scale(), *buffers.fused, levels,
                               buffers.saturated.data());
    }
  }
  return fftw.reconstruct(counts, lines, background, buffers.fftw, levels,
                          buffers.saturated.data());
}

template <class Levels>
int Reconstructor::Plan::dispatch(const std::optional<FusedPath>& path, Workspace::Buffers& buffers,
                                  int lines, std::span<const std::byte> frame, Levels levels,
                                  std::span<const float> running) const noexcept {
  switch (format.type) {
  case hal::SampleType::u8: return run<std::uint8_t>(path, buffers, lines, frame, levels, running);
  case hal::SampleType::u16:
    return run<std::uint16_t>(path, buffers, lines, frame, levels, running);
  case hal::SampleType::f32: break;
  }
  return run<float>(path, buffers, lines, frame, levels, running);
}

template <class Levels>
BScanOutcome Reconstructor::Plan::b_scan(Workspace::Buffers& buffers,
                                         std::span<const std::byte> frame, Levels levels,
                                         std::span<const float> running) const noexcept {
  assert(frame.size() >= format.line_bytes() * static_cast<std::size_t>(a_scans));
  const int saturated = dispatch(fused, buffers, a_scans, frame, levels, running);
  if (saturated > 0 && limit_saturated_lines)
    limit_lines(buffers.saturated, levels_of(levels), static_cast<std::size_t>(depths));
  return {saturated};
}

PathTimes Reconstructor::Plan::measure_paths() const {
  // A short B-scan: large ones take no longer by the line, and only delay the start.
  const int lines = std::min(a_scans, 64);
  // A running background is given, as live.
  const std::vector<float> given(static_cast<std::size_t>(format.samples));
  const auto buffers = make_buffers();
  std::vector<std::byte> frame(format.line_bytes() * static_cast<std::size_t>(lines));
  for (std::size_t i = 0; i < frame.size(); ++i)
    frame[i] = static_cast<std::byte>(i * i >> 8);
  std::vector<std::uint8_t> levels(static_cast<std::size_t>(lines) *
                                   static_cast<std::size_t>(depths));
  const auto run_on = [&](const std::optional<FusedPath>& path) {
    dispatch(path, *buffers, lines, frame, levels.data(), given);
  };
  const std::optional<FusedPath> no_fused;
  return benchmark_paths([&] { run_on(fused); }, [&] { run_on(no_fused); }, lines);
}

void Reconstructor::Plan::choose_path(const ReconstructionSetup& setup) {
  if (setup.path != ReconstructionPath::automatic || !fused) {
    const bool asked = setup.path == ReconstructionPath::fftw || fused;
    decision = {asked ? PathReason::asked : PathReason::only, std::nullopt};
    return;
  }
  const std::string what = line_case(setup, *fused);
  if (setup.memory != nullptr)
    decision = {PathReason::remembered, setup.memory->recall(what)};
  if (!decision.times) {
    decision = {PathReason::measured, measure_paths()};
    if (setup.memory != nullptr)
      setup.memory->remember(what, *decision.times);
  }
  if (decision.times->fftw_ns < decision.times->fused_ns)
    fused.reset();
}

Reconstructor::Workspace::Workspace(std::unique_ptr<Buffers> buffers)
    : buffers_(std::move(buffers)) {}
Reconstructor::Workspace::Workspace(Workspace&&) noexcept = default;
Reconstructor::Workspace& Reconstructor::Workspace::operator=(Workspace&&) noexcept = default;
Reconstructor::Workspace::~Workspace() = default;

hal::Result<Reconstructor> Reconstructor::create(const ReconstructionSetup& setup) {
  HAL_CHECK(check(setup));
  const Calibration& calibration = setup.calibration;
  HAL_TRY(auto fftw, FftwPath::make(calibration, setup.format, setup.a_scans));
  auto plan = std::make_unique<Plan>(Plan{.format = setup.format,
                                          .a_scans = setup.a_scans,
                                          .depths = calibration.depths(),
                                          .limit_saturated_lines = setup.limit_saturated_lines,
                                          .background_mode = calibration.background_mode,
                                          .recorded_background = calibration.background,
                                          .fftw = std::move(fftw),
                                          .fused = make_fused(setup),
                                          .decision = {}});
  plan->choose_path(setup);
  return Reconstructor{std::move(plan)};
}

Reconstructor::Reconstructor(std::unique_ptr<const Plan> plan) : plan_(std::move(plan)) {}
Reconstructor::Reconstructor(Reconstructor&&) noexcept = default;
Reconstructor& Reconstructor::operator=(Reconstructor&&) noexcept = default;
Reconstructor::~Reconstructor() = default;

int Reconstructor::samples() const {
  return plan_->format.samples;
}
int Reconstructor::depths() const {
  return plan_->depths;
}
int Reconstructor::a_scans() const {
  return plan_->a_scans;
}
std::size_t Reconstructor::levels() const {
  return static_cast<std::size_t>(depths()) * static_cast<std::size_t>(a_scans());
}

ReconstructionPath Reconstructor::path() const {
  return plan_->fused ? ReconstructionPath::fused : ReconstructionPath::fftw;
}
const char* Reconstructor::isa() const {
  return plan_->fused ? plan_->fused->isa() : "native";
}
const PathDecision& Reconstructor::path_decision() const {
  return plan_->decision;
}

Reconstructor::Workspace Reconstructor::make_workspace() const {
  return Workspace{plan_->make_buffers()};
}
std::optional<RunningBackground> Reconstructor::make_running_background(int sweeps) const {
  if (plan_->background_mode != BackgroundMode::running)
    return std::nullopt;
  return RunningBackground{plan_->format, plan_->a_scans, sweeps};
}

BScanOutcome Reconstructor::reconstruct_b_scan(Workspace& workspace,
                                               std::span<const std::byte> frame,
                                               std::span<std::uint8_t> levels,
                                               std::span<const float> running) const noexcept {
  assert(levels.size() >= this->levels());
  return plan_->b_scan(*workspace.buffers_, frame, levels.data(), running);
}

BScanOutcome Reconstructor::reconstruct_b_scan_db(Workspace& workspace,
                                                  std::span<const std::byte> frame,
                                                  std::span<float> levels_db,
                                                  std::span<const float> running) const noexcept {
  assert(levels_db.size() >= levels());
  return plan_->b_scan(*workspace.buffers_, frame, levels_db.data(), running);
}

BScanOutcome Reconstructor::reconstruct_b_scan_both(Workspace& workspace,
                                                    std::span<const std::byte> frame,
                                                    std::span<PackedBin> bins,
                                                    std::span<std::uint8_t> levels,
                                                    std::span<const float> running) const noexcept {
  assert(bins.size() >= this->levels() && levels.size() >= this->levels());
  return plan_->b_scan(*workspace.buffers_, frame, BinsAndLevels{bins.data(), levels.data()},
                       running);
}

std::span<const std::uint8_t>
Reconstructor::saturated_lines(const Workspace& workspace) const noexcept {
  return workspace.buffers_->saturated;
}

} // namespace octascope::pipeline

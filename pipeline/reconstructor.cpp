#include "pipeline/reconstructor.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "pipeline/background.h"
#include "pipeline/fft_plan.h"
#include "pipeline/fused_path.h"
#include "pipeline/k_linearisation.h"
#include "pipeline/line_kernels.h"

namespace octascope::pipeline {

using hal::Fault;

static_assert(std::endian::native == std::endian::little, "frames are little-endian");

namespace {

struct FftwFree {
  void operator()(float* memory) const { fftwf_free(memory); }
};
using FftwBuffer = std::unique_ptr<float[], FftwFree>;

// Zeroed, aligned as FFTW's fastest code wants it.
FftwBuffer make_buffer(std::size_t floats) {
  FftwBuffer buffer{fftwf_alloc_real(floats)};
  std::fill_n(buffer.get(), floats, 0.0F);
  return buffer;
}

std::size_t padded(int samples) {
  return (static_cast<std::size_t>(samples) + 7) / 8 * 8;
}

fftwf_complex* as_complex(float* floats) {
  return reinterpret_cast<fftwf_complex*>(floats);
}

FftPlan plan_transform(int samples, bool complex_input) {
  // Two floats a sample serve both transforms, in and out.
  const FftwBuffer in = make_buffer(2 * padded(samples));
  const FftwBuffer out = make_buffer(2 * padded(samples));
  const std::scoped_lock lock{fft_planner_mutex()};
  constexpr double longest_planning_s = 1; // lines of many samples: a good plan, not the best
  fftwf_set_timelimit(longest_planning_s);
  return FftPlan{complex_input
                     ? fftwf_plan_dft_1d(samples, as_complex(in.get()), as_complex(out.get()),
                                         FFTW_FORWARD, FFTW_MEASURE)
                     : fftwf_plan_dft_r2c_1d(samples, in.get(), as_complex(out.get()),
                                             FFTW_MEASURE | FFTW_DESTROY_INPUT)};
}

// Window, dispersion phase and the 1/N of the level, folded. The padding is 0.
std::vector<float> make_factors(const Calibration& calibration) {
  const bool complex_factors = !calibration.dispersion_rad.empty();
  std::vector<float> factors(padded(calibration.samples) * (complex_factors ? 2 : 1));
  for (std::size_t m = 0; m < calibration.window.size(); ++m) {
    const double weight = calibration.window[m] / calibration.samples;
    if (complex_factors) {
      factors[2 * m] = static_cast<float>(weight * std::cos(calibration.dispersion_rad[m]));
      factors[2 * m + 1] = static_cast<float>(weight * std::sin(calibration.dispersion_rad[m]));
    } else {
      factors[m] = static_cast<float>(weight);
    }
  }
  return factors;
}

hal::Result<> check(const ReconstructionSetup& setup) {
  const SpectrumFormat& format = setup.format;
  const auto refuse = [](std::string message) {
    return hal::fail(Fault::invalid_argument, "reconstruction: " + std::move(message));
  };
  if (format.samples != setup.calibration.samples)
    return refuse(fmt::format("lines have {} samples, the calibration is for {}", format.samples,
                              setup.calibration.samples));
  if (setup.a_scans < 1 || setup.a_scans > 65536)
    return refuse(fmt::format("a_scans is {}, expected 1 to 65536", setup.a_scans));
  const int bits = format.type == SpectrumType::u8 ? 8 : 16;
  if (format.significant_bits < 1 || format.right_shift < 0 || format.right_shift >= bits ||
      format.significant_bits + format.right_shift > bits)
    return refuse(fmt::format("significant_bits {} and right_shift {} do not fit into {} bits",
                              format.significant_bits, format.right_shift, bits));
  return setup.calibration.validate();
}

} // namespace

SpectrumFormat::SpectrumFormat(int samples_per_line, SpectrumType sample_type)
    : samples(samples_per_line), type(sample_type),
      significant_bits(sample_type == SpectrumType::u8 ? 8 : 16) {}

SpectrumFormat::SpectrumFormat(const hal::LineFormat& line)
    : samples(line.samples_per_line),
      type(line.sample_type == hal::SampleType::u8 ? SpectrumType::u8 : SpectrumType::u16),
      significant_bits(line.significant_bits), right_shift(line.right_shift) {}

// Everything that is the same for all B-scans.
struct Reconstructor::Plan {
  SpectrumFormat format;
  int a_scans = 0;
  BackgroundMode background_mode = BackgroundMode::mean;
  std::vector<float> recorded_background;
  ResamplingTaps taps;
  std::vector<float> factors;
  bool complex_input = false;
  ShapeLine shape_line = nullptr;
  FftPlan transform;
  std::optional<FusedPath> fused; // used where there is one

  bool background_is_measured() const {
    return background_mode == BackgroundMode::mean || background_mode == BackgroundMode::running;
  }
  std::unique_ptr<Workspace::Buffers> make_buffers() const;
  void choose_path(ReconstructionPath wanted);
  std::chrono::nanoseconds time_b_scan(const std::vector<std::byte>& frame);

  template <class Count, class Level>
  BScanOutcome run(Workspace::Buffers& buffers, std::span<const std::byte> frame,
                   std::span<Level> levels) const noexcept;
  template <class Level>
  BScanOutcome dispatch(Workspace::Buffers& buffers, std::span<const std::byte> frame,
                        std::span<Level> levels) const noexcept;
};

struct Reconstructor::Workspace::Buffers {
  Buffers(BackgroundMode mode, int samples, const std::vector<float>& recorded)
      : background(mode, samples, recorded), line(make_buffer(padded(samples))),
        shaped(make_buffer(2 * padded(samples))), bins(make_buffer(2 * padded(samples))) {}

  void set_fused(const FusedPath& path) {
    fused = path.make_buffers();
    path.set_background(background.values(), *fused);
  }

  Background background;
  FftwBuffer line;   // counts without background
  FftwBuffer shaped; // input of the transform
  FftwBuffer bins;   // its output, complex
  std::optional<FusedPath::Buffers> fused;
};

template <class Count, class Level>
BScanOutcome Reconstructor::Plan::run(Workspace::Buffers& buffers, std::span<const std::byte> frame,
                                      std::span<Level> levels) const noexcept {
  const int samples = format.samples;
  const int depths = samples / 2;
  const auto lines = static_cast<std::size_t>(a_scans);
  const std::span counts{reinterpret_cast<const Count*>(frame.data()),
                         lines * static_cast<std::size_t>(samples)};
  assert(frame.size() >= counts.size_bytes());
  assert(levels.size() >= lines * static_cast<std::size_t>(depths));
  buffers.background.update(counts, a_scans, format.right_shift);
  const float* background = buffers.background.values();
  const std::uint32_t full_scale = (1U << format.significant_bits) - 1U;

  if constexpr (!std::is_same_v<Count, float>) {
    if (fused) {
      if (background_is_measured())
        fused->set_background(background, *buffers.fused);
      return {fused->reconstruct(frame.data(), a_scans, full_scale, *buffers.fused, levels.data())};
    }
  }

  BScanOutcome outcome;
  for (std::size_t a = 0; a < lines; ++a) {
    const std::uint32_t highest =
        load_line(counts.data() + a * static_cast<std::size_t>(samples), background,
                  format.right_shift, samples, buffers.line.get());
    outcome.saturated_lines += highest >= full_scale ? 1 : 0;
    shape_line(buffers.line.get(), taps.first.data(), taps.weights.data(), factors.data(), samples,
               buffers.shaped.get());
    if (complex_input)
      fftwf_execute_dft(transform.get(), as_complex(buffers.shaped.get()),
                        as_complex(buffers.bins.get()));
    else
      fftwf_execute_dft_r2c(transform.get(), buffers.shaped.get(), as_complex(buffers.bins.get()));
    Level* profile = levels.data() + a * static_cast<std::size_t>(depths);
    if constexpr (std::is_same_v<Level, float>)
      levels_db(buffers.bins.get(), depths, profile);
    else
      levels_u8(buffers.bins.get(), depths, profile);
  }
  return outcome;
}

template <class Level>
BScanOutcome Reconstructor::Plan::dispatch(Workspace::Buffers& buffers,
                                           std::span<const std::byte> frame,
                                           std::span<Level> levels) const noexcept {
  switch (format.type) {
  case SpectrumType::u8: return run<std::uint8_t>(buffers, frame, levels);
  case SpectrumType::u16: return run<std::uint16_t>(buffers, frame, levels);
  case SpectrumType::f32: return run<float>(buffers, frame, levels);
  }
  return {};
}

std::unique_ptr<Reconstructor::Workspace::Buffers> Reconstructor::Plan::make_buffers() const {
  auto buffers =
      std::make_unique<Workspace::Buffers>(background_mode, format.samples, recorded_background);
  if (fused)
    buffers->set_fused(*fused);
  return buffers;
}

// The fastest of a few B-scans on whichever path is set.
std::chrono::nanoseconds Reconstructor::Plan::time_b_scan(const std::vector<std::byte>& frame) {
  using Clock = std::chrono::steady_clock;
  const auto buffers = make_buffers();
  std::vector<std::uint8_t> levels(static_cast<std::size_t>(a_scans) *
                                   static_cast<std::size_t>(format.samples / 2));
  auto fastest = std::chrono::nanoseconds::max();
  for (int repeat = 0; repeat < 5; ++repeat) {
    const auto start = Clock::now();
    dispatch(*buffers, std::span{frame}, std::span{levels});
    fastest = std::min<std::chrono::nanoseconds>(fastest, Clock::now() - start);
  }
  return fastest;
}

void Reconstructor::Plan::choose_path(ReconstructionPath wanted) {
  if (!fused || wanted == ReconstructionPath::fused)
    return;
  std::optional<FusedPath> candidate;
  if (wanted == ReconstructionPath::automatic) {
    // A short B-scan: large ones take no longer by the line, and only delay the start.
    const int all_a_scans = std::exchange(a_scans, std::min(a_scans, 64));
    std::vector<std::byte> frame(format.line_bytes() * static_cast<std::size_t>(a_scans));
    for (std::size_t i = 0; i < frame.size(); ++i)
      frame[i] = static_cast<std::byte>(i * i >> 8);
    const auto with_fused = time_b_scan(frame);
    candidate.swap(fused);
    const auto with_fftw = time_b_scan(frame);
    a_scans = all_a_scans;
    if (with_fused < with_fftw)
      candidate.swap(fused);
  } else {
    fused.reset();
  }
}

Reconstructor::Workspace::Workspace(std::unique_ptr<Buffers> buffers)
    : buffers_(std::move(buffers)) {}
Reconstructor::Workspace::Workspace(Workspace&&) noexcept = default;
Reconstructor::Workspace& Reconstructor::Workspace::operator=(Workspace&&) noexcept = default;
Reconstructor::Workspace::~Workspace() = default;
void Reconstructor::Workspace::reset_background() {
  buffers_->background.reset();
}

hal::Result<Reconstructor> Reconstructor::create(const ReconstructionSetup& setup) {
  if (const auto checked = check(setup); !checked)
    return tl::make_unexpected(checked.error());
  const Calibration& calibration = setup.calibration;
  auto plan = std::make_unique<Plan>();
  plan->format = setup.format;
  plan->a_scans = setup.a_scans;
  plan->background_mode = calibration.background_mode;
  plan->recorded_background = calibration.background;
  plan->taps = make_resampling_taps(calibration.positions, calibration.interpolation);
  plan->factors = make_factors(calibration);
  plan->complex_input = !calibration.dispersion_rad.empty();
  plan->shape_line = shape_line_kernel(plan->taps.width, plan->complex_input);
  plan->transform = plan_transform(calibration.samples, plan->complex_input);
  if (!plan->transform)
    return hal::fail(Fault::system, fmt::format("reconstruction: FFTW has no plan for {} samples",
                                                calibration.samples));
  if (setup.format.type != SpectrumType::f32)
    plan->fused =
        FusedPath::make(calibration, static_cast<int>(bytes_per_sample(setup.format.type)),
                        setup.format.right_shift, setup.fused_isa);
  plan->choose_path(setup.path);
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
  return plan_->format.samples / 2;
}
int Reconstructor::a_scans() const {
  return plan_->a_scans;
}
std::size_t Reconstructor::kept_bytes() const {
  return plan_->format.line_bytes() * static_cast<std::size_t>(plan_->a_scans);
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

Reconstructor::Workspace Reconstructor::make_workspace() const {
  return Workspace{plan_->make_buffers()};
}

BScanOutcome Reconstructor::reconstruct_b_scan(Workspace& workspace,
                                               std::span<const std::byte> frame,
                                               std::span<std::uint8_t> levels) const noexcept {
  return plan_->dispatch(*workspace.buffers_, frame, levels);
}

BScanOutcome Reconstructor::reconstruct_b_scan_db(Workspace& workspace,
                                                  std::span<const std::byte> frame,
                                                  std::span<float> levels_db) const noexcept {
  return plan_->dispatch(*workspace.buffers_, frame, levels_db);
}

} // namespace octascope::pipeline

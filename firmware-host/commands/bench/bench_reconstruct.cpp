#include "firmware-host/commands/bench/bench_reconstruct.h"

#include <algorithm>
#include <barrier>
#include <cmath>
#include <complex>
#include <cstring>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <thread>
#include <utility>

#include "firmware-host/commands/bench/bench_timing.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "pipeline/calibration_finder/axial_psf.h"
#include "pipeline/reconstruction/fft_plan.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::firmware_host {

namespace {

using pipeline::BackgroundMode;
using pipeline::Interpolation;
using pipeline::ReconstructionPath;

constexpr int samples = bench_samples;
constexpr int a_scans = 300;
constexpr int fewest_repeats = 9;
constexpr double source_counts = 20000;
constexpr std::size_t b_scan_counts = std::size_t{a_scans} * samples;
constexpr std::size_t ring_b_scans = 90; // 55 MB: larger than last-level caches, or what VMs see

pipeline::Calibration make_calibration(const BenchCase& what) {
  pipeline::Calibration calibration = pipeline::Calibration::identity(samples);
  calibration.interpolation = what.interpolation;
  for (std::size_t m = 0; m < samples; ++m) {
    const double u = static_cast<double>(m) / (samples - 1);
    calibration.positions[m] = (samples - 1) * u + 280 * u * (1 - u);
    if (what.dispersion)
      calibration.dispersion_rad.push_back(40 * (u - 0.5) * (u - 0.5));
  }
  calibration.background_mode = what.background;
  if (what.background == BackgroundMode::file)
    calibration.background.assign(samples, static_cast<float>(source_counts));
  return calibration;
}

// Reflectors, a source spectrum and noise, different in every B-scan.
std::vector<std::uint16_t> make_ring() {
  std::mt19937 generator{7};
  std::uniform_real_distribution<double> depth{0.02, 0.9};
  std::vector<std::uint16_t> ring(ring_b_scans * b_scan_counts);
  for (std::size_t b = 0; b < ring_b_scans; ++b) {
    const double near = depth(generator);
    const double far = depth(generator);
    std::vector<double> fringes(samples);
    for (std::size_t p = 0; p < samples; ++p)
      fringes[p] = source_counts +
                   4000 * std::cos(std::numbers::pi * near * static_cast<double>(p)) +
                   400 * std::cos(std::numbers::pi * far * static_cast<double>(p));
    for (std::size_t i = 0; i < b_scan_counts; ++i)
      ring[b * b_scan_counts + i] =
          static_cast<std::uint16_t>(fringes[i % samples] * (i / samples % 2 == 0 ? 1.0 : 0.9) +
                                     static_cast<double>(generator() % 512));
  }
  return ring;
}

// The bare transform: in and out in the first-level cache, the best plan of the planner's efforts.
class BareTransform {
public:
  BareTransform() {
    std::fill_n(in_.get(), 2 * samples, 0.5F);
    const pipeline::FftPlan measured = plan(FFTW_MEASURE);
    const pipeline::FftPlan patient = plan(FFTW_PATIENT);
    std::fill_n(in_.get(), 2 * samples, 0.5F);
    double best[2] = {1, 1};
    for (int repeat = 0; repeat < 5; ++repeat) {
      best[0] = std::min(best[0], time_once(measured.get(), 500));
      best[1] = std::min(best[1], time_once(patient.get(), 500));
    }
    plan_ = plan(best[1] < best[0] ? FFTW_PATIENT : FFTW_MEASURE); // known by now: no planning
    std::fill_n(in_.get(), 2 * samples, 0.5F);
  }

  double seconds() { return time_once(plan_.get(), 400); }

private:
  struct Free {
    void operator()(float* memory) const { fftwf_free(memory); }
  };
  using Buffer = std::unique_ptr<float[], Free>;

  pipeline::FftPlan plan(unsigned effort) {
    const std::scoped_lock lock{pipeline::fft_planner_mutex()};
    fftwf_set_timelimit(5);
    return pipeline::FftPlan{fftwf_plan_dft_1d(samples, reinterpret_cast<fftwf_complex*>(in_.get()),
                                               reinterpret_cast<fftwf_complex*>(out_.get()),
                                               FFTW_FORWARD, effort)};
  }
  static double time_once(fftwf_plan plan, int transforms) {
    const auto start = BenchClock::now();
    for (int i = 0; i < transforms; ++i)
      fftwf_execute(plan);
    return seconds_since(start) / transforms;
  }

  Buffer in_{fftwf_alloc_real(2 * samples)};
  Buffer out_{fftwf_alloc_real(2 * samples)};
  pipeline::FftPlan plan_;
};

// Levels of line `a` in double precision: sums as they stand in books, the transform included.
// `running`: the background, with BackgroundMode::running.
std::vector<double> reference_levels_db(std::span<const std::uint16_t> b_scan, std::size_t a,
                                        const pipeline::Calibration& calibration,
                                        std::span<const float> running) {
  std::vector<double> line(samples);
  if (calibration.background_mode == BackgroundMode::mean)
    for (std::size_t i = 0; i < b_scan.size(); ++i)
      line[i % samples] -= static_cast<double>(b_scan[i]) / a_scans;
  else
    std::ranges::transform(running.empty() ? std::span{calibration.background} : running,
                           line.begin(), [](float b) { return -b; });
  for (std::size_t p = 0; p < samples; ++p)
    line[p] += b_scan[a * samples + p];
  const std::vector<double> counts = pipeline::resample_line(
      line, pipeline::make_resampling_taps(calibration.positions, calibration.interpolation));
  std::vector<std::complex<double>> shaped(samples);
  std::vector<std::complex<double>> roots(samples);
  for (std::size_t m = 0; m < samples; ++m) {
    const double theta = calibration.dispersion_rad.empty() ? 0 : calibration.dispersion_rad[m];
    shaped[m] = std::polar(1.0, theta) * (counts[m] * calibration.window[m] / samples);
    roots[m] = std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(m) / samples);
  }
  std::vector<double> levels(samples / 2);
  for (std::size_t z = 0; z < levels.size(); ++z) {
    std::complex<double> sum = 0;
    for (std::size_t m = 0; m < samples; ++m)
      sum += shaped[m] * roots[m * z % samples];
    levels[z] = 10 * std::log10(std::norm(sum));
  }
  return levels;
}

class CaseBench {
public:
  CaseBench(const BenchCase& what, pipeline::Reconstructor reconstructor,
            const std::vector<std::uint16_t>& ring)
      : reconstructor_(std::move(reconstructor)), ring_(ring) {
    result_.what = what;
    result_.what.isa = reconstructor_.isa();
    for (int thread = 0; thread < what.threads; ++thread) {
      workspaces_.push_back(reconstructor_.make_workspace());
      levels_.emplace_back(reconstructor_.levels());
      running_.push_back(reconstructor_.make_running_background(ring_b_scans));
    }
  }

  BenchResult measure(BareTransform& bare, double seconds, std::vector<double>& bare_seconds) {
    check(make_calibration(result_.what));
    // Short repeats, many of them: on a busy machine most fall between two interruptions, and the
    // median is one of those. Starting threads takes its time, so that two work for longer.
    const std::size_t b_scans = workspaces_.size() == 1 ? 2 : 16 * workspaces_.size();
    seconds_a_line(b_scans);
    std::vector<double> ratios;
    std::vector<double> rates;
    const auto start = BenchClock::now();
    while (ratios.size() < fewest_repeats || seconds_since(start) < seconds) {
      const double before = bare.seconds();
      const double line = seconds_a_line(b_scans);
      const double transform = (before + bare.seconds()) / 2;
      bare_seconds.push_back(transform);
      ratios.push_back(line / transform);
      rates.push_back(1 / line);
    }
    result_.repeats = static_cast<int>(ratios.size());
    result_.lines_per_s = quantile(rates, 0.5);
    result_.ratio_to_fftw = quantile(ratios, 0.5);
    result_.spread = (quantile(ratios, 0.75) - quantile(ratios, 0.25)) / result_.ratio_to_fftw;
    return result_;
  }

private:
  // `b_scans` over all threads, on through the ring.
  double seconds_a_line(std::size_t b_scans) {
    const auto threads = workspaces_.size();
    const std::size_t each = (b_scans + threads - 1) / threads;
    BenchClock::time_point start;
    std::barrier together{static_cast<std::ptrdiff_t>(threads), [&]() noexcept {
                            if (start == BenchClock::time_point{})
                              start = BenchClock::now();
                          }};
    const auto work = [&](std::size_t thread) {
      together.arrive_and_wait();
      for (std::size_t i = 0; i < each; ++i)
        reconstruct((next_ + i * threads + thread) % ring_b_scans, thread);
      together.arrive_and_wait();
    };
    std::vector<std::jthread> others;
    for (std::size_t thread = 1; thread < threads; ++thread)
      others.emplace_back(work, thread);
    work(0);
    const double elapsed = seconds_since(start);
    next_ = (next_ + each * threads) % ring_b_scans;
    return elapsed / static_cast<double>(each * threads * a_scans);
  }

  void reconstruct(std::size_t b_scan, std::size_t thread) {
    const std::span counts{ring_.data() + b_scan * b_scan_counts, b_scan_counts};
    auto& running = running_[thread];
    reconstructor_.reconstruct_b_scan(workspaces_[thread], std::as_bytes(counts), levels_[thread],
                                      running ? running->add(std::as_bytes(counts))
                                              : std::span<const float>{});
  }

  void check(const pipeline::Calibration& calibration) {
    constexpr std::size_t checked_lines = 6;
    reconstruct(3, 0);
    const std::span counts{ring_.data() + 3 * b_scan_counts, b_scan_counts};
    auto running = reconstructor_.make_running_background(ring_b_scans);
    const auto background =
        running ? running->add(std::as_bytes(counts)) : std::span<const float>{};
    int differing = 0;
    for (std::size_t i = 0; i < checked_lines; ++i) {
      const std::size_t a = i * (a_scans - 1) / (checked_lines - 1);
      const auto reference = reference_levels_db(counts, a, calibration, background);
      for (std::size_t z = 0; z < reference.size(); ++z) {
        const int expected = pipeline::quantise_level(static_cast<float>(reference[z]));
        const int error = std::abs(expected - levels_[0][a * reference.size() + z]);
        differing += error > 0 ? 1 : 0;
        result_.max_count_error = std::max(result_.max_count_error, error);
      }
    }
    result_.share_differing = differing / static_cast<double>(checked_lines * samples / 2);
  }

  pipeline::Reconstructor reconstructor_;
  const std::vector<std::uint16_t>& ring_;
  std::vector<pipeline::Reconstructor::Workspace> workspaces_;
  std::vector<std::vector<std::uint8_t>> levels_;
  std::vector<std::optional<pipeline::RunningBackground>> running_;
  std::size_t next_ = 0;
  BenchResult result_;
};

hal::Result<pipeline::Reconstructor> make_reconstructor(const BenchCase& what) {
  return pipeline::Reconstructor::create(
      {.calibration = make_calibration(what),
       .format = pipeline::SpectrumFormat{samples, hal::SampleType::u16},
       .a_scans = a_scans,
       .path = what.path,
       .fused_isa = what.isa});
}

// Fused kernels of every instruction set that this processor has, and FFTW's path.
std::vector<BenchCase> all_cases() {
  std::vector<BenchCase> cases;
  for (const char* isa : {"AVX3", "AVX2", "SSE4", "NEON", ""}) {
    const bool fused = std::strlen(isa) > 0;
    BenchCase what{.path = fused ? ReconstructionPath::fused : ReconstructionPath::fftw,
                   .isa = isa};
    const auto reconstructor = make_reconstructor(what);
    if (!reconstructor || reconstructor->path() != what.path)
      continue;
    for (const auto interpolation :
         {Interpolation::sinc8, Interpolation::cubic, Interpolation::linear})
      for (const auto& [dispersion, background] : {std::pair{true, BackgroundMode::file},
                                                   {true, BackgroundMode::running},
                                                   {true, BackgroundMode::mean},
                                                   {false, BackgroundMode::file}})
        for (const int threads : {1, 2}) {
          what.interpolation = interpolation;
          what.dispersion = dispersion;
          what.background = background;
          what.threads = threads;
          cases.push_back(what);
        }
  }
  return cases;
}

} // namespace

hal::Result<BenchReport> bench_reconstruct(double seconds) {
  const std::vector<std::uint16_t> ring = make_ring();
  BareTransform bare;
  BenchReport report;
  report.cpu = processor_name();
  report.ring_mb = static_cast<double>(ring.size() * sizeof ring[0]) / 1e6;
  const std::vector<BenchCase> cases = all_cases();
  std::vector<double> bare_seconds;
  for (const BenchCase& what : cases) {
    HAL_TRY(auto reconstructor, make_reconstructor(what));
    report.cases.push_back(CaseBench{what, std::move(reconstructor), ring}.measure(
        bare, seconds / static_cast<double>(cases.size()), bare_seconds));
  }
  report.fftw_c2c_ns = 1e9 * quantile(bare_seconds, 0.5);
  return report;
}

} // namespace octascope::firmware_host

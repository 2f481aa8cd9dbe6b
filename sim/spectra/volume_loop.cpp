#include "sim/spectra/volume_loop.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace octascope::sim {
namespace {

constexpr int most_volumes = 255; // a place of the ring fits in 8 bits

// Nearly only cycles that nobody else wants; the pipeline's threads come first. Not SCHED_IDLE: a
// renderer in software can keep all cores busy, and the loop would never grow. Where the system
// says no, the work is merely less polite.
void yield_to_everybody() {
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 19);
}

} // namespace

hal::Result<> VolumeLoopConfig::validate() const {
  HAL_CHECK(plan.validate());
  if (volumes < 1 || volumes > most_volumes)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "volume loop: volumes is {}, expected 1 to {}", volumes, most_volumes);
  if (!(galvo_lag_us >= 0 && galvo_lag_us <= 1e6))
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "volume loop: galvo_lag_us is {}, expected 0 to 1e6", galvo_lag_us);
  HAL_CHECK(motion.validate());
  SpectrometerConfig with_plan = spectrometer;
  with_plan.samples = plan.samples;
  return with_plan.validate();
}

// Phantoms are laid out in millimetres of tissue.
constexpr double tissue_refractive_index = 1.38;

hal::Result<VolumeLoopConfig> suggested_loop(std::string_view phantom) {
  return make_phantom(phantom, 1).map([&](const std::unique_ptr<Phantom>& made) {
    VolumeLoopConfig config;
    config.phantom = phantom;
    config.plan = made->suggested_plan();
    config.plan.refractive_index = tissue_refractive_index;
    return config;
  });
}

// One thread's tools for making lines.
class VolumeLoop::LineMaker {
public:
  explicit LineMaker(const VolumeLoop& loop)
      : loop_(loop), workspace_(loop.synthesis_.make_workspace()),
        profile_(loop.profiles_.make_profile()),
        mean_(static_cast<std::size_t>(loop.config_.plan.samples)) {}

  void make(int volume, int sweep, int line, std::span<std::uint16_t> counts) {
    const pipeline::ScanPlan& plan = loop_.config_.plan;
    BeamPlace place = loop_.beam_path_.at(sweep, line);
    const double in_volume =
        (sweep + static_cast<double>(line) / plan.lines_per_frame()) / plan.sweeps();
    const Visit visit = visit_of(volume, sweep, line);
    const double t_s =
        (static_cast<double>(visit.number) * plan.lines_per_frame() + line) / plan.line_rate_hz;
    const TissueMotion& motion = loop_.config_.motion;
    place.x_mm -= static_cast<float>(motion.lateral_um(t_s) * 1e-3);
    const double deeper_um = motion.axial_um(t_s);
    loop_.phantom_->fill(column_, (volume + in_volume) / loop_.config_.volumes, place.x_mm,
                         place.y_mm);
    loop_.profiles_.fill(profile_, column_, place.x_mm, place.y_mm, visit);
    loop_.synthesis_.mean_counts(
        profile_.scatterers, profile_.surfaces, workspace_, mean_,
        {deeper_um / plan.depth_spacing_um, phase_rad_per_mm * deeper_um * 1e-3});
    loop_.synthesis_.expose(
        mean_, hash(loop_.config_.seed, visit.number, static_cast<std::uint64_t>(line)), counts);
  }

private:
  Visit visit_of(int volume, int sweep, int line) const {
    const pipeline::ScanPlan& plan = loop_.config_.plan;
    const BeamPath& path = loop_.beam_path_;
    Visit visit{.number = static_cast<std::uint64_t>(volume * plan.sweeps() + sweep),
                .repeat = sweep % plan.repeats,
                .repeats = plan.repeats};
    const double a_scan = path.a_scan_at(sweep, line);
    for (int repeat = 0; repeat <= visit.repeat; ++repeat) {
      double met = line; // in that repeat, at the same place
      if (plan.bidirectional)
        met = path.lag_lines() + (plan.runs_backwards(sweep - visit.repeat + repeat)
                                      ? plan.a_scans - 1 - a_scan
                                      : a_scan);
      visit.times_s[static_cast<std::size_t>(repeat)] =
          (repeat * static_cast<double>(plan.lines_per_frame()) + met) / plan.line_rate_hz;
    }
    return visit;
  }

  const VolumeLoop& loop_;
  Column column_;
  SpectrumSynthesis::Workspace workspace_;
  ProfileMaker::Profile profile_;
  std::vector<float> mean_;
};

hal::Result<std::unique_ptr<VolumeLoop>> VolumeLoop::make(const VolumeLoopConfig& config) {
  HAL_CHECK(config.validate());
  HAL_TRY(auto phantom, make_phantom(config.phantom, config.seed));
  VolumeLoopConfig complete = config;
  complete.spectrometer.samples = config.plan.samples;
  HAL_TRY(const auto spectrometer, Spectrometer::make(complete.spectrometer));
  std::unique_ptr<VolumeLoop> loop(new VolumeLoop(complete, spectrometer, std::move(phantom)));
  loop->make_first_volume();
  if (config.volumes > 1)
    loop->background_ = std::jthread(
        [loop = loop.get()](const std::stop_token& stop) { loop->make_further_volumes(stop); });
  return loop;
}

VolumeLoop::VolumeLoop(const VolumeLoopConfig& config, const Spectrometer& spectrometer,
                       std::unique_ptr<Phantom> phantom)
    : config_(config), spectrometer_(spectrometer), phantom_(std::move(phantom)),
      beam_path_(config.plan, config.galvo_lag_us * 1e-6 * config.plan.line_rate_hz),
      synthesis_(spectrometer_), profiles_(config.plan.geometry(), hash(config.seed, 0x7155)),
      ring_(static_cast<std::size_t>(config.volumes)) {
  format_.samples_per_line = config.plan.samples;
  format_.lines_per_frame = config.plan.lines_per_frame();
  format_.significant_bits = config.spectrometer.significant_bits;
}

VolumeLoop::~VolumeLoop() = default;

std::size_t VolumeLoop::samples_per_frame() const {
  return static_cast<std::size_t>(format_.lines_per_frame) *
         static_cast<std::size_t>(format_.samples_per_line);
}

void VolumeLoop::make_first_volume() {
  const int sweeps = config_.plan.sweeps();
  const auto samples = static_cast<std::size_t>(config_.plan.samples);
  ring_[0] = std::make_unique_for_overwrite<std::uint16_t[]>(samples_per_frame() *
                                                             static_cast<std::size_t>(sweeps));
  std::atomic<int> next{0};
  const auto work = [&] {
    LineMaker maker(*this);
    for (int sweep = next++; sweep < sweeps; sweep = next++) {
      std::uint16_t* frame = ring_[0].get() + samples_per_frame() * static_cast<std::size_t>(sweep);
      for (int line = 0; line < format_.lines_per_frame; ++line)
        maker.make(0, sweep, line, {frame + samples * static_cast<std::size_t>(line), samples});
    }
  };
  const int cores = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
  {
    std::vector<std::jthread> helpers;
    for (int i = 1; i < std::min(cores, sweeps); ++i)
      helpers.emplace_back(work);
    work();
  }
  ready_.store(1, std::memory_order_release);
}

void VolumeLoop::make_further_volumes(const std::stop_token& stop) {
  yield_to_everybody();
  LineMaker maker(*this);
  const auto samples = static_cast<std::size_t>(config_.plan.samples);
  for (int volume = 1; volume < config_.volumes; ++volume) {
    auto& counts = ring_[static_cast<std::size_t>(volume)];
    counts = std::make_unique_for_overwrite<std::uint16_t[]>(
        samples_per_frame() * static_cast<std::size_t>(config_.plan.sweeps()));
    std::uint16_t* at = counts.get();
    for (int sweep = 0; sweep < config_.plan.sweeps(); ++sweep) {
      for (int line = 0; line < format_.lines_per_frame; ++line, at += samples) {
        if (stop.stop_requested())
          return;
        maker.make(volume, sweep, line, {at, samples});
      }
    }
    ready_.store(volume + 1, std::memory_order_release);
  }
}

int VolumeLoop::place_of(std::uint64_t volume) const {
  // While the ring grows, places shift from one volume to the next, but not inside of one.
  std::uint64_t served = served_.load(std::memory_order_acquire);
  if (served >> 8U == volume + 1)
    return static_cast<int>(served & 255U);
  const int ready = ready_volumes();
  const std::uint64_t place = volume % static_cast<std::uint64_t>(ready);
  if (ready < config_.volumes &&
      !served_.compare_exchange_strong(served, ((volume + 1) << 8U) | place,
                                       std::memory_order_acq_rel) &&
      served >> 8U == volume + 1)
    return static_cast<int>(served & 255U);
  return static_cast<int>(place);
}

std::span<const std::byte> VolumeLoop::frame(std::uint64_t volume, int sweep) const {
  const std::uint16_t* counts = ring_[static_cast<std::size_t>(place_of(volume))].get();
  return std::as_bytes(std::span{counts + samples_per_frame() * static_cast<std::size_t>(sweep),
                                 samples_per_frame()});
}

int VolumeLoop::alike_every() const {
  const pipeline::ScanPlan& plan = config_.plan;
  // With an odd number of repeats a B-scan begins in the other direction than the one before.
  return plan.bidirectional && plan.repeats % 2 != 0 ? 2 * plan.repeats : plan.repeats;
}

hal::Duration VolumeLoop::loop_duration() const {
  return config_.plan.sweep_duration() * config_.volumes;
}

std::string VolumeLoop::description() const {
  return fmt::format("{}, loop of {} volume{}, {:.2f} s", phantom_->title(), config_.volumes,
                     config_.volumes == 1 ? "" : "s", hal::to_seconds(loop_duration()));
}

} // namespace octascope::sim

#include "pipeline/angiography/b_scan_flow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace octascope::pipeline {

namespace {

constexpr int margin = kernel_depths / 2;

std::size_t size(int count) {
  return static_cast<std::size_t>(count);
}

} // namespace

hal::Result<BScanFlow> BScanFlow::create(const FlowSetup& setup) {
  if (setup.repeats < fewest_repeats || setup.repeats > most_repeats)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "{} repeats of each B-scan, expected {} to {}", setup.repeats, fewest_repeats,
                     most_repeats);
  if (setup.a_scans < 1 || setup.depths < 1)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "{} A-scans of {} depths, expected at least one of each", setup.a_scans,
                     setup.depths);
  return BScanFlow{setup};
}

BScanFlow::BScanFlow(const FlowSetup& setup)
    : setup_(setup), voxels_(size(setup.a_scans) * size(setup.depths)),
      motion_(setup.a_scans, setup.depths),
      tissue_(setup.method, setup.a_scans, setup.depths, setup.repeats),
      scratch_(2 * size(setup.depths)), scale_(size(setup.depths)),
      depth_weights_(size(setup.depths)), level_(voxels_),
      second_moment_(setup.method == FlowMethod::intensity ? voxels_ : 0) {
  for (Repeat& repeat : repeats_)
    repeat.real.resize(size(setup.depths)), repeat.imaginary.resize(size(setup.depths));
  for (LineSums& line : ring_)
    for (auto* const part : {&line.like, &line.other, &line.power})
      part->resize(size(setup.depths));
  for (auto& column : columns_)
    column.resize(size(setup.depths + 2 * margin));
  for (int z = 0; z < setup.depths; ++z) {
    const int within = std::min(z + margin, setup.depths - 1) - std::max(z - margin, 0) + 1;
    depth_weights_[size(z)] = 1.0F / static_cast<float>(within);
  }
}

FlowOutcome BScanFlow::compute(std::span<const PackedBin> bins, std::span<float> flow,
                               std::span<float> decorrelation) noexcept {
  FlowOutcome outcome;
  coherence_ = motion_.coherence(bins.data());
  find_motion(bins, outcome);
  decorrelate(bins, decorrelation);
  const KernelPlanes planes{decorrelation, level_, second_moment_};
  tissue_.measure(planes, coherence_.independent_samples(kernel_depths));
  outcome.static_decorrelation = tissue_.static_decorrelation();
  // One of several repeats may have nothing in common with the others, which are alike.
  outcome.left_out = tissue_.incoherent() || (tissue_.is_lit() && !outcome.largest_motion.found);
  if (outcome.left_out || !tissue_.is_lit())
    std::fill(flow.begin(), flow.end(), std::numeric_limits<float>::quiet_NaN());
  else
    tissue_.classify(planes, flow);
  return outcome;
}

// Each against the one before, so that what changes slowly is still alike; shifts add up.
void BScanFlow::find_motion(std::span<const PackedBin> bins, FlowOutcome& outcome) noexcept {
  BulkMotion sum;
  for (int m = 1; m < setup_.repeats; ++m) {
    const auto* const before = bins.data() + size(m - 1) * voxels_;
    const BulkMotion motion = motion_.estimate(before, before + voxels_);
    outcome.largest_motion.found &= motion.found;
    if (std::abs(motion.axial_bins) > std::abs(outcome.largest_motion.axial_bins))
      outcome.largest_motion.axial_bins = motion.axial_bins;
    if (std::abs(motion.lateral_a_scans) > std::abs(outcome.largest_motion.lateral_a_scans))
      outcome.largest_motion.lateral_a_scans = motion.lateral_a_scans;
    sum.axial_bins += motion.axial_bins;
    sum.lateral_a_scans += motion.lateral_a_scans;
    repeats_[size(m)].shift = FractionalShift::by(sum.axial_bins, coherence_);
    repeats_[size(m)].lateral = sum.lateral_a_scans;
  }
}

void BScanFlow::sum_line(std::span<const PackedBin> bins, int a, LineSums& sums) noexcept {
  for (auto* const part : {&sums.like, &sums.other, &sums.power})
    std::fill(part->begin(), part->end(), 0.0F);
  sums.pairs = 0;
  const int depths = setup_.depths;
  bool before_is_there = false;
  for (int m = 0; m < setup_.repeats; ++m) {
    Repeat& repeat = repeats_[size(m)];
    const int from = a + repeat.lateral;
    const bool is_there = from >= 0 && from < setup_.a_scans;
    const int begin = repeat.shift.first(depths);
    const int end = repeat.shift.last(depths);
    if (is_there && from + 1 < setup_.a_scans)
      fetch_line(bins.data() + size(m) * voxels_ + size(from + 1) * size(depths), depths);
    if (is_there)
      repeat.shift.apply(bins.data() + size(m) * voxels_ + size(from) * size(depths), begin, end,
                         repeat.real.data(), repeat.imaginary.data());
    if (is_there && before_is_there) {
      const Repeat& other = repeats_[size(m - 1)];
      const int first = std::max(begin, other.shift.first(depths));
      const int last = std::max(first, std::min(end, other.shift.last(depths)));
      const Parts one{other.real.data(), other.imaginary.data()};
      const Parts two{repeat.real.data(), repeat.imaginary.data()};
      const PairSums out{sums.like.data(), sums.other.data(), sums.power.data()};
      if (setup_.method == FlowMethod::complex_bins)
        add_complex_pair(one, two, first, last, out, scratch_.data());
      else
        add_intensity_pair(one, two, first, last, out);
      ++sums.pairs;
    }
    before_is_there = is_there;
  }
}

// From the A-scans around this one, which the ring has.
void BScanFlow::finish_line(int a, std::span<float> decorrelation) noexcept {
  const int first = std::max(0, a - kernel_a_scans / 2);
  const int last = std::min(setup_.a_scans - 1, a + kernel_a_scans / 2);
  std::array<std::array<const float*, kernel_a_scans>, 3> lines{};
  float pairs = 0;
  for (int i = first; i <= last; ++i) {
    const LineSums& line = ring_[size(i % kernel_a_scans)];
    lines[0][size(i - first)] = line.like.data();
    lines[1][size(i - first)] = line.other.data();
    lines[2][size(i - first)] = line.power.data();
    pairs += line.pairs;
  }
  for (std::size_t part = 0; part < lines.size(); ++part)
    add_lines(lines[part].data(), last - first + 1, setup_.depths, columns_[part].data() + margin);
  const float weight = pairs > 0 ? 1 / pairs : 0.0F;
  for (std::size_t z = 0; z < scale_.size(); ++z)
    scale_[z] = depth_weights_[z] * weight;
  const PairSums sums{columns_[0].data() + margin, columns_[1].data() + margin,
                      columns_[2].data() + margin};
  const std::size_t at = size(a) * size(setup_.depths);
  if (setup_.method == FlowMethod::complex_bins)
    finish_complex(sums, scale_.data(), setup_.depths, decorrelation.data() + at,
                   level_.data() + at);
  else
    finish_intensity(sums, scale_.data(), setup_.depths, decorrelation.data() + at,
                     level_.data() + at, second_moment_.data() + at);
}

void BScanFlow::decorrelate(std::span<const PackedBin> bins,
                            std::span<float> decorrelation) noexcept {
  for (int a = 0; a < setup_.a_scans; ++a) {
    sum_line(bins, a, ring_[size(a % kernel_a_scans)]);
    if (a > 0)
      finish_line(a - 1, decorrelation);
  }
  finish_line(setup_.a_scans - 1, decorrelation);
}

} // namespace octascope::pipeline

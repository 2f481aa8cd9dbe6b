#include "firmware-host/commands/bench/flow/voxel_truth.h"

#include <algorithm>
#include <cmath>

namespace octascope::firmware_host {

namespace {

// Of the box that the signal is averaged over, to either side.
constexpr std::size_t a_reach = 7;
constexpr std::size_t z_reach = 4;
constexpr double least_signal = 2; // over the noise: 3 dB
// Bins that are neither taken for noise nor for tissue: around zero delay; above the surface, whose
// reflex is wider than a bin; and below it.
constexpr std::size_t blank_bins = 16;
constexpr std::size_t above_surface = 12;
constexpr std::size_t below_surface = 2;

float at(std::span<const float> values, double place) {
  if (place < 0 || place > static_cast<double>(values.size() - 1))
    return 0;
  const auto before = static_cast<std::size_t>(place);
  const std::size_t after = std::min(before + 1, values.size() - 1);
  const auto part = static_cast<float>(place - static_cast<double>(before));
  return values[before] + part * (values[after] - values[before]);
}

} // namespace

VoxelTruth::VoxelTruth(const sim::RepeatedSweeps& sweeps, const sim::TissueMotion& motion)
    : sweeps_(sweeps), motion_(motion),
      depths_(static_cast<std::size_t>(sweeps.plan().geometry().depths)),
      a_scans_(static_cast<std::size_t>(sweeps.plan().a_scans)), kinds_(depths_ * a_scans_),
      radii_um_(kinds_.size()), surfaces_(a_scans_), power_(kinds_.size()),
      sums_((a_scans_ + 1) * (depths_ + 1)) {}

void VoxelTruth::look_at(int b, std::span<const pipeline::PackedBin> bins) {
  for (int a = 0; a < sweeps_.plan().a_scans; ++a)
    place_a_scan(b, a);
  average_power(bins);
  const double least_power = (1 + least_signal) * noise_power();
  for (std::size_t a = 0; a < a_scans_; ++a)
    for (std::size_t z = 0; z < depths_; ++z) {
      const std::size_t a0 = a < a_reach ? 0 : a - a_reach;
      const std::size_t a1 = std::min(a + a_reach + 1, a_scans_);
      const std::size_t z0 = z < z_reach ? 0 : z - z_reach;
      const std::size_t z1 = std::min(z + z_reach + 1, depths_);
      const std::size_t row = depths_ + 1;
      const double sum =
          sums_[a1 * row + z1] - sums_[a0 * row + z1] - sums_[a1 * row + z0] + sums_[a0 * row + z0];
      if (sum < least_power * static_cast<double>((a1 - a0) * (z1 - z0)))
        kinds_[a * depths_ + z] = VoxelKind::left_out;
    }
}

// Truth is of tissue that does not move (flow_truth.h).
void VoxelTruth::place_a_scan(int b, int a) {
  const pipeline::ScanPlan& plan = sweeps_.plan();
  const auto place_mm = [](int index, int count, double spacing_um) {
    return static_cast<float>((index - (count - 1) / 2.0) * spacing_um * 1e-3);
  };
  sweeps_.loop->phantom().fill(column_, 0, place_mm(a, plan.a_scans, plan.a_spacing_um),
                               place_mm(b, plan.b_scans, plan.b_spacing_um));
  const double first_line = static_cast<double>(b * plan.repeats) * plan.lines_per_frame();
  const double deeper_um = motion_.axial_um((first_line + a) / plan.line_rate_hz);
  const auto bin_of = [&](float depth_mm) {
    return (double{depth_mm} * 1e3 + deeper_um) / plan.depth_spacing_um;
  };
  const std::size_t line = static_cast<std::size_t>(a) * depths_;
  const double surface = column_.surfaces().empty() ? static_cast<double>(depths_)
                                                    : bin_of(column_.surfaces()[0].depth_mm);
  const std::size_t first = std::min(static_cast<std::size_t>(std::max(surface, 0.0)), depths_);
  surfaces_[static_cast<std::size_t>(a)] = first;
  const auto truth = std::span{sweeps_.flow}.subspan(
      static_cast<std::size_t>(b) * a_scans_ * depths_ + line, depths_);
  for (std::size_t z = 0; z < depths_; ++z) {
    const float share = at(truth, static_cast<double>(z) - deeper_um / plan.depth_spacing_um);
    VoxelKind kind = share >= 0.5F ? VoxelKind::flowing : VoxelKind::left_out;
    if (share <= 0)
      kind = VoxelKind::still;
    kinds_[line + z] = z < first + below_surface ? VoxelKind::left_out : kind;
  }
  std::fill_n(radii_um_.begin() + static_cast<std::ptrdiff_t>(line), depths_, 0.0F);
  for (const sim::Layer& layer : column_.layers()) {
    if (!layer.flowing)
      continue;
    const double top = std::max(bin_of(layer.top_mm) - 0.5, 0.0);
    const double bottom = std::min(bin_of(layer.bottom_mm) + 0.5, static_cast<double>(depths_) - 1);
    for (auto z = static_cast<std::size_t>(top); static_cast<double>(z) <= bottom; ++z)
      radii_um_[line + z] = std::max(radii_um_[line + z], layer.flow.radius_mm * 1e3F);
  }
}

void VoxelTruth::average_power(std::span<const pipeline::PackedBin> bins) {
  const auto repeats = static_cast<std::size_t>(sweeps_.plan().repeats);
  std::ranges::fill(power_, 0.0F);
  for (std::size_t i = 0; i < bins.size(); ++i)
    power_[i % power_.size()] += std::norm(bins[i].value()) / static_cast<float>(repeats);
  const std::size_t row = depths_ + 1;
  for (std::size_t a = 0; a < a_scans_; ++a) {
    double along = 0;
    for (std::size_t z = 0; z < depths_; ++z) {
      along += static_cast<double>(power_[a * depths_ + z]);
      sums_[(a + 1) * row + z + 1] = sums_[a * row + z + 1] + along;
    }
  }
}

double VoxelTruth::noise_power() const {
  double sum = 0;
  double count = 0;
  for (std::size_t a = 0; a < a_scans_; ++a)
    for (std::size_t z = blank_bins; z + above_surface < surfaces_[a]; ++z) {
      sum += static_cast<double>(power_[a * depths_ + z]);
      count += 1;
    }
  return count > 0 ? sum / count : 0;
}

} // namespace octascope::firmware_host

#include "pipeline/reconstruction/fused/fused_path.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

namespace octascope::pipeline {

namespace {

// The raw data come from memory: the line after next is fetched while this one is computed.
constexpr int lines_ahead = 2;

// Σ w·(s − b) fits into 32 bits for every count s.
bool fits_fixed_point(const FusedTables& tables, const Calibration& calibration) {
  double lowest = 0;
  double highest = 65535;
  if (calibration.background_mode == BackgroundMode::file)
    for (const float value : calibration.background) {
      lowest = std::min(lowest, static_cast<double>(value));
      highest = std::max(highest, static_cast<double>(value));
    }
  const double farthest = std::max(65535 - lowest, highest);
  const auto width = static_cast<std::size_t>(2 * tables.tap_pairs);
  for (std::size_t m = 0; m < tables.tap_starts.size(); ++m) {
    double weights = 0;
    for (std::size_t t = 0; t < width; ++t)
      weights += std::abs(static_cast<double>(tables.tap_weights[m * width + t]));
    if (weights * farthest >= std::numeric_limits<std::int32_t>::max())
      return false;
  }
  return true;
}

} // namespace

FusedPath::FusedPath(FusedTables tables, const FusedKernels& kernels, RawKind kind)
    : tables_(std::move(tables)), kernels_(&kernels), kind_(kind) {
  const auto pairs =
      static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(tables_.tap_pairs)));
  first_pass_ = kernels.first_pass[static_cast<std::size_t>(kind)][pairs]
                                  [tables_.one_window ? 1 : 0][tables_.real_input ? 1 : 0];
}

std::optional<FusedPath> FusedPath::make(const Calibration& calibration, int bytes_per_sample,
                                         int right_shift, std::string_view isa) {
  const FusedKernels* kernels = fused_kernels(calibration.samples, isa);
  if (kernels == nullptr || bytes_per_sample > 2 || (bytes_per_sample == 1 && right_shift > 0))
    return std::nullopt;
  auto tables = make_fused_tables(calibration, right_shift, kernels->window);
  if (!tables || !fits_fixed_point(*tables, calibration))
    return std::nullopt;
  const RawKind kind = bytes_per_sample == 1 ? RawKind::u8
                       : right_shift > 0     ? RawKind::u16_shifted
                                             : RawKind::u16;
  return FusedPath{std::move(*tables), *kernels, kind};
}

FusedPath::Buffers FusedPath::make_buffers() const {
  const auto samples = static_cast<std::size_t>(tables_.samples);
  return {AlignedVector<float>(work_floats(tables_.samples)), AlignedVector<std::int32_t>(samples)};
}

void FusedPath::set_background(const float* background, Buffers& buffers) const noexcept {
  tables_.resample_background(background, raw_offset(kind_), buffers.background.data());
}

void FusedPath::finish(float* work, std::uint8_t* levels) const noexcept {
  kernels_->finish_u8(tables_, work, levels);
}
void FusedPath::finish(float* work, float* levels_db) const noexcept {
  kernels_->finish_db(tables_, work, levels_db);
}
void FusedPath::finish(float* work, const BinsAndLevels& both) const noexcept {
  kernels_->finish_both(tables_, work, both);
}

template <class Levels>
int FusedPath::reconstruct(const std::byte* counts, int lines, std::uint32_t full_scale,
                           Buffers& buffers, Levels levels,
                           std::uint8_t* saturated) const noexcept {
  const auto samples = static_cast<std::size_t>(tables_.samples);
  const std::size_t line_bytes = samples * (kind_ == RawKind::u8 ? 1 : 2);
  int saturated_lines = 0;
  for (int a = 0; a < lines; ++a) {
    const std::byte* line = counts + static_cast<std::size_t>(a) * line_bytes;
    const std::byte* next =
        counts + static_cast<std::size_t>(std::min(a + lines_ahead, lines - 1)) * line_bytes;
    const bool reached = first_pass_(tables_, line, next, full_scale << tables_.right_shift,
                                     buffers.background.data(), buffers.work.data());
    saturated[a] = reached ? 1 : 0;
    saturated_lines += saturated[a];
    finish(buffers.work.data(), levels + std::ptrdiff_t{a} * (tables_.samples / 2));
  }
  return saturated_lines;
}

template int FusedPath::reconstruct(const std::byte*, int, std::uint32_t, Buffers&, std::uint8_t*,
                                    std::uint8_t*) const noexcept;
template int FusedPath::reconstruct(const std::byte*, int, std::uint32_t, Buffers&, float*,
                                    std::uint8_t*) const noexcept;

template int FusedPath::reconstruct(const std::byte*, int, std::uint32_t, Buffers&, BinsAndLevels,
                                    std::uint8_t*) const noexcept;

} // namespace octascope::pipeline

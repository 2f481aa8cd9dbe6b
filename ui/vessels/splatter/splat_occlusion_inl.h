// Dims the pixels that nearer ones surround (occlusion_field.h). For one instruction set; see
// splat_kernels.h.
#if defined(OCTASCOPE_SPLAT_OCCLUSION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_SPLAT_OCCLUSION_INL
#undef OCTASCOPE_SPLAT_OCCLUSION_INL
#else
#define OCTASCOPE_SPLAT_OCCLUSION_INL
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ui/vessels/splatter/splat_fragments_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {
namespace splat {

inline constexpr int occlusion_block = 256; // pixels of a row at a time

class OcclusionLight {
public:
  explicit OcclusionLight(const SplatFrame& frame) : frame_{frame} {}

  bool occluded() const { return frame_.occlusion.coverage != nullptr; }

  // For `count` pixels of the row, from `left` on, where a cell begins; it may be negative.
  void find(int left, int y, std::size_t count) {
    const OcclusionMoments& m = frame_.occlusion;
    // Between the middles of cells.
    const float row = (static_cast<float>(y) - 0.5F * (occlusion_cell - 1)) / occlusion_cell;
    const int upper = static_cast<int>(std::floor(row));
    const float share = row - static_cast<float>(upper);
    const auto line = [&](const float* plane, int at) {
      return plane + static_cast<std::ptrdiff_t>(std::clamp(at, 0, m.rows - 1)) * m.columns;
    };
    const int first = (left - occlusion_cell) / occlusion_cell;
    const int cells = static_cast<int>((count + occlusion_cell - 1) / occlusion_cell);
    const float* planes[] = {m.coverage, m.distance, m.square};
    for (std::size_t k = 0; k < 3; ++k) {
      const float* above = line(planes[k], upper);
      const float* below = line(planes[k], upper + 1);
      float cell[room / occlusion_cell + 2];
      for (int i = 0; i < cells + 2; ++i) {
        const int column = std::clamp(first + i, 0, m.columns - 1);
        cell[i] = above[column] + share * (below[column] - above[column]);
      }
      float* to = moments_[k];
      for (int i = 0; i < cells; ++i, to += occlusion_cell) {
        to[0] = 0.375F * cell[i] + 0.625F * cell[i + 1];
        to[1] = 0.125F * cell[i] + 0.875F * cell[i + 1];
        to[2] = 0.875F * cell[i + 1] + 0.125F * cell[i + 2];
        to[3] = 0.625F * cell[i + 1] + 0.375F * cell[i + 2];
      }
    }
  }

  // The pixels from the i-th on: their colour and distance.
  HWY_INLINE Word dimmed(std::size_t i, Word colour, Word distance) const {
    const Real mm = hn::BitCast(Floats{}, distance);
    const Real coverage = hn::Load(Floats{}, moments_[0] + i);
    const Real inverse = hn::Div(real(1), hn::Max(coverage, real(1e-4F)));
    const Real mean = hn::Mul(hn::Load(Floats{}, moments_[1] + i), inverse);
    const Real square = hn::Mul(hn::Load(Floats{}, moments_[2] + i), inverse);
    const Real variance = hn::Max(hn::NegMulAdd(mean, mean, square), real(0));
    const Real behind =
        hn::Max(hn::Sub(hn::Sub(mm, real(frame_.occlusion.origin_mm)), mean), real(0));
    // Not by less than the surroundings are wide: a vessel's own slope is no occlusion.
    const Real reach = hn::Mul(mm, real(occlusion_reach_px / frame_.pixels_per_unit));
    const Real behind2 = hn::Mul(behind, behind);
    const Real total = hn::MulAdd(reach, reach, hn::Add(behind2, variance));
    const Real share = hn::Div(hn::Mul(coverage, behind2), total);
    // Nothing is infinitely far, where the share is no number.
    const Mask there = hn::Lt(mm, real(1e30F));
    const Real light = hn::IfThenElse(
        there, hn::NegMulAdd(share, real(256 * vessel_occlusion), real(256)), real(256));
    const Word weight = hn::BitCast(Words{}, hn::ConvertTo(Ints{}, light));
    const hn::Repartition<std::uint16_t, Words> halves;
    const auto weights = hn::BitCast(halves, hn::Or(weight, hn::ShiftLeft<16>(weight)));
    const auto part = [&](Word v) {
      const auto product = hn::Mul(hn::BitCast(halves, hn::And(v, word(0xFF00FF))), weights);
      return hn::BitCast(Words{}, hn::ShiftRight<8>(product));
    };
    const Word red_blue = part(colour);
    const Word green = hn::ShiftLeft<8>(hn::And(part(hn::ShiftRight<8>(colour)), word(0xFF)));
    return hn::Or(hn::Or(red_blue, green), hn::And(colour, word(0xFF000000)));
  }

private:
  static constexpr std::size_t room = occlusion_block + 3 * lanes;

  const SplatFrame& frame_;
  HWY_ALIGN float moments_[3][room];
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace splat
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

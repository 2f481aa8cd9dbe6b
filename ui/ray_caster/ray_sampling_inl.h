// Interpolates levels between voxels, and computes leaps over empty bricks. For one instruction
// set; see ray_kernels.h.
//
// Positions are in cells, fixed point with 16 fractional bits. A gather fetches the four corners of
// a cell in one B-scan. Interpolation uses 16-bit integers: 8-bit weights along the slow axis,
// 16-bit along the fast axis, 15-bit along depth. Errors stay below a thirtieth of a level along
// the fast axis and depth, and below half a 256th of the difference of two B-scans along the slow
// axis.
#if defined(OCTASCOPE_RAY_SAMPLING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_RAY_SAMPLING_INL
#undef OCTASCOPE_RAY_SAMPLING_INL
#else
#define OCTASCOPE_RAY_SAMPLING_INL
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "pipeline/volume/occupancy.h"
#include "ui/ray_caster/ray_frame.h"
#include "ui/ray_caster/step_table.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using Words = hn::Repartition<std::int16_t, Ints>;
using UnsignedWords = hn::Repartition<std::uint16_t, Ints>;
using Bytes = hn::Repartition<std::uint8_t, Ints>;
using Real = hn::Vec<Floats>;
using Int = hn::Vec<Ints>;
using RealMask = hn::Mask<Floats>;
using IntMask = hn::Mask<Ints>;

inline constexpr int lanes = static_cast<int>(HWY_LANES(float));
inline constexpr int one_cell = 1 << 16;
inline constexpr int level_shift = 22; // of what interpolate() returns
inline constexpr int entry_shift = level_shift - 4;
static_assert(TransferTable::entries_per_level == 1 << (level_shift - entry_shift));

HWY_INLINE Real real(float value) {
  return hn::Set(Floats{}, value);
}
HWY_INLINE Int whole(std::int32_t value) {
  return hn::Set(Ints{}, value);
}

// A value along depth, fast and slow axis, lane by lane.
struct RealVector {
  Real z, a, b;
};
struct Position {
  Int z, a, b;
};

// Four bytes at base + offset.
HWY_INLINE Int gather(const void* base, Int byte_offset) {
  return hn::GatherOffset(Ints{}, static_cast<const std::int32_t*>(base), byte_offset);
}

// The sum of two products of neighbouring words.
HWY_INLINE Int dot_pairs(hn::Vec<Words> a, hn::Vec<Words> b, Int start) {
#if HWY_ARCH_X86
  Int unused = hn::Zero(Ints{});
  return hn::ReorderWidenMulAccumulate(Ints{}, a, b, start, unused);
#else // elsewhere that adds up other pairs
  const Int a_both = hn::BitCast(Ints{}, a);
  const Int b_both = hn::BitCast(Ints{}, b);
  const auto low = [](Int v) { return hn::ShiftRight<16>(hn::ShiftLeft<16>(v)); };
  const auto high = [](Int v) { return hn::ShiftRight<16>(v); };
  return hn::Add(hn::Add(start, hn::Mul(low(a_both), low(b_both))),
                 hn::Mul(high(a_both), high(b_both)));
#endif
}

// The fraction's upper byte, or both bytes, in each half of the lane.
HWY_INLINE hn::Vec<UnsignedWords> upper_byte_twice(Int fixed) {
  alignas(16) static constexpr std::uint8_t order[16] = {1, 0x80, 1, 0x80, 5,  0x80, 5,  0x80,
                                                         9, 0x80, 9, 0x80, 13, 0x80, 13, 0x80};
  return hn::BitCast(UnsignedWords{}, hn::TableLookupBytesOr0(hn::BitCast(Bytes{}, fixed),
                                                              hn::LoadDup128(Bytes{}, order)));
}
HWY_INLINE hn::Vec<UnsignedWords> fraction_twice(Int fixed) {
  alignas(16) static constexpr std::uint8_t order[16] = {0, 1, 0, 1, 4,  5,  4,  5,
                                                         8, 9, 8, 9, 12, 13, 12, 13};
  return hn::BitCast(UnsignedWords{}, hn::TableLookupBytes(hn::BitCast(Bytes{}, fixed),
                                                           hn::LoadDup128(Bytes{}, order)));
}

// The eight corners of each lane's cell, and the sample's position in it.
struct Cell {
  Int near, far; // one B-scan and the next: [depth][fast]
  hn::Vec<UnsignedWords> to_far, to_second, below;
};

// Of the lanes' cells, in bytes; of those that are not `valid`, of the first one.
HWY_INLINE Int cell_offset(const RayFrame& frame, const Position& p, IntMask valid) {
  const Int offset = hn::Add(hn::Add(hn::Mul(hn::ShiftRight<16>(p.b), whole(frame.row_bytes)),
                                     hn::Mul(hn::ShiftRight<16>(p.a), whole(frame.column_bytes))),
                             hn::And(hn::ShiftRight<15>(p.z), whole(-2)));
  return hn::IfThenElseZero(valid, offset);
}

// The processor fetches them while it does something else.
HWY_INLINE void prefetch_cells(const RayFrame& frame, const Position& p, IntMask valid) {
  alignas(64) std::int32_t offsets[lanes];
  hn::Store(cell_offset(frame, p, valid), Ints{}, offsets);
  for (const std::int32_t offset : offsets) {
    __builtin_prefetch(frame.cells + offset);
    __builtin_prefetch(frame.cells + offset + frame.row_bytes);
  }
}

HWY_INLINE Cell fetch_cell(const RayFrame& frame, const Position& p, IntMask valid) {
  const Int at = cell_offset(frame, p, valid);
  return {gather(frame.cells, at), gather(frame.cells + frame.row_bytes, at), upper_byte_twice(p.b),
          fraction_twice(p.a), hn::ShiftRight<1>(fraction_twice(p.z))};
}

// The A-scans at a cell's edges, in bytes from the first one: those of one B-scan and of the next.
struct Edges {
  Int near_first, near_second, far_first, far_second;
};
HWY_INLINE Edges flow_edges(const RayFrame& frame, const Position& p, IntMask valid) {
  const auto either_side = [&](Int position, int last, int stride, Int& before,
                               Int& after) HWY_ATTR {
    const Int cell = hn::IfThenElseZero(valid, hn::ShiftRight<16>(position));
    before = hn::Mul(hn::Max(hn::Sub(cell, whole(1)), whole(0)), whole(stride));
    after = hn::Mul(hn::Min(cell, whole(last)), whole(stride));
  };
  Int first, second, near, far;
  either_side(p.a, frame.last_a, frame.flow_column, first, second);
  either_side(p.b, frame.last_b, frame.flow_slab, near, far);
  const Int z = hn::IfThenElseZero(valid, hn::ShiftRight<16>(p.z));
  near = hn::Add(near, z);
  far = hn::Add(far, z);
  return {hn::Add(near, first), hn::Add(near, second), hn::Add(far, first), hn::Add(far, second)};
}

// The first two bytes of each, in turns.
HWY_INLINE Int interleave_bytes(Int first, Int second) {
  const auto apart = [](Int v) HWY_ATTR {
    return hn::Or(hn::And(v, whole(0xFF)), hn::And(hn::ShiftLeft<8>(v), whole(0xFF'0000)));
  };
  return hn::Or(apart(first), hn::ShiftLeft<8>(apart(second)));
}

// The same of what flows.
HWY_INLINE Cell fetch_flow(const RayFrame& frame, const Position& p, IntMask valid) {
  const Edges at = flow_edges(frame, p, valid);
  return {interleave_bytes(gather(frame.flow, at.near_first), gather(frame.flow, at.near_second)),
          interleave_bytes(gather(frame.flow, at.far_first), gather(frame.flow, at.far_second)),
          upper_byte_twice(p.b), fraction_twice(p.a), hn::ShiftRight<1>(fraction_twice(p.z))};
}

// Of those lanes the ones in whose cell something may be seen to flow.
HWY_INLINE IntMask flows_at(const RayFrame& frame, const Position& p, IntMask among) {
  const Int word = hn::Add(hn::Add(hn::Mul(hn::ShiftRight<16>(p.b), whole(frame.mark_slab)),
                                   hn::Mul(hn::ShiftRight<18>(p.a), whole(frame.mark_row))),
                           hn::ShiftRight<19>(p.z));
  const Int marks = gather(frame.flow_marks, hn::ShiftLeft<2>(hn::IfThenElseZero(among, word)));
  const Int bit = hn::Or(hn::And(hn::ShiftRight<13>(p.a), whole(3 << 3)),
                         hn::And(hn::ShiftRight<16>(p.z), whole(7)));
  return hn::And(among, hn::TestBit(marks, hn::Shl(whole(1), bit)));
}

// The interpolated level times 2^22, rounded up by half an entry of the transfer table.
HWY_INLINE Int interpolate(const Cell& cell) {
  const UnsignedWords words;
  const auto near = hn::BitCast(words, cell.near);
  const auto far = hn::BitCast(words, cell.far);
  const auto to_near = hn::Sub(hn::Set(words, std::uint16_t{256}), cell.to_far);
  const auto low_byte = hn::Set(words, std::uint16_t{0xFF});
  const auto first = hn::Add(hn::Mul(hn::And(near, low_byte), to_near),
                             hn::Mul(hn::And(far, low_byte), cell.to_far));
  const auto second = hn::Add(hn::Mul(hn::ShiftRight<8>(near), to_near),
                              hn::Mul(hn::ShiftRight<8>(far), cell.to_far));
  const auto columns =
      hn::Add(hn::MulHigh(first, hn::Not(cell.to_second)), hn::MulHigh(second, cell.to_second));
  const auto depth_weights =
      hn::Xor(hn::BitCast(Ints{}, cell.below), whole(0x7FFF)); // the upper bin's in the lower half
  return dot_pairs(hn::BitCast(Words{}, hn::ShiftRight<1>(columns)),
                   hn::BitCast(Words{}, depth_weights), whole(1 << (entry_shift - 1)));
}

HWY_INLINE Int table_entry(const std::uint32_t* table, Int level) {
  return hn::GatherIndex(Ints{}, reinterpret_cast<const std::int32_t*>(table),
                         hn::ShiftRight<entry_shift>(level));
}

// For leaping over empty bricks: a ray's step along one axis.
struct BrickAxis {
  Int step;      // cells per sample
  Int towards;   // all ones for rays that ascend the axis
  Real per_step; // 1 / |step|
};

HWY_INLINE BrickAxis make_brick_axis(Int step) {
  BrickAxis axis;
  axis.step = step;
  axis.towards = hn::Not(hn::BroadcastSignBit(step));
  const Real length = hn::ConvertTo(Floats{}, hn::Abs(step));
  axis.per_step = hn::IfThenElse(hn::Eq(length, real(0)), real(1e9F), hn::Div(real(1), length));
  return axis;
}

// Samples until the far side of this brick plus `more` bricks.
template <int Shift>
HWY_INLINE Real samples_to_side(const BrickAxis& axis, Int position, Int more) {
  const Int inside = hn::And(hn::Xor(position, axis.towards), whole((1 << Shift) - 1));
  const Int distance = hn::Add(hn::ShiftLeft<Shift>(more), inside);
  return hn::Mul(hn::ConvertTo(Floats{}, distance), axis.per_step);
}

struct BrickAxes {
  BrickAxis z, a, b;
};

inline constexpr int brick_z_shift = 16 + pipeline::brick_depth_shift;
inline constexpr int brick_a_shift = 16 + pipeline::brick_a_shift;
inline constexpr int brick_b_shift = 16 + pipeline::brick_b_shift;

// DistancesAhead's number (of the levels' bricks or the flow's) for the brick that contains p; `octant` is the offset of the octant's
// bricks. Distance in bits 0–7, highest level in bits 8–15.
HWY_INLINE Int brick_at(const RayFrame& frame, const std::uint16_t* bricks, Int octant,
                        const Position& p, IntMask valid) {
  const Int index =
      hn::Add(hn::Add(hn::Mul(hn::ShiftRight<brick_b_shift>(p.b), whole(frame.brick_slab)),
                      hn::Mul(hn::ShiftRight<brick_a_shift>(p.a), whole(frame.brick_row))),
              hn::Add(hn::ShiftRight<brick_z_shift>(p.z), octant));
  return gather(bricks, hn::ShiftLeft<1>(hn::IfThenElseZero(valid, index)));
}

// Samples to the first one outside; at least one. The rounding leaves a margin of a hundredth of a
// sample, so that no sample beyond the side is skipped: leaping does not change the picture.
HWY_INLINE Int samples_to_leap(const BrickAxes& axes, const Position& p, Int more) {
  const Real samples = hn::Min(samples_to_side<brick_z_shift>(axes.z, p.z, more),
                               hn::Min(samples_to_side<brick_a_shift>(axes.a, p.a, more),
                                       samples_to_side<brick_b_shift>(axes.b, p.b, more)));
  const Real bounded = hn::Min(samples, real(1 << 20)); // exactly representable as an integer
  return hn::Max(hn::ConvertTo(Ints{}, hn::Add(bounded, real(0.99F))), whole(1));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

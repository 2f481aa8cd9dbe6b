// Shades the pixels that segments cover and writes them to the picture. For one instruction set;
// see splat_kernels.h.
#if defined(OCTASCOPE_SPLAT_FRAGMENTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_SPLAT_FRAGMENTS_INL
#undef OCTASCOPE_SPLAT_FRAGMENTS_INL
#else
#define OCTASCOPE_SPLAT_FRAGMENTS_INL
#endif

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "ui/vessels/splatter/splat_frame.h"
#include "ui/vessels/splatter/splat_outline.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {
namespace splat {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using Words = hn::RebindToUnsigned<Floats>;
using Real = hn::Vec<Floats>;
using Int = hn::Vec<Ints>;
using Word = hn::Vec<Words>;
using Mask = hn::Mask<Floats>;

inline constexpr std::size_t lanes = HWY_LANES(float);

HWY_INLINE Real real(float value) {
  return hn::Set(Floats{}, value);
}
HWY_INLINE Int whole(std::int32_t value) {
  return hn::Set(Ints{}, value);
}
HWY_INLINE Word word(std::uint32_t value) {
  return hn::Set(Words{}, value);
}

// Tables for compressing lanes by a bit mask. Highway 1.0.3 has such tables too, but as local
// constants, which GCC copies to the stack (two kilobytes) on each use.
struct LaneOrders {
  // By mask of eight lanes: four bits per lane, the first in the lowest.
  std::array<std::uint32_t, 256> of_eight{};
  // By mask of four lanes: byte indices for the four lanes.
  alignas(16) std::array<std::array<std::uint8_t, 16>, 16> of_four{};

  constexpr LaneOrders() {
    for (std::uint32_t mask = 0; mask < 256; ++mask) {
      std::uint32_t count = 0;
      for (std::uint32_t lane = 0; lane < 8; ++lane) {
        if ((mask >> lane & 1U) == 0)
          continue;
        of_eight[mask] |= lane << 4 * count;
        if (mask < 16)
          for (std::uint32_t byte = 0; byte < 4; ++byte)
            of_four[mask][4 * count + byte] = static_cast<std::uint8_t>(4 * lane + byte);
        ++count;
      }
    }
  }
};
inline constexpr LaneOrders lane_orders;

template <class M> HWY_INLINE std::size_t bits_of(M mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Floats{}, mask, bits);
  return bits[0];
}

// Stores the lanes of `mask` contiguously from `to` on; writes a whole register.
template <class D, class V, class M>
HWY_INLINE void store_lanes(D d, V v, M mask, hn::TFromD<D>* HWY_RESTRICT to) {
  const Word words = hn::BitCast(Words{}, v);
  Word packed;
  if constexpr (lanes == 8) {
    const Word order =
        hn::Set(Words{}, lane_orders.of_eight[bits_of(hn::RebindMask(Floats{}, mask))]);
    HWY_ALIGN static constexpr std::uint32_t shifts[8] = {0, 4, 8, 12, 16, 20, 24, 28};
    packed = hn::TableLookupLanes(
        words,
        hn::IndicesFromVec(Words{}, hn::And(hn::Shr(order, hn::Load(Words{}, shifts)), word(7))));
  } else if constexpr (lanes == 4) {
    const hn::Repartition<std::uint8_t, Words> bytes;
    packed = hn::TableLookupBytes(
        words,
        hn::BitCast(
            Words{},
            hn::Load(bytes, lane_orders.of_four[bits_of(hn::RebindMask(Floats{}, mask))].data())));
  } else {
    packed = hn::Compress(words, hn::RebindMask(Words{}, mask));
  }
  hn::StoreU(hn::BitCast(d, packed), d, to);
}

// Atomic minimum: the smaller number stays, whatever other threads do.
HWY_INLINE void keep_smaller(DepthPixel& pixel, DepthPixel found) {
  std::atomic_ref<DepthPixel> shared{pixel};
  DepthPixel there = shared.load(std::memory_order_relaxed);
  while (found < there && !shared.compare_exchange_weak(there, found, std::memory_order_relaxed)) {
  }
}

// Fragments of so many values: the pixel, then 1 / distance, then the base colour, then others.
template <std::size_t fields> class FragmentStore {
public:
  template <class... Values> HWY_INLINE void add(Mask covered, Values... values) {
    static_assert(sizeof...(values) == fields);
    std::size_t k = 0;
    (store_lanes(Words{}, hn::BitCast(Words{}, values), hn::RebindMask(Words{}, covered),
                 values_[k++] + count_),
     ...);
    count_ += hn::CountTrue(Floats{}, covered);
  }
  bool full() const { return count_ > most; }

  // Of the fragments from the i-th on.
  HWY_INLINE Word value(std::size_t k, std::size_t i) const {
    return hn::Load(Words{}, values_[k] + i);
  }
  HWY_INLINE Real number(std::size_t k, std::size_t i) const {
    return hn::BitCast(Floats{}, value(k, i));
  }

  // Brings all into the picture. place(i) are the distances, with which those that are hidden are
  // left out; shade(i) gives the others' colours with the outlines' upper bits, and the lower ones.
  template <class Place, class Shade>
  HWY_INLINE void flush(DepthPixel* picture, const Place& place, const Shade& shade) {
    const std::uint32_t* pixels = values_[0];
    for (std::size_t i = 0; i < count_; ++i)
      __builtin_prefetch(picture + pixels[i], 1);
    for (std::size_t i = 0; i < count_; i += lanes)
      hn::Store(hn::AndNot(word(outline_in_distance), hn::BitCast(Words{}, place(i))), Words{},
                values_[distance] + i);
    drop_hidden(picture);
    for (std::size_t i = 0; i < count_; i += lanes) {
      const auto [shaded, low] = shade(i);
      hn::Store(hn::Or(value(distance, i), low), Words{}, values_[distance] + i);
      hn::Store(shaded, Words{}, values_[colour] + i);
    }
    for (std::size_t i = 0; i < count_; ++i)
      keep_smaller(picture[pixels[i]],
                   DepthPixel{values_[distance][i]} << 32U | values_[colour][i]);
    count_ = 0;
  }

private:
  static constexpr std::size_t most = 192;
  static constexpr std::size_t room = most + 2 * lanes;
  static constexpr std::size_t distance = 1; // first its inverse
  static constexpr std::size_t colour = 2;

  // First all loads, then all comparisons: the processor cannot foresee who is hidden.
  HWY_INLINE void drop_hidden(DepthPixel* picture) {
    HWY_ALIGN std::uint32_t there[room];
    for (std::size_t i = 0; i < count_; ++i)
      there[i] = static_cast<std::uint32_t>(
          std::atomic_ref<DepthPixel>{picture[values_[0][i]]}.load(std::memory_order_relaxed) >>
          32U);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; i += lanes) {
      const auto shown = hn::Not(hn::Gt(hn::BitCast(Ints{}, value(distance, i)),
                                        hn::BitCast(Ints{}, hn::Load(Words{}, there + i))));
      const Mask nearer =
          hn::And(hn::FirstN(Floats{}, count_ - i), hn::RebindMask(Floats{}, shown));
      for (std::uint32_t* values : values_)
        store_lanes(Words{}, hn::Load(Words{}, values + i), hn::RebindMask(Words{}, nearer),
                    values + kept);
      kept += hn::CountTrue(Floats{}, nearer);
    }
    count_ = kept;
  }

  std::size_t count_ = 0;
  HWY_ALIGN std::uint32_t values_[fields][room];
};

// Where a pixel's centre lies in a vessel that is a pixel wide or more (least_raised_px).
struct WithinVessel {
  Real ex, ey; // from the axis, in pixels
  Real r;
  Word course; // SegmentCourse
};

// Collects covered pixels, shades them together and then writes them to the picture. Lanes that
// draw segments are mostly idle; here they are full, so whatever can wait is done here.
class Fragments {
public:
  explicit Fragments(const SplatFrame& frame) : frame_{frame} {}
  Fragments(const Fragments&) = delete;
  Fragments& operator=(const Fragments&) = delete;

  // For the lanes of `covered`, thinner than a pixel: pixel index, 1 / distance, base colour.
  HWY_INLINE void add_thin(Int pixel, Real nearness, Word colour, Mask covered) {
    thin_.add(covered, pixel, nearness, colour);
    if (HWY_UNLIKELY(thin_.full()))
      flush_thin();
  }

  // For wider ones.
  HWY_INLINE void add_wide(Int pixel, Real nearness, Word colour, const WithinVessel& where,
                           Mask covered) {
    wide_.add(covered, pixel, nearness, colour, where.ex, where.ey, where.r, where.course);
    if (HWY_UNLIKELY(wide_.full()))
      flush_wide();
  }

  // All of them.
  void finish() {
    flush_thin();
    flush_wide();
  }

private:
  struct Shaded {
    Word colour;
    Word low; // of the outline
  };

  HWY_NOINLINE void flush_thin() {
    thin_.flush(
        frame_.pixels, [this](std::size_t i) { return hn::Div(real(1), thin_.number(1, i)); },
        [this](std::size_t i) {
          const Real brightness = hn::Mul(fading(thin_.number(1, i)), real(thin_light_));
          return Shaded{shaded(thin_.value(2, i), brightness), word(0)};
        });
  }

  HWY_NOINLINE void flush_wide() {
    wide_.flush(
        frame_.pixels, [this](std::size_t i) { return place_wide(i); },
        [this](std::size_t i) { return shade_wide(i); });
  }

  HWY_INLINE WithinVessel where(std::size_t i) const {
    return {wide_.number(3, i), wide_.number(4, i), wide_.number(5, i), wide_.value(6, i)};
  }
  static HWY_INLINE Real off2_of(const WithinVessel& w) {
    return hn::MulAdd(w.ex, w.ex, hn::Mul(w.ey, w.ey));
  }

  HWY_INLINE Real place_wide(std::size_t i) const {
    const WithinVessel w = where(i);
    const Real height2 = hn::Max(hn::MulSub(w.r, w.r, off2_of(w)), real(0));
    const Real rise = hn::Mul(hn::Sqrt(height2), rise_of(w.course));
    const Real axis = wide_.number(1, i);
    return hn::Div(real(1),
                   hn::MulAdd(axis, hn::Mul(rise, real(1 / frame_.pixels_per_unit)), axis));
  }

  HWY_INLINE Shaded shade_wide(std::size_t i) const {
    const WithinVessel w = where(i);
    const Real off2 = off2_of(w);
    // vessel_brightness()
    const Real share = hn::Min(hn::Max(hn::Sub(w.r, real(least_shaded_px)), real(0)), real(1));
    const Real off_axis = hn::MulAdd(
        share, hn::Sub(hn::Div(off2, hn::Mul(w.r, w.r)), real(mean_off_axis)), real(mean_off_axis));
    const Real round = hn::Sqrt(hn::Max(hn::Sub(real(1), off_axis), real(0)));
    const Real light = hn::MulAdd(real(1 - vessel_ambient), round, real(vessel_ambient));
    const Real brightness = hn::Mul(fading(wide_.number(1, i)), light);
    const Word outline = outline_at(w, off2);
    return {hn::Or(shaded(wide_.value(2, i), brightness),
                   hn::ShiftLeft<24>(hn::ShiftRight<4>(outline))),
            hn::And(outline, word(outline_in_distance))};
  }

  // SplatOutline, `off2`: squared, from the axis; in its body, not in its round ends, the outline
  // runs as the segment does.
  HWY_INLINE Word outline_at(const WithinVessel& w, Real off2) const {
    const Real within = hn::Sub(w.r, real(outline_reach_px));
    const Mask inside = hn::And(hn::Gt(within, real(0)), hn::Lt(off2, hn::Mul(within, within)));
    if (hn::AllTrue(Floats{}, inside))
      return word(outline_of_inside);
    const auto flagged = [&](std::uint32_t bit) {
      return hn::RebindMask(Floats{}, hn::TestBit(w.course, word(bit)));
    };
    const Mask across = flagged(course_across);
    // Well within a round end, too: at a joint it lies in the next segment.
    const Mask along =
        hn::Or(flagged(course_body), hn::Lt(off2, hn::Mul(real(0.15F), hn::Mul(w.r, w.r))));
    const Real nx = hn::Abs(w.ex);
    const Real ny = hn::Abs(w.ey);
    // Near 45 degrees as the segment, so that all pixels of an outline look the same way.
    const Mask sideways_here = hn::Ge(hn::IfThenElse(across, hn::Mul(nx, real(1.25F)), nx),
                                      hn::IfThenElse(across, ny, hn::Mul(ny, real(1.25F))));
    const Mask sideways = hn::Or(hn::And(along, across), hn::AndNot(along, sideways_here));
    const Real slope =
        hn::IfThenElse(along, slope_of(w.course),
                       hn::Div(hn::IfThenElse(sideways, ny, nx),
                               hn::Max(hn::IfThenElse(sideways, nx, ny), real(1e-6F))));
    const Real off = hn::Sqrt(off2);
    const Real per_px = hn::Sqrt(hn::MulAdd(slope, slope, real(1)));
    const Real near_side = hn::Mul(hn::Sub(w.r, off), per_px);
    const Real far_side = hn::Mul(hn::Add(w.r, off), per_px);
    const Mask before = hn::Lt(hn::IfThenElse(sideways, w.ex, w.ey), real(0));
    const auto steps = [](Real px) {
      const Real exact = hn::Max(hn::Mul(px, real(outline_steps)), real(0));
      return hn::BitCast(
          Words{}, hn::ConvertTo(Ints{}, hn::Min(exact, real(static_cast<float>(outline_beyond)))));
    };
    const Word first = steps(hn::IfThenElse(before, near_side, far_side));
    const Word second = steps(hn::IfThenElse(before, far_side, near_side));
    const auto flag = [](Mask mask, std::uint32_t bit) {
      return hn::IfThenElseZero(hn::RebindMask(Words{}, mask), word(bit));
    };
    const Word outline = hn::Or(
        hn::Or(flag(sideways, outline_sideways), flag(hn::Gt(slope, real(0.5F)), outline_oblique)),
        hn::Or(hn::ShiftLeft<outline_step_bits>(first), second));
    return hn::IfThenElse(hn::RebindMask(Words{}, inside), word(outline_of_inside), outline);
  }

  static HWY_INLINE Real number(Word v) { return hn::ConvertTo(Floats{}, hn::BitCast(Ints{}, v)); }
  static HWY_INLINE Real slope_of(Word course) {
    return hn::Mul(number(hn::And(hn::ShiftRight<course_rise_bits>(course), word(whole_slope))),
                   real(1.0F / whole_slope));
  }
  static HWY_INLINE Real rise_of(Word course) {
    return hn::Mul(number(hn::And(course, word(whole_rise))), real(most_rise / whole_rise));
  }

  HWY_INLINE Real fading(Real distance) const {
    const VesselLook& look = frame_.look;
    const Real share = hn::Mul(hn::Sub(distance, real(look.cue_near_mm)),
                               real(1 / (look.cue_far_mm - look.cue_near_mm)));
    return hn::NegMulAdd(real(look.depth_cue), hn::Min(hn::Max(share, real(0)), real(1)), real(1));
  }

  static HWY_INLINE Word shaded(Word base, Real brightness) {
    const Real scale = hn::Mul(brightness, real(255.0F / 1023));
    const auto channel = [&](Word ten_bits) {
      return hn::BitCast(Words{},
                         hn::ConvertTo(Ints{}, hn::MulAdd(number(hn::And(ten_bits, word(0x3FF))),
                                                          scale, real(0.5F))));
    };
    const Word red = channel(base);
    const Word green = hn::ShiftLeft<8>(channel(hn::ShiftRight<10>(base)));
    const Word blue = hn::ShiftLeft<16>(channel(hn::ShiftRight<20>(base)));
    return hn::Or(hn::Or(red, green), blue);
  }

  const SplatFrame& frame_;
  const float thin_light_ = vessel_brightness(0, 0);
  FragmentStore<3> thin_;
  FragmentStore<7> wide_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace splat
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

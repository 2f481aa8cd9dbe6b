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

// Collects covered pixels, shades them together and then writes them to the picture.
class Fragments {
public:
  explicit Fragments(const SplatFrame& frame) : frame_{frame} {}
  Fragments(const Fragments&) = delete;
  Fragments& operator=(const Fragments&) = delete;

  // For the lanes of `covered`: pixel index, 1 / distance, FragmentLook, base colour.
  HWY_INLINE void add(Int pixel, Real nearness, Word look, Word colour, Mask covered) {
    store_lanes(Ints{}, pixel, hn::RebindMask(Ints{}, covered), pixels_ + count_);
    store_lanes(Floats{}, nearness, covered, nearness_ + count_);
    store_lanes(Words{}, look, hn::RebindMask(Words{}, covered), looks_ + count_);
    store_lanes(Words{}, colour, hn::RebindMask(Words{}, covered), colours_ + count_);
    count_ += hn::CountTrue(Floats{}, covered);
    if (HWY_UNLIKELY(count_ > most))
      flush();
  }

  HWY_NOINLINE void flush() {
    for (std::size_t i = 0; i < count_; ++i)
      __builtin_prefetch(frame_.pixels + pixels_[i], 1);
    for (std::size_t i = 0; i < count_; i += lanes)
      shade(i);
    for (std::size_t i = 0; i < count_; ++i)
      bring(frame_.pixels[pixels_[i]], DepthPixel{distances_[i]} << 32U | colours_[i]);
    count_ = 0;
  }

private:
  static constexpr std::size_t most = 192;
  static constexpr std::size_t room = most + 2 * lanes;

  // Atomic minimum: the smaller number stays, whatever other threads do.
  static HWY_INLINE void bring(DepthPixel& pixel, DepthPixel found) {
    std::atomic_ref<DepthPixel> shared{pixel};
    DepthPixel there = shared.load(std::memory_order_relaxed);
    while (found < there &&
           !shared.compare_exchange_weak(there, found, std::memory_order_relaxed)) {
    }
  }

  HWY_INLINE void shade(std::size_t i) {
    const VesselLook& look = frame_.look;
    const Real distance = hn::Div(real(1), hn::LoadU(Floats{}, nearness_ + i));
    const Word fragment = hn::LoadU(Words{}, looks_ + i);
    const Real off_axis =
        hn::ConvertTo(Floats{}, hn::BitCast(Ints{}, hn::And(fragment, word(whole_off_axis))));
    const Real round = hn::Sqrt(hn::NegMulAdd(off_axis, real(1.0F / whole_off_axis), real(1)));
    const Real lit = hn::MulAdd(real(1 - vessel_ambient), round, real(vessel_ambient));
    const Real share = hn::Mul(hn::Sub(distance, real(look.cue_near_mm)),
                               real(1 / (look.cue_far_mm - look.cue_near_mm)));
    const Real fading =
        hn::NegMulAdd(real(look.depth_cue), hn::Min(hn::Max(share, real(0)), real(1)), real(1));
    const Real brightness = hn::Mul(real(255.0F / 1023), hn::Mul(lit, fading));
    const Word base = hn::LoadU(Words{}, colours_ + i);
    const auto channel = [&](Word ten_bits) {
      const Real value =
          hn::ConvertTo(Floats{}, hn::BitCast(Ints{}, hn::And(ten_bits, word(0x3FF))));
      return hn::BitCast(Words{}, hn::ConvertTo(Ints{}, hn::MulAdd(value, brightness, real(0.5F))));
    };
    const Word red = channel(base);
    const Word green = hn::ShiftLeft<8>(channel(hn::ShiftRight<10>(base)));
    const Word blue = hn::ShiftLeft<16>(channel(hn::ShiftRight<20>(base)));
    const Word outline = hn::ShiftRight<off_axis_bits>(fragment);
    const Word high = hn::ShiftLeft<24>(hn::ShiftRight<4>(outline));
    hn::StoreU(hn::Or(hn::Or(red, green), hn::Or(blue, high)), Words{}, colours_ + i);
    const Word low = hn::And(outline, word(outline_in_distance));
    hn::StoreU(hn::Or(hn::AndNot(word(outline_in_distance), hn::BitCast(Words{}, distance)), low),
               Words{}, distances_ + i);
  }

  const SplatFrame& frame_;
  std::size_t count_ = 0;
  HWY_ALIGN std::int32_t pixels_[room];
  HWY_ALIGN float nearness_[room];
  HWY_ALIGN std::uint32_t looks_[room];
  HWY_ALIGN std::uint32_t distances_[room]; // their bits, with the outline's lowest ones
  HWY_ALIGN std::uint32_t colours_[room];   // base colours, then shaded colours
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace splat
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

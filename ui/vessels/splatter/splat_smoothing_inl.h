// Smooths the sharp picture: where a pixel's vessel ends within it or within its neighbour, the two
// are mixed by the share that the vessel covers. For one instruction set; see splat_kernels.h.
//
// First along the rows, then along the columns. Of two neighbours, the nearer one decides: it alone
// may have its outline before the other. What is thinner than a pixel was drawn where it met a
// centre, which is right on the average alone: it gives and takes a quarter, so that dots and gaps
// become the grey that they stand for.
#if defined(OCTASCOPE_SPLAT_SMOOTHING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_SPLAT_SMOOTHING_INL
#undef OCTASCOPE_SPLAT_SMOOTHING_INL
#else
#define OCTASCOPE_SPLAT_SMOOTHING_INL
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "ui/vessels/splatter/splat_kernels.h"
#include "ui/vessels/splatter/splat_occlusion_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {
namespace splat {

// Weights are shares of 64.
inline constexpr std::uint32_t whole_weight = 64;
inline constexpr std::uint32_t thin_weight = 16;

inline constexpr std::int32_t no_distance = 0x7F800000; // the bits of infinity

// Per lane, how much of the second pixel the first one takes, and the other way round.
struct Exchange {
  Word into_first;
  Word into_second;
};

// The share of a pixel that lies beyond an outline `px` from its centre, along the axis.
// `tail`: how much of the axis the outline crosses within a pixel; `per_tail`: 1 / (2 tail).
HWY_INLINE Real share_beyond(Real px, Real tail, Real per_tail) {
  const Real in = hn::Max(hn::MulAdd(real(0.5F), tail, hn::Sub(real(0.5F), px)), real(0));
  const Real corner = hn::Mul(hn::Mul(in, in), per_tail);
  return hn::IfThenElse(hn::Lt(in, tail), corner, hn::NegMulAdd(real(0.5F), tail, in));
}

class Smoothing {
public:
  explicit Smoothing(const SplatFrame& frame) : frame_{frame}, light_{frame} {}
  Smoothing(const Smoothing&) = delete;
  Smoothing& operator=(const Smoothing&) = delete;

  // Rows [top, bottom) of the columns from `left` on, at most `block`. Returns whether there is a
  // vessel.
  bool smooth(int left, int top, int bottom) {
    bool any = false;
    left_ = left;
    count_ = static_cast<std::size_t>(std::clamp(frame_.width - left, 1, block));
    std::size_t above = 0, here = 1, below = 2;
    load(top, rows_[here]);
    if (top > 0) {
      load(top - 1, rows_[above]);
      exchange_rows(rows_[above], rows_[here]);
    } else {
      rows_[above] = rows_[here];
      std::fill(std::begin(from_above_), std::end(from_above_), 0U);
    }
    for (int y = top; y < bottom; ++y) {
      std::copy_n(from_above_, room, taken_above_);
      if (y + 1 < frame_.height) {
        load(y + 1, rows_[below]);
        exchange_rows(rows_[here], rows_[below]);
      } else {
        std::fill(std::begin(from_below_), std::end(from_below_), 0U);
      }
      any = store(y, rows_[above], rows_[here], rows_[below]) || any;
      std::swap(above, here);
      std::swap(here, below);
    }
    return any;
  }

  static constexpr int block = smoothing_block;
  static_assert(block == occlusion_block);

private:
  static constexpr std::size_t first = lanes; // index of the leftmost column
  static constexpr std::size_t room = first + block + 2 * lanes;

  struct Row {
    bool empty = false; // no vessel in it
    HWY_ALIGN std::uint32_t distance[room];
    HWY_ALIGN std::uint32_t outline[room];
    HWY_ALIGN std::uint32_t colour[room];
    HWY_ALIGN std::uint32_t mixed[room]; // the colour, with its neighbours in the row
  };

  // With a register beyond each end, but where the picture ends: there its last pixel once more.
  void load(int y, Row& row) {
    const DepthPixel* line =
        frame_.pixels + static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_.width);
    const bool begins = left_ == 0;
    const bool ends = left_ + static_cast<int>(count_) == frame_.width;
    const std::size_t from = begins ? first : first - lanes;
    const std::size_t to = first + count_ + (ends ? 0 : 1);
    if (light_.occluded())
      light_.find(left_ - static_cast<int>(first), y, to);
    Int nearest = whole(no_distance);
    for (std::size_t i = from; i < to; i += lanes) {
      // Past the row's end it reads the next row, or the spare pixels after the last one.
      const DepthPixel* pixels = line + left_ + i - first;
      Word low, high;
      hn::LoadInterleaved2(Words{}, reinterpret_cast<const std::uint32_t*>(pixels), low, high);
      if (light_.occluded())
        low = light_.dimmed(i, low, high);
      put(row, i, low, high);
      nearest = hn::Min(nearest, hn::BitCast(Ints{}, high));
    }
    row.empty = hn::AllFalse(Ints{}, hn::Lt(nearest, whole(no_distance)));
    if (row.empty) {
      std::fill(std::begin(row.mixed), std::end(row.mixed), 0U);
      return;
    }
    for (std::uint32_t* values : {row.distance, row.outline, row.colour}) {
      if (begins)
        values[first - 1] = values[first];
      if (ends)
        values[first + count_] = values[first + count_ - 1];
    }
    mix_along(row);
  }

  HWY_INLINE void put(Row& row, std::size_t at, Word low, Word high) {
    const Word outline = hn::Or(hn::And(hn::ShiftRight<20>(low), word(0xFF0)),
                                hn::And(high, word(outline_in_distance)));
    const auto there = hn::Lt(hn::BitCast(Ints{}, high), whole(no_distance));
    const Word opacity = hn::IfThenElseZero(hn::RebindMask(Words{}, there), word(0xFF000000));
    hn::Store(high, Words{}, row.distance + at);
    hn::Store(outline, Words{}, row.outline + at);
    hn::Store(hn::Or(hn::And(low, word(0xFFFFFF)), opacity), Words{}, row.colour + at);
  }

  // `axis`: the outline's flag if it runs so, else 0.
  HWY_INLINE Exchange exchange(Word d1, Word o1, Word d2, Word o2, std::uint32_t axis) const {
    const auto first_nearer = hn::Not(hn::Gt(hn::BitCast(Ints{}, d1), hn::BitCast(Ints{}, d2)));
    const auto nearer = hn::RebindMask(Words{}, first_nearer);
    const Word outline = hn::IfThenElse(nearer, o1, o2);
    const Word step =
        hn::And(hn::IfThenElse(nearer, outline, hn::ShiftRight<outline_step_bits>(outline)),
                word(outline_beyond));
    // Where a volume's rays end there is no tissue to take.
    const auto takes = hn::RebindMask(
        Words{}, hn::Lt(hn::BitCast(Ints{}, hn::Max(d1, d2)),
                        whole(frame_.within_volume ? no_distance : no_distance + 1)));
    const Word thin_share = hn::IfThenElseZero(takes, word(thin_weight));
    const auto vessel = hn::Lt(hn::BitCast(Ints{}, hn::Min(d1, d2)), whole(no_distance));
    const auto unknown = hn::Eq(outline, word(0));
    const auto thin = hn::And(unknown, hn::RebindMask(Words{}, vessel));
    const auto ends =
        hn::And(hn::Eq(hn::And(outline, word(outline_sideways)), word(axis)),
                hn::RebindMask(Words{}, hn::Lt(hn::BitCast(Ints{}, step),
                                               whole(static_cast<std::int32_t>(outline_beyond)))));
    Exchange result{hn::IfThenElseZero(thin, thin_share), hn::IfThenElseZero(thin, thin_share)};
    const auto outlined = hn::AndNot(unknown, ends);
    if (HWY_LIKELY(hn::AllFalse(Words{}, outlined)))
      return result;
    const Real px = hn::Mul(hn::Add(hn::ConvertTo(Floats{}, hn::BitCast(Ints{}, step)), real(0.5F)),
                            real(1 / outline_steps));
    const auto oblique =
        hn::RebindMask(Floats{}, hn::Ne(hn::And(outline, word(outline_oblique)), word(0)));
    const Real tail = hn::IfThenElse(oblique, real(0.75F), real(0.25F));
    const Real per_tail = hn::IfThenElse(oblique, real(1 / 1.5F), real(1 / 0.5F));
    // At most half from either side: rounding must not make more of the two than there is.
    const auto weight = [&](Real share) {
      const Real most = hn::Min(share, real(0.5F));
      return hn::BitCast(Words{},
                         hn::ConvertTo(Ints{}, hn::MulAdd(most, real(whole_weight), real(0.5F))));
    };
    const Word inwards = hn::IfThenElseZero(takes, weight(share_beyond(px, tail, per_tail)));
    const Word outwards = weight(share_beyond(hn::Sub(real(1), px), tail, per_tail));
    result.into_first =
        hn::IfThenElse(outlined, hn::IfThenElse(nearer, inwards, outwards), result.into_first);
    result.into_second =
        hn::IfThenElse(outlined, hn::IfThenElse(nearer, outwards, inwards), result.into_second);
    return result;
  }

  // The pixel's colour with those before and after it, by these weights.
  static HWY_INLINE Word mixed(Word pixel, Word before, Word by_before, Word after, Word by_after) {
    using Halves = hn::Repartition<std::uint16_t, Words>;
    const auto weights = [](Word w) {
      return hn::BitCast(Halves{}, hn::Or(w, hn::ShiftLeft<16>(w)));
    };
    const auto w1 = weights(by_before);
    const auto w2 = weights(by_after);
    const auto w0 = hn::Sub(hn::Set(Halves{}, whole_weight), hn::Add(w1, w2));
    const auto mix = [&](Word a, Word b, Word c) {
      const auto part = [](Word v) { return hn::BitCast(Halves{}, hn::And(v, word(0xFF00FF))); };
      const auto sum = hn::Add(hn::Add(hn::Mul(part(a), w0), hn::Mul(part(b), w1)),
                               hn::Add(hn::Mul(part(c), w2), hn::Set(Halves{}, whole_weight / 2)));
      return hn::BitCast(Words{}, hn::ShiftRight<6>(sum));
    };
    return hn::Or(mix(pixel, before, after),
                  hn::ShiftLeft<8>(mix(hn::ShiftRight<8>(pixel), hn::ShiftRight<8>(before),
                                       hn::ShiftRight<8>(after))));
  }

  void mix_along(Row& row) {
    HWY_ALIGN std::uint32_t from_left[room];
    HWY_ALIGN std::uint32_t from_right[room];
    const auto at = [](const std::uint32_t* values, std::size_t i) {
      return hn::LoadU(Words{}, values + i);
    };
    for (std::size_t i = first - 1; i < first + count_; i += lanes) {
      const Exchange e = exchange(at(row.distance, i), at(row.outline, i), at(row.distance, i + 1),
                                  at(row.outline, i + 1), outline_sideways);
      hn::StoreU(e.into_first, Words{}, from_right + i);
      hn::StoreU(e.into_second, Words{}, from_left + i + 1);
    }
    for (std::size_t i = first; i < first + count_; i += lanes)
      hn::Store(mixed(at(row.colour, i), at(row.colour, i - 1), at(from_left, i),
                      at(row.colour, i + 1), at(from_right, i)),
                Words{}, row.mixed + i);
  }

  // Between two rows, one below the other.
  void exchange_rows(const Row& upper, const Row& lower) {
    if (upper.empty && lower.empty) {
      std::fill(std::begin(from_below_), std::end(from_below_), 0U);
      std::fill(std::begin(from_above_), std::end(from_above_), 0U);
      return;
    }
    for (std::size_t i = first; i < first + count_; i += lanes) {
      const auto at = [i](const std::uint32_t* values) { return hn::Load(Words{}, values + i); };
      const Exchange e =
          exchange(at(upper.distance), at(upper.outline), at(lower.distance), at(lower.outline), 0);
      hn::Store(e.into_first, Words{}, from_below_ + i);
      hn::Store(e.into_second, Words{}, from_above_ + i);
    }
  }

  bool store(int y, const Row& above, const Row& here, const Row& below) {
    DepthPixel* pixels = frame_.smooth +
                         static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_.width) +
                         left_;
    if (above.empty && here.empty && below.empty) {
      std::fill_n(pixels, count_, empty_depth_pixel);
      return false;
    }
    std::uint32_t* line = reinterpret_cast<std::uint32_t*>(pixels);
    for (std::size_t i = 0; i < count_; i += lanes) {
      const auto at = [&](const std::uint32_t* values) {
        return hn::Load(Words{}, values + first + i);
      };
      const Word colour = mixed(at(here.mixed), at(above.mixed), at(taken_above_), at(below.mixed),
                                at(from_below_));
      const Word distance = hn::AndNot(word(outline_in_distance), at(here.distance));
      if (HWY_LIKELY(i + lanes <= count_)) {
        hn::StoreInterleaved2(colour, distance, Words{}, line + 2 * i);
      } else {
        HWY_ALIGN std::uint32_t last[2 * lanes];
        hn::StoreInterleaved2(colour, distance, Words{}, last);
        std::memcpy(line + 2 * i, last, (count_ - i) * sizeof(DepthPixel));
      }
    }
    return true;
  }

  const SplatFrame& frame_;
  OcclusionLight light_;
  int left_ = 0; // of the picture's columns
  std::size_t count_ = 0;
  Row rows_[3];
  HWY_ALIGN std::uint32_t from_above_[room]; // weights between the last two rows
  HWY_ALIGN std::uint32_t from_below_[room];
  HWY_ALIGN std::uint32_t taken_above_[room]; // between the two before
};

std::uint64_t smooth_rows(const SplatFrame& frame, int top, int bottom) {
  Smoothing smoothing{frame};
  std::uint64_t blocks = 0;
  std::uint64_t bit = 1;
  for (int left = 0; left < frame.width; left += Smoothing::block) {
    if (smoothing.smooth(left, top, bottom))
      blocks |= bit;
    bit = std::max(bit, bit << 1U); // the last one is for all that follow
  }
  return blocks;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace splat
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

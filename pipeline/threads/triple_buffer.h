// The triple buffer between the pipeline and the renderer: neither ever waits, and the renderer
// always gets the newest whole volume.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

namespace octascope::pipeline {

// The buffer exchanges *indices* into a pool; it owns no data. Of a pool of N ≥ 3, one index is
// always in the middle, one with the consumer and N − 2 with the producer, who may have several
// volumes under construction at once.
//
// One exchange on one atomic word moves a buffer, and its release/acquire ordering hands over the
// contents. One producer thread, one consumer thread.
class TripleBuffer {
public:
  // `middle` and `front` are the indices that start in the middle and with the consumer.
  TripleBuffer(std::uint32_t middle, std::uint32_t front) : middle_(middle), front_(front) {}

  // Producer. Puts a finished buffer in the middle and returns the one that was there, to be
  // filled next. `skipped` tells that it had been published and the consumer never took it.
  struct Published {
    std::uint32_t recycled;
    bool skipped;
  };
  Published publish(std::uint32_t finished) {
    const std::uint32_t old = middle_.exchange(finished | fresh, std::memory_order_acq_rel);
    return {old & ~fresh, (old & fresh) != 0};
  }

  // Consumer. Takes the newest buffer, if one came since the last call; it stays the consumer's,
  // unchanged, until the next successful take.
  std::optional<std::uint32_t> take() {
    if (!has_newer())
      return std::nullopt;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & ~fresh;
    return front_;
  }

  // Consumer. Would take() succeed?
  bool has_newer() const { return (middle_.load(std::memory_order_relaxed) & fresh) != 0; }

  // Consumer. What it holds.
  std::uint32_t front() const { return front_; }

private:
  static constexpr std::uint32_t fresh = 1U << 31U;

  alignas(64) std::atomic<std::uint32_t> middle_;
  alignas(64) std::uint32_t front_;
};

} // namespace octascope::pipeline

// A bounded, lock-free queue of small numbers (buffer or job indices): one producer, any number of
// consumers, and a producer that never waits.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace octascope::pipeline {

// Head and tail only grow; a slot's value is read before the tail is advanced past it, and is
// thrown away if somebody else advanced the tail first. The producer overwrites a slot only after
// the tail has passed it, so a consumer whose read was overtaken always fails its exchange.
class IndexRing {
public:
  explicit IndexRing(std::size_t capacity)
      : mask_(std::bit_ceil(capacity) - 1),
        slots_(std::make_unique<std::atomic<std::uint32_t>[]>(mask_ + 1)) {}

  std::size_t capacity() const { return mask_ + 1; }

  // Producer only. False when full.
  bool push(std::uint32_t index) {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) > mask_)
      return false;
    slots_[head & mask_].store(index, std::memory_order_relaxed);
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  // Producer only. Makes room by taking out the oldest, which is returned for the caller to
  // release and count.
  std::optional<std::uint32_t> push_dropping_oldest(std::uint32_t index) {
    std::optional<std::uint32_t> dropped;
    while (!push(index))
      dropped = pop();
    return dropped;
  }

  // Any thread. Empty when there is nothing.
  std::optional<std::uint32_t> pop() {
    std::uint64_t tail = tail_.load(std::memory_order_acquire);
    while (tail != head_.load(std::memory_order_acquire)) {
      const std::uint32_t index = slots_[tail & mask_].load(std::memory_order_relaxed);
      if (tail_.compare_exchange_weak(tail, tail + 1, std::memory_order_acq_rel,
                                      std::memory_order_acquire))
        return index;
    }
    return std::nullopt;
  }

private:
  std::size_t mask_;
  std::unique_ptr<std::atomic<std::uint32_t>[]> slots_;
  alignas(64) std::atomic<std::uint64_t> head_{0};
  alignas(64) std::atomic<std::uint64_t> tail_{0};
};

} // namespace octascope::pipeline

// A bounded, lock-free queue of small values between two threads.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>
#include <type_traits>

namespace octascope::pipeline {

// One producer thread, one consumer thread. Neither waits; a full queue refuses.
template <class T, std::size_t Capacity>
requires std::is_trivially_copyable_v<T>
class EventQueue {
public:
  bool push(const T& value) {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == Capacity)
      return false;
    values_[head % Capacity] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  std::optional<T> pop() {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire))
      return std::nullopt;
    const T value = values_[tail % Capacity];
    tail_.store(tail + 1, std::memory_order_release);
    return value;
  }

private:
  std::array<T, Capacity> values_{};
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

} // namespace octascope::pipeline

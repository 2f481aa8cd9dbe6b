// A bounded queue of control events, many writers to one reader.
//
// Lock-free: each slot carries a turn number that says whether the writer or the reader is next (D.
// Vyukov's bounded queue, with a single reader). Allocates nothing.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/control_input.h"

namespace octascope::sim {

class ControlQueue {
public:
  static constexpr std::size_t capacity = 256;

  ControlQueue() {
    for (std::size_t i = 0; i < capacity; ++i)
      places_[i].turn.store(i, std::memory_order_relaxed);
  }

  // Any thread; false when the queue is full.
  bool push(const hal::ControlEvent& event) {
    std::size_t ticket = head_.load(std::memory_order_relaxed);
    while (true) {
      Place& place = places_[ticket % capacity];
      const std::size_t turn = place.turn.load(std::memory_order_acquire);
      if (turn == ticket) {
        if (!head_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_relaxed))
          continue;
        place.event = event;
        place.turn.store(ticket + 1, std::memory_order_release);
        return true;
      }
      if (turn < ticket)
        return false;
      ticket = head_.load(std::memory_order_relaxed);
    }
  }

  // The reading thread only.
  std::optional<hal::ControlEvent> pop() {
    Place& place = places_[tail_ % capacity];
    if (place.turn.load(std::memory_order_acquire) != tail_ + 1)
      return std::nullopt;
    const hal::ControlEvent event = place.event;
    place.turn.store(tail_ + capacity, std::memory_order_release);
    ++tail_;
    return event;
  }

private:
  struct Place {
    std::atomic<std::size_t> turn{0};
    hal::ControlEvent event;
  };

  std::array<Place, capacity> places_;
  std::atomic<std::size_t> head_{0};
  std::size_t tail_ = 0;
};

} // namespace octascope::sim

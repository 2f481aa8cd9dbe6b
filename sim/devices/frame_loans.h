// Which of a camera twin's buffers are free, reserved for a waiting frame, or on loan.
//
// The camera's thread reserves and lends; any thread gives back. Lock-free, no allocation.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>

namespace octascope::sim {

class FrameLoans {
public:
  static constexpr int most_buffers = 1024;

  FrameLoans() { void_all(); }

  // Makes every buffer free; 1 ≤ buffers ≤ most_buffers.
  void reset(int buffers) {
    void_all();
    buffers_ = buffers;
  }

  // Reserves a free buffer; empty if there is none.
  std::optional<int> reserve() {
    for (int tried = 0; tried < buffers_; ++tried) {
      const int buffer = (newest_ + 1 + tried) % buffers_;
      if (state(buffer).load(std::memory_order_acquire) != free_state)
        continue;
      state(buffer).store(reserved_state, std::memory_order_relaxed);
      newest_ = buffer;
      return buffer;
    }
    return std::nullopt;
  }

  // From reserved back to free.
  void cancel(int buffer) { state(buffer).store(free_state, std::memory_order_release); }

  // From reserved to on loan.
  void lend(int buffer) { state(buffer).store(lent_state, std::memory_order_release); }

  // From on loan to free; false if it is not on loan. Any thread.
  bool give_back(int buffer) {
    if (buffer < 0 || buffer >= most_buffers)
      return false;
    int expected = lent_state;
    return state(buffer).compare_exchange_strong(expected, free_state, std::memory_order_acq_rel);
  }

  // Ends every loan.
  void void_all() {
    for (std::atomic<int>& s : states_)
      s.store(free_state, std::memory_order_release);
  }

private:
  static constexpr int free_state = -1;
  static constexpr int reserved_state = -2;
  static constexpr int lent_state = -3;

  std::atomic<int>& state(int buffer) { return states_[static_cast<std::size_t>(buffer)]; }

  int buffers_ = 0;
  int newest_ = -1;
  std::array<std::atomic<int>, most_buffers> states_;
};

} // namespace octascope::sim

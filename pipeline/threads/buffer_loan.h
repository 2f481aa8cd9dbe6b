// Lets one reader look into buffers of a pool that their owner still fills: what is lent is not used
// anew, and neither of the two ever waits.
//
// Source: M. M. Michael, "Hazard pointers: safe memory reclamation for lock-free objects", IEEE TPDS
// 15 (2004), with one reader and one hazard pointer.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace octascope::pipeline {

// Indices into a pool of `Size` buffers; it owns no data. The reader first names the buffer and then
// looks whether it is still open; the owner first closes it and then looks whether it is named. In
// the one order of these four operations at least one of them sees the other's.
//
// One owner thread, one reader thread.
template <std::size_t Size> class BufferLoan {
public:
  // Owner. The buffer is filled for contents of this number, not 0, from now on.
  void open(std::uint32_t buffer, std::uint64_t number) { numbers_[buffer].store(number); }

  // Owner. It is not lent any more. What is on loan remains so.
  void close(std::uint32_t buffer) { numbers_[buffer].store(0); }

  // Owner. The buffer on loan, or one that the reader was about to borrow. Of those that were closed
  // before, none but this is read, and none will be.
  std::optional<std::uint32_t> lent() const {
    const std::uint32_t buffer = lent_.load();
    return buffer == nothing ? std::nullopt : std::optional{buffer};
  }

  struct Lent {
    std::uint32_t buffer;
    std::uint64_t number;
  };

  // Reader. The open buffer with the lowest number above `after`, on loan until give_back().
  std::optional<Lent> borrow_after(std::uint64_t after) {
    const auto lowest = find_after(after);
    if (!lowest)
      return std::nullopt;
    lent_.store(lowest->buffer);
    if (numbers_[lowest->buffer].load() == lowest->number)
      return lowest;
    give_back(); // it was closed meanwhile
    return std::nullopt;
  }

  // Reader. What it has read, it has read before the owner can find out.
  void give_back() { lent_.store(nothing, std::memory_order_release); }

private:
  static constexpr std::uint32_t nothing = ~0U;

  std::optional<Lent> find_after(std::uint64_t after) const {
    std::optional<Lent> lowest;
    for (std::uint32_t buffer = 0; buffer < Size; ++buffer) {
      const std::uint64_t number = numbers_[buffer].load();
      if (number > after && (!lowest || number < lowest->number))
        lowest = Lent{buffer, number};
    }
    return lowest;
  }

  std::array<std::atomic<std::uint64_t>, Size> numbers_{}; // 0: closed
  alignas(64) std::atomic<std::uint32_t> lent_{nothing};
};

} // namespace octascope::pipeline

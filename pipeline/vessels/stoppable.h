// Long work that may be broken off. Once a stop is requested, what it leaves is of no use.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>
#include <vector>

namespace octascope::pipeline {

// For loops of quick turns: asks at each 65 536th.
class StopCheck {
public:
  explicit StopCheck(const std::stop_token& stop) : stop_{stop} {}
  bool operator()() { return (++turns_ & 0xFFFF) == 0 && stop_.stop_requested(); }

private:
  const std::stop_token& stop_;
  std::uint32_t turns_ = 0;
};

// As std::sort, of values between which `less` decides in full: equal ones are the same. Merges
// sorted pieces, with room for all values once more, since std::sort cannot be left.
template <class Value, class Less>
void stoppable_sort(std::vector<Value>& values, Less less, const std::stop_token& stop) {
  constexpr std::size_t piece = std::size_t{1} << 17;
  const auto at = [&](std::size_t index) {
    return values.begin() + static_cast<std::ptrdiff_t>(std::min(index, values.size()));
  };
  for (std::size_t begin = 0; begin < values.size(); begin += piece) {
    if (stop.stop_requested())
      return;
    std::sort(at(begin), at(begin + piece), less);
  }
  StopCheck stopped{stop};
  std::vector<Value> merged;
  for (std::size_t width = piece; width < values.size(); width *= 2) {
    merged.clear();
    merged.reserve(values.size());
    for (std::size_t begin = 0; begin < values.size(); begin += 2 * width) {
      auto a = at(begin);
      auto b = at(begin + width);
      const auto a_end = b;
      const auto b_end = at(begin + 2 * width);
      while (a != a_end || b != b_end) {
        const bool second = a == a_end || (b != b_end && less(*b, *a));
        merged.push_back(second ? *b++ : *a++);
        if (stopped())
          return;
      }
    }
    std::swap(values, merged);
  }
}

} // namespace octascope::pipeline

// The driver's 32-bit frame number as hal::LineFrame counts: from 0 at the stream's first frame, in
// 64 bits, over the wrap.
#pragma once

#include <cstdint>

namespace octascope::hal::linux_backend {

// Pure, one thread. If the driver's number stands still or goes back, so does this one, though not
// below 0: the reader sees that the driver's counter hung or was reset.
class SequenceCounter {
public:
  std::uint64_t extend(std::uint32_t raw) {
    if (!begun_) {
      begun_ = true;
    } else {
      // Wraps are forward steps; a step of more than half the range is one back.
      const std::uint32_t step = raw - last_;
      const std::uint32_t back = last_ - raw;
      if (step <= most_forward)
        total_ += step;
      else
        total_ -= back < total_ ? back : total_;
    }
    last_ = raw;
    return total_;
  }

private:
  static constexpr std::uint32_t most_forward = 0x7FFF'FFFF;

  bool begun_ = false;
  std::uint32_t last_ = 0;
  std::uint64_t total_ = 0;
};

} // namespace octascope::hal::linux_backend

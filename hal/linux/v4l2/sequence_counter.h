// Extends the driver's 32-bit frame number to 64 bits, across wraps, for hal::LineFrame: 0 at the
// stream's first frame.
#pragma once

#include <cstdint>

namespace octascope::hal::linux_backend {

// Pure, one thread. If the driver's number does not advance or goes back, so does this one, but not
// below 0: the caller can tell that the driver's counter hung or was reset.
class SequenceCounter {
public:
  std::uint64_t extend(std::uint32_t raw) {
    if (!begun_) {
      begun_ = true;
    } else {
      // A wrap is a forward step; a step of more than half the range is a backward one.
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

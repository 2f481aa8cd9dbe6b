// Writing from the handler of a fatal signal, where the standard library must not be used: no
// allocation, no lock, no locale. Everything here is async-signal-safe (signal-safety(7)).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <string_view>

#include <unistd.h>

namespace octascope::firmware_host {

// Buffers and writes; write errors are ignored. Without a descriptor it only buffers, up to a
// kilobyte.
class SignalText {
public:
  explicit SignalText(int descriptor = -1) : descriptor_{descriptor} {}
  ~SignalText() { flush(); }
  SignalText(const SignalText&) = delete;
  SignalText& operator=(const SignalText&) = delete;

  SignalText& text(std::string_view text) {
    for (const char c : text)
      put(c);
    return *this;
  }
  SignalText& number(std::uint64_t value, int digits = 1) { return in_base(value, 10, digits); }
  SignalText& hex(std::uint64_t value) { return text("0x").in_base(value, 16, 1); }

  // 20261121-231500, in UTC: local time would need files.
  SignalText& time(std::time_t seconds) {
    const Civil c = civil_of(seconds / 86400);
    const auto of_day = static_cast<std::uint64_t>(seconds % 86400);
    return number(c.year, 4)
        .number(c.month, 2)
        .number(c.day, 2)
        .text("-")
        .number(of_day / 3600, 2)
        .number(of_day / 60 % 60, 2)
        .number(of_day % 60, 2);
  }

  std::string_view gathered() const { return {buffer_.data(), used_}; }

  void flush() {
    for (std::size_t done = 0; done < used_;) {
      const ssize_t n = ::write(descriptor_, buffer_.data() + done, used_ - done);
      if (n <= 0)
        break;
      done += static_cast<std::size_t>(n);
    }
    used_ = 0;
  }

private:
  struct Civil {
    std::uint64_t year, month, day;
  };

  // Howard Hinnant, chrono-Compatible Low-Level Date Algorithms, civil_from_days; from 1970 on.
  static Civil civil_of(std::time_t days_since_1970) {
    const auto z = static_cast<std::uint64_t>(days_since_1970) + 719468;
    const std::uint64_t era = z / 146097;
    const std::uint64_t doe = z % 146097;
    const std::uint64_t yoe = (doe - doe / 1460 + doe / 36524 - doe / 146096) / 365;
    const std::uint64_t doy = doe - (365 * yoe + yoe / 4 - yoe / 100);
    const std::uint64_t mp = (5 * doy + 2) / 153;
    const std::uint64_t month = mp < 10 ? mp + 3 : mp - 9;
    return {yoe + era * 400 + (month <= 2 ? 1U : 0U), month, doy - (153 * mp + 2) / 5 + 1};
  }

  SignalText& in_base(std::uint64_t value, unsigned base, int digits) {
    std::array<char, 24> reversed{};
    int n = 0;
    for (; value != 0 || n < digits; value /= base)
      reversed[static_cast<std::size_t>(n++)] = "0123456789abcdef"[value % base];
    while (n > 0)
      put(reversed[static_cast<std::size_t>(--n)]);
    return *this;
  }

  void put(char c) {
    if (used_ == buffer_.size())
      flush();
    buffer_[used_++] = c;
  }

  int descriptor_;
  std::size_t used_ = 0;
  std::array<char, 1024> buffer_{};
};

} // namespace octascope::firmware_host

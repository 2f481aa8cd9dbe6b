// A short text in place: formatting it allocates nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

namespace octascope::ui {

// Longer text is cut at N bytes, at the border of a UTF-8 character.
template <std::size_t N> class FixedText {
public:
  FixedText() = default;

  template <class... Args> void format(fmt::format_string<Args...> pattern, Args&&... args) {
    const auto result = fmt::format_to_n(bytes_.data(), N, pattern, std::forward<Args>(args)...);
    size_ = std::min(result.size, N);
    if (result.size > N)
      while (size_ > 0 && (static_cast<unsigned char>(bytes_[size_ - 1]) & 0xC0U) == 0x80U)
        --size_;
    if (result.size > N && size_ > 0 &&
        (static_cast<unsigned char>(bytes_[size_ - 1]) & 0x80U) != 0)
      --size_;
  }

  std::string_view view() const { return {bytes_.data(), size_}; }
  bool empty() const { return size_ == 0; }
  bool operator==(const FixedText& other) const { return view() == other.view(); }

private:
  std::array<char, N> bytes_{};
  std::size_t size_ = 0;
};

} // namespace octascope::ui

// A short text stored in place: formatting allocates nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace octascope::ui {

// Longer text is cut at N bytes, at a UTF-8 character boundary.
template <std::size_t N> class FixedText {
public:
  FixedText() = default;

  template <class... Args> void format(fmt::format_string<Args...> pattern, Args&&... args) {
    const auto result = fmt::format_to_n(bytes_.data(), N, pattern, std::forward<Args>(args)...);
    size_ = std::min(result.size, N);
    if (result.size > N)
      drop_cut_character();
  }

  std::string_view view() const { return {bytes_.data(), size_}; }
  bool empty() const { return size_ == 0; }
  bool operator==(const FixedText& other) const { return view() == other.view(); }

private:
  void drop_cut_character() {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes_[i]); };
    std::size_t lead = size_; // of the last character
    while (lead > 0 && (byte(--lead) & 0xC0U) == 0x80U) {
    }
    const unsigned first = byte(lead);
    const std::size_t length = first < 0x80U ? 1 : first < 0xE0U ? 2 : first < 0xF0U ? 3 : 4;
    if (lead + length > size_)
      size_ = lead;
  }

  std::array<char, N> bytes_{};
  std::size_t size_ = 0;
};

} // namespace octascope::ui

// Files as they come after a bad disc, a bad editor or a bad mood: a good one, changed at random.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <string_view>

namespace octascope::tests {

// The good one, to begin with.
inline std::string whole_file(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream{file, std::ios::binary}.rdbuf();
  return text.str();
}

// The same `generator` makes the same changes.
inline std::string mutate(std::string text, std::mt19937_64& generator) {
  const auto below = [&](std::size_t end) {
    return end == 0 ? 0 : static_cast<std::size_t>(generator() % end);
  };
  // What parsers stumble over; the last two are a NUL and half of a UTF-8 character.
  constexpr std::string_view awkward[] = {"nan",
                                          "-inf",
                                          "1e999",
                                          "-1",
                                          "0",
                                          "99999999999999999999",
                                          "\"",
                                          "\"\"\"",
                                          "[[",
                                          "]",
                                          "{",
                                          "= =",
                                          "\\u",
                                          "#",
                                          "\r\n\r\n",
                                          "..",
                                          "-",
                                          "\xEF\xBB\xBF",
                                          "4294967296",
                                          "-9223372036854775808",
                                          "../../../etc/passwd",
                                          {"\0", 1},
                                          "\xC3"};
  const std::size_t changes = 1 + below(4);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t some = below(std::min<std::size_t>(text.size() - at, 40) + 1);
    switch (generator() % 7) {
    case 0: text.resize(at); break;
    case 1: text.erase(at, some); break;
    case 2: text.insert(at, text.substr(below(text.size() + 1), some)); break;
    case 3: text.insert(at, awkward[below(std::size(awkward))]); break;
    case 4: text.replace(at, some, awkward[below(std::size(awkward))]); break;
    case 5:
      if (at < text.size())
        text[at] = static_cast<char>(text[at] ^ (1 << (generator() % 8)));
      break;
    default:
      if (at < text.size())
        text[at] = static_cast<char>(generator());
    }
  }
  return text;
}

} // namespace octascope::tests

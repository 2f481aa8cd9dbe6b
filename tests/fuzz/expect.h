// What must hold whatever the bytes are: else the fuzzer stops and keeps them.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace octascope::tests {

inline void expect(bool holds, std::string_view what) {
  if (holds)
    return;
  std::fprintf(stderr, "does not hold: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

// A refusal is one line that begins with the file's name.
inline void expect_refusal(std::string_view message) {
  expect(message.starts_with("name:"), message);
  expect(message.find('\n') == std::string_view::npos, message);
}

} // namespace octascope::tests

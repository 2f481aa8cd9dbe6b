// For EXPECT_THAT: a hal::Result that is an error, and says what it should.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "hal/result.h"

namespace octascope::tests {

MATCHER_P2(IsErrorWith, code, words, "is an error that says what it should") {
  if (arg.has_value()) {
    *result_listener << "which is no error";
    return false;
  }
  const std::string& message = arg.error().message;
  *result_listener << "which is " << std::string{to_string(arg.error().code)} << ": " << message;
  return arg.error().code == code.value_or(arg.error().code) &&
         std::ranges::all_of(words, [&](const std::string& word) {
           return message.find(word) != std::string::npos;
         });
}

// Of this code, with all of these words in its message.
template <class... Words> auto FailsWith(hal::ErrorCode code, const Words&... words) {
  return IsErrorWith(std::optional{code}, std::vector<std::string>{words...});
}

inline auto FailsSaying(const std::vector<std::string>& words) {
  return IsErrorWith(std::optional<hal::ErrorCode>{}, words);
}
template <class... Words> auto FailsSaying(const Words&... words) {
  return IsErrorWith(std::optional<hal::ErrorCode>{}, std::vector<std::string>{words...});
}

} // namespace octascope::tests

// What a call must give for a test to go on: else the test ends and fails, with the caller's line.
#pragma once

#include <optional>
#include <source_location>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "hal/result.h"

namespace octascope::tests {

using Caller = std::source_location;

[[noreturn]] inline void end_test(const Caller& caller, std::string_view why) {
  throw std::runtime_error{fmt::format("{}:{}: {}", caller.file_name(), caller.line(), why)};
}

// What it holds.
template <class Value>
Value must(hal::Result<Value> result, const Caller& caller = Caller::current()) {
  if (!result)
    end_test(caller, result.error().message);
  return *std::move(result);
}
template <class Value>
Value must(std::optional<Value> result, const Caller& caller = Caller::current()) {
  if (!result)
    end_test(caller, "found nothing");
  return *std::move(result);
}

// What it ends in.
template <class Value>
hal::Error error_of(const hal::Result<Value>& result, const Caller& caller = Caller::current()) {
  if (result)
    end_test(caller, "found a result, expected an error");
  return result.error();
}

} // namespace octascope::tests

// Results that say what went wrong.
//
// Everything that can fail returns a Result. An Error carries a kind, for the code that decides
// what to do next (retry, give up, ask), and a message, for the person who reads it: what was
// found, what was expected, and what to do. Exceptions do not cross a module's border.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <tl/expected.hpp>

namespace octascope::hal {

enum class ErrorCode {
  absent,           // the device or file is not there; it may come (back)
  busy,             // somebody else holds it
  denied,           // missing permission
  disconnected,     // it was there and went away in the middle
  timed_out,        // it did not answer within its stated limit
  bad_data,         // it answered with something that cannot be right
  invalid_argument, // the caller asked for something that makes no sense
  unsupported,      // it makes sense, but this device or build cannot do it
  system,           // the operating system refused; the message has its words
};

std::string_view to_string(ErrorCode code);

struct Error {
  ErrorCode code = ErrorCode::system;
  std::string message;
};

template <class T = void> using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
  return tl::make_unexpected(Error{code, std::move(message)});
}

template <class First, class... Rest>
tl::unexpected<Error> fail(ErrorCode code, fmt::format_string<First, Rest...> pattern,
                           First&& first, Rest&&... rest) {
  return fail(code, fmt::format(pattern, std::forward<First>(first), std::forward<Rest>(rest)...));
}

} // namespace octascope::hal

// Macros, because only a macro can return from the function that uses it; the arguments are
// variadic so that they may hold commas.

// HAL_TRY(const auto spectrum, read(file)): declares what a Result holds, or returns its error.
#define HAL_TRY(declaration, ...)                                                                  \
  HAL_TRY_NAMED(HAL_TRY_JOIN(hal_try_result_, __LINE__), declaration, __VA_ARGS__)
#define HAL_TRY_NAMED(result, declaration, ...)                                                    \
  auto result = __VA_ARGS__;                                                                       \
  if (!result)                                                                                     \
    return tl::make_unexpected(std::move(result).error());                                         \
  declaration = *std::move(result)
#define HAL_TRY_JOIN(a, b) HAL_TRY_JOIN_EXPANDED(a, b)
#define HAL_TRY_JOIN_EXPANDED(a, b) a##b

// HAL_CHECK(write(file)): returns the error of a Result that holds nothing of interest.
#define HAL_CHECK(...)                                                                             \
  if (auto hal_check_result = __VA_ARGS__; !hal_check_result)                                      \
  return tl::make_unexpected(std::move(hal_check_result).error())

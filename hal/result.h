// Everything that can fail returns a Result. An Error has a code, for the caller that decides what
// to do next (retry, give up, ask), and a message for people: what was found, what was expected and
// what to do. Exceptions do not cross module boundaries.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>
#include <tl/expected.hpp>

namespace octascope::hal {

enum class ErrorCode {
  absent,           // the device or file does not exist, but may appear (again) later
  busy,             // in use by another program
  denied,           // missing permission
  disconnected,     // the device disappeared while in use
  timed_out,        // no answer within the stated limit
  bad_data,         // the data received cannot be right
  invalid_argument, // the request makes no sense
  unsupported,      // a valid request that this device or build cannot fulfil
  system,           // the operating system refused; the message includes its error text
};

std::string_view to_string(ErrorCode code);

struct Error {
  ErrorCode code = ErrorCode::system;
  std::string message;
};

template <class T = void> using Result = tl::expected<T, Error>;

// The message is made harmless for terminals and documents, as it may quote what came from outside
// (printable_lines of hal/plain_text.h).
tl::unexpected<Error> fail(ErrorCode code, std::string_view message);

template <class First, class... Rest>
tl::unexpected<Error> fail(ErrorCode code, fmt::format_string<First, Rest...> pattern,
                           First&& first, Rest&&... rest) {
  return fail(code, fmt::format(pattern, std::forward<First>(first), std::forward<Rest>(rest)...));
}

} // namespace octascope::hal

// Only a macro can return from the calling function. The arguments are variadic so that they may
// contain commas.

// HAL_TRY(const auto spectrum, read(file)): declares the value of a Result, or returns its error.
#define HAL_TRY(declaration, ...)                                                                  \
  HAL_TRY_NAMED(HAL_TRY_JOIN(hal_try_result_, __LINE__), declaration, __VA_ARGS__)
#define HAL_TRY_NAMED(result, declaration, ...)                                                    \
  auto result = __VA_ARGS__;                                                                       \
  if (!result)                                                                                     \
    return tl::make_unexpected(std::move(result).error());                                         \
  declaration = *std::move(result)
#define HAL_TRY_JOIN(a, b) HAL_TRY_JOIN_EXPANDED(a, b)
#define HAL_TRY_JOIN_EXPANDED(a, b) a##b

// HAL_CHECK(write(file)): returns the error of a Result, and ignores its value.
#define HAL_CHECK(...)                                                                             \
  if (auto hal_check_result = __VA_ARGS__; !hal_check_result)                                      \
  return tl::make_unexpected(std::move(hal_check_result).error())

// Results that say what went wrong.
//
// Everything that can fail returns a Result. An Error carries a kind, for the code that decides
// what to do next (retry, give up, ask), and a message, for the person who reads it: what was
// found, what was expected, and what to do. Exceptions do not cross a module's border.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include <tl/expected.hpp>

namespace octascope::hal {

enum class Fault {
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

std::string_view to_string(Fault fault);

struct Error {
  Fault fault = Fault::system;
  std::string message;
};

template <class T = void> using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(Fault fault, std::string message) {
  return tl::make_unexpected(Error{fault, std::move(message)});
}

} // namespace octascope::hal

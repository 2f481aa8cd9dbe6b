#include "hal/result.h"

#include "hal/plain_text.h"

namespace octascope::hal {

std::string_view to_string(ErrorCode fault) {
  switch (fault) {
  case ErrorCode::absent: return "absent";
  case ErrorCode::busy: return "busy";
  case ErrorCode::denied: return "denied";
  case ErrorCode::disconnected: return "disconnected";
  case ErrorCode::timed_out: return "timed out";
  case ErrorCode::bad_data: return "bad data";
  case ErrorCode::invalid_argument: return "invalid argument";
  case ErrorCode::unsupported: return "unsupported";
  case ErrorCode::system: return "system error";
  }
  return "unknown fault";
}

tl::unexpected<Error> fail(ErrorCode code, std::string_view message) {
  return tl::make_unexpected(Error{code, printable_lines(message)});
}

} // namespace octascope::hal

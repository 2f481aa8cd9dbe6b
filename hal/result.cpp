#include "hal/result.h"

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

} // namespace octascope::hal

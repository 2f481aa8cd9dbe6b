#include "hal/result.h"

namespace octascope::hal {

std::string_view to_string(Fault fault) {
  switch (fault) {
  case Fault::absent: return "absent";
  case Fault::busy: return "busy";
  case Fault::denied: return "denied";
  case Fault::disconnected: return "disconnected";
  case Fault::timed_out: return "timed out";
  case Fault::bad_data: return "bad data";
  case Fault::invalid_argument: return "invalid argument";
  case Fault::unsupported: return "unsupported";
  case Fault::system: return "system error";
  }
  return "unknown fault";
}

} // namespace octascope::hal

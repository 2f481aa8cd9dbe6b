#include "firmware-host/version/version.h"

namespace octascope::firmware_host {

std::string_view version() {
  return "0.1.0";
}

} // namespace octascope::firmware_host

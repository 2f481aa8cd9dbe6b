// The appliance's answer as text for people.
#pragma once

#include <string>

#include "hal/result.h"

namespace octascope::firmware_host {

// `answer` is the appliance's JSON object. ErrorCode::bad_data: it is not one.
hal::Result<std::string> status_words(const std::string& answer);

} // namespace octascope::firmware_host

// The appliance's answer in words for people.
#pragma once

#include <string>

#include "hal/result.h"

namespace octascope::firmware_host {

// `answer` is the JSON object that the appliance gave. ErrorCode::bad_data: it is none.
hal::Result<std::string> status_words(const std::string& answer);

} // namespace octascope::firmware_host

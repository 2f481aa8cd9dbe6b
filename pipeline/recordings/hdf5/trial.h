// Tries what may crash a library in a process of its own, where a crash costs nothing.
#pragma once

#include <functional>

#include "hal/result.h"

namespace octascope::pipeline {

// Runs the action in a forked process and discards its effects. ErrorCode::bad_data: it crashed, or
// did not end within half a minute. Do not call this while other threads hold locks that the action
// needs.
hal::Result<> try_apart(const std::function<void()>& action);

} // namespace octascope::pipeline

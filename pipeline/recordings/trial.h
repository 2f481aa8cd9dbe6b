// What may crash a library, tried first where nothing is lost by it.
#pragma once

#include <functional>

#include "hal/result.h"

namespace octascope::pipeline {

// Runs the action in a process of its own, of which nothing remains. ErrorCode::bad_data: it crashed
// there, or came to no end in half a minute. Not to be called while other threads hold locks that the
// action needs.
hal::Result<> try_apart(const std::function<void()>& action);

} // namespace octascope::pipeline

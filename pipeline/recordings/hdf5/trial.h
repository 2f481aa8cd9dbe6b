// Tries what may crash a library in a process of its own, where a crash costs nothing.
#pragma once

#include <filesystem>
#include <functional>

#include "hal/result.h"
#include "pipeline/recordings/hdf5/hdf5.h"
#include "pipeline/recordings/hdf5/reading.h"

namespace octascope::pipeline {

// Runs the action in a forked process and discards its effects. ErrorCode::bad_data: it crashed, or
// did not end within half a minute. Do not call this while other threads hold locks that the action
// needs.
hal::Result<> try_apart(const std::function<void()>& action);

// What `load` makes of a file that anybody may have damaged: once in a process of its own, where
// `walk` looks at all that HDF5 will look at, then here. Errors name the file.
template <class Load, class Walk>
auto load_tried(const std::filesystem::path& file, const Load& load, const Walk& walk)
    -> decltype(load(file)) {
  const Hdf5Silence silence;
  auto loaded =
      check_file(file).and_then([&] { return try_apart([&] { walk(load(file)); }); }).and_then([&] {
        return load(file);
      });
  if (!loaded)
    return hal::fail(loaded.error().code, "{}: {}", file.string(), loaded.error().message);
  return loaded;
}

} // namespace octascope::pipeline

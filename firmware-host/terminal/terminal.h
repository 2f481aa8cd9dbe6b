// What the program says on standard output and standard error. Texts may quote what came from
// outside: control characters other than line breaks and tabs, and broken UTF-8, come out as "?".
// None of these throws: a terminal that went away must not end a run.
#pragma once

#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "hal/result.h"

namespace octascope::firmware_host {

void say_text(std::string_view text);  // to standard output
void warn_text(std::string_view text); // to standard error

template <class... Args> void say(fmt::format_string<Args...> pattern, Args&&... args) {
  say_text(fmt::format(pattern, std::forward<Args>(args)...));
}

template <class... Args> void warn(fmt::format_string<Args...> pattern, Args&&... args) {
  warn_text(fmt::format(pattern, std::forward<Args>(args)...));
}

// A line that the next one overwrites, while something goes on; an empty one takes it away.
void show_progress(std::string_view line);

// At the beginning: gives each of the three standard streams that is closed a descriptor that
// refuses, as else the next file to be opened would take its place and be written into; and lets a
// pipe without a reader be an error and not the end of a recording.
void prepare_standard_streams();

// At the end: whether everything that was said has been written. ErrorCode::system: a full disk, a
// pipe without a reader, and the like.
hal::Result<> flush_said();

} // namespace octascope::firmware_host

#include "firmware-host/terminal/terminal.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "hal/plain_text.h"

namespace octascope::firmware_host {

namespace {

// A failure stays in the stream's error indicator, which flush_said() asks.
void write(std::FILE* stream, std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stream);
}

} // namespace

void say_text(std::string_view text) {
  write(stdout, hal::printable_lines(text));
}

void warn_text(std::string_view text) {
  write(stderr, hal::printable_lines(text));
}

void show_progress(std::string_view line) {
  // Back to the beginning, and what is left of the line before is erased.
  write(stderr, fmt::format("\r{}\x1b[K", hal::printable(line)));
  std::fflush(stderr);
}

void prepare_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) // then the lowest free one is it
      static_cast<void>(::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
  std::signal(SIGPIPE, SIG_IGN);
}

hal::Result<> flush_said() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0)
    return {};
  // The reason of a write that failed before is no longer known.
  const std::string reason = errno == 0 ? "a write failed" : std::generic_category().message(errno);
  return hal::fail(hal::ErrorCode::system,
                   "standard output: {}: what was said there is not complete", reason);
}

} // namespace octascope::firmware_host

#include "firmware-host/report/progress_line.h"

#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "firmware-host/terminal/terminal.h"

namespace octascope::firmware_host {

namespace {
constexpr std::chrono::milliseconds before_first{500};
constexpr std::chrono::milliseconds between{100};
} // namespace

ProgressLine::ProgressLine(std::string task)
    : task_(std::move(task)), next_(Clock::now() + before_first),
      terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (printed_)
    show_progress("");
}

void ProgressLine::update(double done) {
  const auto now = Clock::now();
  if (!terminal_ || now < next_)
    return;
  next_ = now + between;
  show_progress(fmt::format("{}: {:.0f} %", task_, 100 * done));
  printed_ = true;
}

} // namespace octascope::firmware_host

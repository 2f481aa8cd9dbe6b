// Progress of a long task, on a terminal.
#pragma once

#include <chrono>
#include <string>

namespace octascope::firmware_host {

// Silent if stderr is no terminal, and for tasks of less than half a second. One thread. The
// destructor clears the line.
class ProgressLine {
public:
  explicit ProgressLine(std::string task);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void update(double done); // 0 to 1

private:
  using Clock = std::chrono::steady_clock;

  std::string task_;
  Clock::time_point next_;
  bool terminal_;
  bool printed_ = false;
};

} // namespace octascope::firmware_host

// One test at a time on this machine's loopback: Aravis's camera answers at one port of 127.0.0.1, and
// tests run beside each other, of several builds, too.
#pragma once

namespace octascope::tests {

// Waits for its turn; the turn ends with this, or with the process.
class LoopbackPort {
public:
  LoopbackPort();
  ~LoopbackPort();
  LoopbackPort(const LoopbackPort&) = delete;
  LoopbackPort& operator=(const LoopbackPort&) = delete;

private:
  int socket_;
};

} // namespace octascope::tests

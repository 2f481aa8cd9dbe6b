#include "tests/support/program/loopback_port.h"

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <system_error>
#include <thread>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace octascope::tests {

// A name without a file belongs to the network that has the loopback, whatever folders a process
// sees. Who has it bound has the turn.
LoopbackPort::LoopbackPort() : socket_{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
  constexpr char name[] = "\0octascope-tests-genicam";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, name, sizeof(name));
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + sizeof(name));
  while (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), length) != 0) {
    if (errno != EADDRINUSE)
      throw std::system_error{errno, std::system_category(), "the turn at the camera's port"};
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
}

LoopbackPort::~LoopbackPort() {
  ::close(socket_);
}

} // namespace octascope::tests

// Nobody comes in by the network: the running program has no socket of it.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// The numbers of a process's sockets.
std::set<std::string> sockets_of(pid_t process) {
  std::set<std::string> numbers;
  for (const auto& entry : fs::directory_iterator{"/proc/" + std::to_string(process) + "/fd"}) {
    std::error_code closed;
    const std::string target = fs::read_symlink(entry.path(), closed).string();
    if (target.starts_with("socket:["))
      numbers.insert(target.substr(8, target.size() - 9));
  }
  return numbers;
}

// Of those, the ones of network protocols: the tables of the kernel name each socket's number in
// one of their columns.
std::set<std::string> network_sockets_of(pid_t process) {
  const std::set<std::string> all = sockets_of(process);
  std::set<std::string> found;
  for (const char* protocol : {"tcp", "tcp6", "udp", "udp6", "udplite", "udplite6", "raw", "raw6",
                               "icmp", "icmp6", "packet"}) {
    std::ifstream table{"/proc/" + std::to_string(process) + "/net/" + protocol};
    for (std::string word; table >> word;)
      if (all.contains(word))
        found.insert(std::string{protocol} + " " + word);
  }
  return found;
}

TEST(Network, a_running_program_has_no_network_socket) {
  const ScratchFolder folder;
  ProgramRun run{octascope_command(small_run(folder, {"--duration", "100"}))};
  ASSERT_TRUE(run.wait_for_thread("octa-camera", 60s));
  for (int look = 0; look < 10; ++look) {
    EXPECT_EQ(network_sockets_of(run.process()), std::set<std::string>{});
    std::this_thread::sleep_for(100ms);
  }
  run.send_signal(SIGTERM);
  EXPECT_EQ(run.wait(60s).exit_status, 0);
}

// What speaks to networks is not even loaded.
TEST(Network, a_running_program_has_no_library_for_networks) {
  const ScratchFolder folder;
  ProgramRun run{octascope_command(small_run(folder, {"--duration", "100"}))};
  ASSERT_TRUE(run.wait_for_thread("octa-camera", 60s));
  std::ifstream maps{"/proc/" + std::to_string(run.process()) + "/maps"};
  int libraries = 0;
  for (std::string line; std::getline(maps, line);) {
    libraries += line.find(".so") != std::string::npos ? 1 : 0;
    for (const char* library :
         {"libaravis", "libcurl", "libssl", "libldap", "libkrb5", "libssh", "libnghttp"})
      EXPECT_EQ(line.find(library), std::string::npos) << line;
  }
  EXPECT_GT(libraries, 50);
  run.send_signal(SIGTERM);
  EXPECT_EQ(run.wait(60s).exit_status, 0);
}

// The test above could see one.
TEST(Network, a_socket_would_be_seen) {
  const int udp = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (udp < 0)
    GTEST_SKIP() << "no network here at all";
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::bind(udp, reinterpret_cast<const sockaddr*>(&any), sizeof any), 0);
  EXPECT_EQ(network_sockets_of(::getpid()).size(), 1U);
  ::close(udp);
}

} // namespace
} // namespace octascope::tests

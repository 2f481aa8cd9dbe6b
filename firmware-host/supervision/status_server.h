// Answers `octascope status` on a local socket; not reachable over a network.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "hal/clock.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::firmware_host {

inline constexpr std::string_view status_socket_name = "status.sock"; // in the runtime folder

// Each client gets the answer and is disconnected; its input is ignored. Served by a thread of its
// own. A client that does not read is dropped after a second; of more than eight at once, the one
// that has waited longest is, so that nobody can keep others out.
class StatusServer {
public:
  using Answer = std::function<std::string()>;

  // Listens on `socket`, which owner and group may use; one left by an ended program is replaced.
  // `answer` is called on the server's thread and must outlive it. ErrorCode::busy: another program
  // listens there. ErrorCode::invalid_argument: the path is too long.
  static hal::Result<std::unique_ptr<StatusServer>> start(const std::filesystem::path& socket,
                                                          Answer answer);
  ~StatusServer(); // removes the socket
  StatusServer(const StatusServer&) = delete;
  StatusServer& operator=(const StatusServer&) = delete;

private:
  using FileDescriptor = hal::linux_backend::FileDescriptor;
  using Clock = std::chrono::steady_clock;
  struct Client {
    FileDescriptor socket;
    std::string rest; // of the answer
    Clock::time_point until;
  };

  StatusServer(std::filesystem::path path, FileDescriptor listener, FileDescriptor stop,
               Answer answer);
  void run();
  void welcome();
  static bool serve(Client& client); // false: done with this client

  std::filesystem::path path_;
  FileDescriptor listener_;
  FileDescriptor stop_; // an eventfd
  Answer answer_;
  std::list<Client> clients_; // the oldest first
  std::thread thread_;
};

// The answer of the appliance listening there. ErrorCode::absent: none does. ErrorCode::denied:
// this user may not ask. ErrorCode::timed_out: no answer within two seconds, or too many clients.
hal::Result<std::string> ask_status(const std::filesystem::path& socket);

} // namespace octascope::firmware_host

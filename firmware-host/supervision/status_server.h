// Answers `octascope status` on a local socket; nothing is ever reached from a network.
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

// Who connects gets the answer and the end; what he says is not read. A thread of its own serves; a
// client that does not read is hung up on after a second, and of more than eight at once the one
// that has waited longest, so that nobody can keep others out.
class StatusServer {
public:
  using Answer = std::function<std::string()>;

  // Listens on `socket`, which owner and group may use; what an ended program left there is
  // replaced. `answer` is called on the server's thread and outlives it.
  // ErrorCode::busy: another program listens there. ErrorCode::invalid_argument: the path is too
  // long.
  static hal::Result<std::unique_ptr<StatusServer>> start(const std::filesystem::path& socket,
                                                          Answer answer);
  ~StatusServer(); // the socket is gone then
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
  static bool serve(Client& client); // false: done with it

  std::filesystem::path path_;
  FileDescriptor listener_;
  FileDescriptor stop_; // an eventfd
  Answer answer_;
  std::list<Client> clients_; // the oldest first
  std::thread thread_;
};

// The answer of an appliance that listens there. ErrorCode::absent: none does. ErrorCode::denied:
// this user may not ask. ErrorCode::timed_out: it has not answered within two seconds, or too many
// ask.
hal::Result<std::string> ask_status(const std::filesystem::path& socket);

} // namespace octascope::firmware_host

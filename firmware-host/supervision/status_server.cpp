#include "firmware-host/supervision/status_server.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "hal/linux/realtime.h"
#include "hal/linux/system/system_error.h"

namespace octascope::firmware_host {

using hal::linux_backend::FileDescriptor;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t most_clients = 8;
constexpr int most_waiting = 64; // to be let in
constexpr auto client_time = 1s;
constexpr auto patience = 2s;                      // of one who asks
constexpr std::size_t longest_answer = 4UL << 20U; // that a command takes in

hal::Result<sockaddr_un> address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.native().size() >= sizeof address.sun_path)
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        "{}: {} characters long, expected at most {}; choose a folder nearer to the root",
        path.string(), path.native().size(), sizeof address.sun_path - 1);
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  return address;
}

const sockaddr* general(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

FileDescriptor make_socket() {
  return FileDescriptor{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
}

hal::Result<FileDescriptor> connect_to(const std::filesystem::path& path) {
  HAL_TRY(const auto address, address_of(path));
  FileDescriptor file = make_socket();
  if (::connect(file.get(), general(address), sizeof address) == 0)
    return file;
  const int error = errno;
  if (error == ENOENT || error == ECONNREFUSED)
    return hal::fail(hal::ErrorCode::absent,
                     "{}: no appliance answers there; is it running (systemctl status octascope), "
                     "and is this its socket (--socket)?",
                     path.string());
  if (error == EAGAIN)
    return hal::fail(hal::ErrorCode::timed_out, "{}: too many ask at once; try again",
                     path.string());
  if (error == EACCES)
    return hal::fail(hal::ErrorCode::denied,
                     "{}: this user may not ask; expected root or a member of the group that the "
                     "socket belongs to",
                     path.string());
  return hal::linux_backend::system_failure(path.string(), "connecting", error,
                                            "try again; if that stays, restart octascope");
}

hal::Result<FileDescriptor> listen_on(const std::filesystem::path& path) {
  HAL_TRY(const auto address, address_of(path));
  if (connect_to(path))
    return hal::fail(hal::ErrorCode::busy,
                     "{}: another octascope answers there; end it, or give this one a "
                     "RUNTIME_DIRECTORY of its own",
                     path.string());
  FileDescriptor file = make_socket();
  ::unlink(path.c_str()); // of one that has ended
  // Nobody can connect before it listens, and by then the rights are there.
  if (::bind(file.get(), general(address), sizeof address) != 0 ||
      ::chmod(path.c_str(), 0660) != 0 || ::listen(file.get(), most_waiting) != 0)
    return hal::linux_backend::system_failure(path.string(), "listening", errno,
                                              "octascope status will not answer");
  return file;
}

} // namespace

hal::Result<std::unique_ptr<StatusServer>> StatusServer::start(const std::filesystem::path& socket,
                                                               Answer answer) {
  HAL_TRY(auto listener, listen_on(socket));
  FileDescriptor stop{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  return std::unique_ptr<StatusServer>{
      new StatusServer{socket, std::move(listener), std::move(stop), std::move(answer)}};
}

StatusServer::StatusServer(std::filesystem::path path, FileDescriptor listener, FileDescriptor stop,
                           Answer answer)
    : path_(std::move(path)), listener_(std::move(listener)), stop_(std::move(stop)),
      answer_(std::move(answer)), thread_([this] {
        hal::linux_backend::name_this_thread("octa-status");
        run();
      }) {}

StatusServer::~StatusServer() {
  ::eventfd_write(stop_.get(), 1);
  thread_.join();
  ::unlink(path_.c_str());
}

void StatusServer::run() {
  while (true) {
    std::vector<pollfd> waited{{stop_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}};
    for (const Client& client : clients_)
      waited.push_back({client.socket.get(), POLLOUT, 0});
    ::poll(waited.data(), waited.size(), clients_.empty() ? -1 : 100);
    if (waited[0].revents != 0)
      return;
    if ((waited[1].revents & POLLIN) != 0)
      welcome();
    clients_.remove_if([](Client& client) { return !serve(client); });
  }
}

void StatusServer::welcome() {
  FileDescriptor socket{::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)};
  if (!socket)
    return;
  if (clients_.size() == most_clients)
    clients_.pop_front();
  clients_.push_back({std::move(socket), answer_(), Clock::now() + client_time});
}

bool StatusServer::serve(Client& client) {
  const ssize_t sent =
      ::send(client.socket.get(), client.rest.data(), client.rest.size(), MSG_NOSIGNAL);
  if (sent < 0)
    return (errno == EAGAIN || errno == EINTR) && Clock::now() < client.until;
  client.rest.erase(0, static_cast<std::size_t>(sent));
  return !client.rest.empty() && Clock::now() < client.until;
}

hal::Result<std::string> ask_status(const std::filesystem::path& socket) {
  const auto until = std::chrono::steady_clock::now() + patience;
  auto file = connect_to(socket);
  while (!file && file.error().code == hal::ErrorCode::timed_out &&
         std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(10ms);
    file = connect_to(socket);
  }
  if (!file)
    return tl::make_unexpected(file.error());
  std::string answer;
  std::array<char, 16384> piece{};
  while (std::chrono::steady_clock::now() < until && answer.size() < longest_answer) {
    pollfd waited{file->get(), POLLIN, 0};
    ::poll(&waited, 1, 100);
    const ssize_t n = ::recv(file->get(), piece.data(), piece.size(), 0);
    if (n > 0)
      answer.append(piece.data(), static_cast<std::size_t>(n));
    if (n == 0 && !answer.empty())
      return answer;
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR))
      break;
  }
  return hal::fail(hal::ErrorCode::timed_out,
                   "{}: no whole answer within 2 s; the appliance is busy or ending, try again",
                   socket.string());
}

} // namespace octascope::firmware_host

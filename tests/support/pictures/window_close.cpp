#include "tests/support/pictures/window_close.h"

#include <array>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace octascope::tests {

namespace {

// Little-endian numbers and texts in a row, as the protocol wants them.
class Message {
public:
  Message& u8(std::uint8_t value) { return number(value); }
  Message& u16(std::uint16_t value) { return number(value); }
  Message& u32(std::uint32_t value) { return number(value); }
  Message& text(std::string_view value) {
    for (const char character : value)
      bytes_.push_back(character);
    while (bytes_.size() % 4 != 0)
      bytes_.push_back(0);
    return *this;
  }
  const std::vector<char>& bytes() const { return bytes_; }

private:
  template <class Value> Message& number(Value value) {
    for (std::size_t byte = 0; byte < sizeof value; ++byte)
      bytes_.push_back(static_cast<char>(std::uint32_t{value} >> (8 * byte) & 0xFF));
    return *this;
  }
  std::vector<char> bytes_;
};

class Connection {
public:
  explicit Connection(const std::string& display)
      : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = "/tmp/.X11-unix/X" + display.substr(1);
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    good_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { ::close(socket_); }

  // Byte order, version 11.0, no authorisation.
  void greet() {
    send(Message{}.u8('l').u8(0).u16(11).u16(0).u16(0).u16(0).u16(0));
    std::array<char, 8> head{};
    receive(head);
    good_ = good_ && head[0] == 1;
    std::uint16_t words = 0;
    std::memcpy(&words, &head[6], sizeof words);
    std::vector<char> rest(std::size_t{4} * words);
    receive(rest);
  }

  std::uint32_t atom(std::string_view name) {
    const auto length = static_cast<std::uint16_t>(name.size());
    send(Message{}
             .u8(16)
             .u8(0)
             .u16(static_cast<std::uint16_t>(2 + (length + 3) / 4))
             .u16(length)
             .u16(0)
             .text(name));
    const auto answer = receive_reply();
    std::uint32_t value = 0;
    std::memcpy(&value, &answer[8], sizeof value);
    return value;
  }

  // Returns when the server has taken it.
  void send_client_message(std::uint32_t window, std::uint32_t type, std::uint32_t value) {
    Message message;
    message.u8(25).u8(0).u16(11).u32(window).u32(0); // SendEvent, to the window's client
    message.u8(33).u8(32).u16(0).u32(window).u32(type).u32(value);
    message.u32(0).u32(0).u32(0).u32(0);
    send(message);
    send(Message{}.u8(43).u8(0).u16(1)); // GetInputFocus, for its answer
    receive_reply();
  }

  bool good() const { return good_; }

private:
  void send(const Message& message) {
    const auto& bytes = message.bytes();
    good_ = good_ && ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
                         static_cast<ssize_t>(bytes.size());
  }
  void receive(std::span<char> bytes) {
    good_ = good_ && (bytes.empty() || ::recv(socket_, bytes.data(), bytes.size(), MSG_WAITALL) ==
                                           static_cast<ssize_t>(bytes.size()));
  }
  std::array<char, 32> receive_reply() {
    std::array<char, 32> answer{};
    receive(answer);
    good_ = good_ && answer[0] == 1; // neither an error nor an event
    return answer;
  }

  int socket_;
  bool good_ = false;
};

} // namespace

std::string close_window(const std::string& display, std::uint32_t window) {
  Connection server{display};
  if (!server.good())
    return "no X server at " + display;
  server.greet();
  if (!server.good())
    return "the X server lets nobody in";
  const std::uint32_t protocols = server.atom("WM_PROTOCOLS");
  const std::uint32_t delete_window = server.atom("WM_DELETE_WINDOW");
  server.send_client_message(window, protocols, delete_window);
  return server.good() ? "" : "the X server did not take the message";
}

} // namespace octascope::tests

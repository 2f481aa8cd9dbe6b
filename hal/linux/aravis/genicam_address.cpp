#include "hal/linux/aravis/genicam_address.h"

#include <arpa/inet.h>
#include <fmt/format.h>

namespace octascope::hal::linux_backend {

namespace {

constexpr std::string_view usb = "usb3vision";
constexpr std::string_view gige = "gigevision";

// What follows "kind:"; empty for the kind alone; nothing for another kind.
std::optional<std::string_view> name_after(std::string_view kind, std::string_view text) {
  if (text == kind)
    return std::string_view{};
  if (text.starts_with(kind) && text[kind.size()] == ':')
    return text.substr(kind.size() + 1);
  return std::nullopt;
}

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1;
}

} // namespace

bool GenicamAddress::simulated() const {
  return bus == Bus::gige_vision && name.starts_with("127.");
}

Result<std::optional<GenicamAddress>> parse_genicam_address(std::string_view text) {
  using Bus = GenicamAddress::Bus;
  if (const auto name = name_after(usb, text))
    return GenicamAddress{Bus::usb3_vision, std::string{*name}};
  const auto name = name_after(gige, text);
  if (!name)
    return std::nullopt;
  GenicamAddress address{Bus::gige_vision, std::string{*name}};
  if (!is_ipv4(address.name))
    return fail(ErrorCode::invalid_argument,
                "\"{}\" has no IPv4 address, expected one as in \"gigevision:192.168.1.20\": no "
                "camera is looked for on a network",
                text);
  return address;
}

std::string to_text(const GenicamAddress& address) {
  const std::string kind{address.bus == GenicamAddress::Bus::usb3_vision ? usb : gige};
  return address.name.empty() ? kind : fmt::format("{}:{}", kind, address.name);
}

} // namespace octascope::hal::linux_backend

#include "hal/linux/kms/drm/connector_watch.h"

#include <array>
#include <cerrno>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend::kms {

ConnectorWatch::ConnectorWatch(const Card& card, const Connector& connector)
    : node_{card.node}, was_connected_{connector.status == ConnectionStatus::connected} {
  const std::string file =
      fmt::format("/sys/class/drm/{}-{}/status", card_name(card), connector.name);
  if (auto opened = open_device(file, O_RDONLY))
    status_ = *std::move(opened);
  if (auto events = DeviceWatch::on("drm"))
    events_ = *std::move(events);
}

bool ConnectorWatch::disconnected() const {
  if (!status_ || !was_connected_)
    return false;
  std::array<char, 16> text{};
  const ssize_t length = ::pread(status_.get(), text.data(), text.size(), 0);
  if (length < 0)
    return errno == ENODEV; // the card itself is gone
  return std::string_view{text.data(), static_cast<std::size_t>(length)}.starts_with(
      "disconnected");
}

bool ConnectorWatch::changed() {
  bool ours = false;
  while (const auto change = events_ ? events_->next(Duration{0}) : std::nullopt)
    ours = ours || change->node == node_;
  return ours;
}

} // namespace octascope::hal::linux_backend::kms

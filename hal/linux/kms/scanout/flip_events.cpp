#include "hal/linux/kms/scanout/flip_events.h"

#include <cstring>

#include <drm.h>

namespace octascope::hal::linux_backend::kms {

std::optional<FlipEvent> take_flip(std::span<const std::byte>& bytes) {
  while (bytes.size() >= sizeof(drm_event)) {
    drm_event head{};
    std::memcpy(&head, bytes.data(), sizeof head);
    if (head.length < sizeof head || head.length > bytes.size())
      break;
    const auto whole = bytes.first(head.length);
    bytes = bytes.subspan(head.length);
    if (head.type != DRM_EVENT_FLIP_COMPLETE || whole.size() < sizeof(drm_event_vblank))
      continue;
    drm_event_vblank flip{};
    std::memcpy(&flip, whole.data(), sizeof flip);
    return FlipEvent{flip.user_data, TimePoint{std::chrono::seconds{flip.tv_sec} +
                                               std::chrono::microseconds{flip.tv_usec}}};
  }
  bytes = {};
  return std::nullopt;
}

} // namespace octascope::hal::linux_backend::kms

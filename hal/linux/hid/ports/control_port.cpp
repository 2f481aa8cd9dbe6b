#include "hal/linux/hid/ports/control_port.h"

#include <fmt/format.h>

#include "hal/linux/hid/ports/evdev_port.h"
#include "hal/linux/hid/ports/raw_port.h"

namespace octascope::hal::linux_backend {

Result<std::unique_ptr<ControlPort>> ControlPort::open(const HidNode& node,
                                                       const ControlModel& model) {
  auto port = model.by_evdev() ? open_evdev_port(node, model) : open_raw_port(node, model);
  if (!port)
    return fail(port.error().code, "{} ({}): {}{}", model.name, usb_id(model.vendor, model.product),
                port.error().message, remedy_of_control(node.node, port.error().code));
  return port;
}

std::string remedy_of_control(const std::string& node, ErrorCode fault) {
  if (fault == ErrorCode::denied)
    return "; or let the udev rule give access: `sudo cp deploy/70-octascope.rules "
           "/etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger`";
  if (fault == ErrorCode::busy)
    return fmt::format("; a key remapper or another octascope may have grabbed {}", node);
  return {};
}

} // namespace octascope::hal::linux_backend

#include "hal/linux/hid/models/udev_rules.h"

#include <set>

#include <fmt/format.h>

namespace octascope::hal::linux_backend {

namespace {

// The kernel names a HID device bus:vendor:product.number, whatever its bus is.
std::string rule(const ControlModel& model) {
  if (model.by_evdev())
    return fmt::format("SUBSYSTEM==\"input\", KERNEL==\"event*\", ATTRS{{id/vendor}}==\"{:04x}\", "
                       "ATTRS{{id/product}}==\"{:04x}\", GROUP=\"input\", MODE=\"0660\", "
                       "TAG+=\"uaccess\"\n",
                       model.vendor, model.product);
  return fmt::format("SUBSYSTEM==\"hidraw\", KERNELS==\"*:{:04X}:{:04X}.*\", GROUP=\"input\", "
                     "MODE=\"0660\", TAG+=\"uaccess\"\n",
                     model.vendor, model.product);
}

} // namespace

std::string udev_rules(const std::vector<ControlModel>& models) {
  std::string text =
      "# Who may open octascope's pedals, knobs and GPIO chips: the group input or gpio, and "
      "whoever\n"
      "# sits at the machine. Made from the list of controls in "
      "hal/linux/hid/models/control_model.cpp;\n"
      "# a test compares the two.\n"
      "#   sudo groupadd -f -r gpio; sudo cp deploy/70-octascope.rules /etc/udev/rules.d/\n"
      "#   sudo udevadm control --reload && sudo udevadm trigger\n";
  std::set<std::string> written; // models of one vendor and product share a rule
  for (const ControlModel& model : models)
    if (const std::string line = rule(model); written.insert(line).second)
      text += fmt::format("\n# {}\n{}", model.name, line);
  text += "\n# galvo trigger\nSUBSYSTEM==\"gpio\", KERNEL==\"gpiochip*\", GROUP=\"gpio\", "
          "MODE=\"0660\"\n";
  return text;
}

} // namespace octascope::hal::linux_backend

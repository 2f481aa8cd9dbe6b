#include "firmware-host/diagnosis/hardware_checks.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "firmware-host/devices/node_access.h"

namespace octascope::firmware_host {

namespace {

HealthCheck good(const char* subject, std::string found) {
  return {subject, Verdict::good, std::move(found), ""};
}

HealthCheck check_udev(const MachineFacts& machine) {
  if (machine.udev_runs)
    return good("udev", "the daemon runs");
  return {"udev", Verdict::limited,
          "the daemon does not run: permissions are not set, libcamera finds no camera, and what "
          "is plugged in later goes unnoticed",
          start_udev_command};
}

HealthCheck check_rules(const HardwareSurvey& survey) {
  if (survey.machine.rules_installed)
    return good("udev rules", "installed");
  if (survey.hid.empty() && survey.gpio.empty())
    return good("udev rules", "not installed, and neither pedal nor GPIO chip is plugged in");
  return {"udev rules", Verdict::limited,
          "not installed: pedals and the trigger line are for root alone", install_rules_command};
}

std::string module_for(std::string_view device) {
  return device.starts_with("USB camera") ? "uvcvideo" : "usbhid";
}

HealthCheck check_drivers(const MachineFacts& machine) {
  if (!machine.without_driver.empty()) {
    const std::string& first = machine.without_driver.front();
    const auto more = machine.without_driver.size() - 1;
    return {"drivers", Verdict::limited,
            fmt::format("{} is plugged in, but no driver holds it{}", first,
                        more > 0 ? fmt::format(" ({} more likewise)", more) : ""),
            fmt::format("sudo modprobe {}; if that says that there is no such module: sudo apt-get "
                        "install linux-image-amd64",
                        module_for(first))};
  }
  if (!machine.has_graphics_driver)
    return {"drivers", Verdict::limited,
            "there is a graphics card, but the kernel has no driver for it",
            "see `sudo dmesg | grep -i firmware` for the file it misses, then sudo apt-get install "
            "firmware-misc-nonfree firmware-amd-graphics"};
  return good("drivers", "everything that is plugged in has one");
}

// The devices that this user may not open, each with its remedy.
std::vector<HealthCheck> check_permissions(const HardwareSurvey& survey) {
  std::vector<HealthCheck> checks;
  const auto judge = [&](const char* subject, const std::vector<FoundDevice>& devices) {
    const auto refused = [](const FoundDevice& device) { return !device.usable; };
    const auto first = std::ranges::find_if(devices, refused);
    if (devices.empty())
      return;
    if (first == devices.end()) {
      checks.push_back(good(subject, fmt::format("{} found, this user may open {}", devices.size(),
                                                 devices.size() == 1 ? "it" : "all of them")));
      return;
    }
    const auto count = std::ranges::count_if(devices, refused);
    checks.push_back({subject, Verdict::limited,
                      fmt::format("{} of {} cannot be used; {} ({}): {}", count, devices.size(),
                                  first->node, first->name, first->why_not),
                      first->remedy});
  };
  judge("cameras", survey.video);
  judge("media controllers", survey.media);
  judge("GPIO chips", survey.gpio);
  judge("pedals and knobs", survey.hid);
  judge("input events", survey.input);
  judge("graphics access", survey.render);
  return checks;
}

// A camera that another program has open is most often busy to us.
std::vector<HealthCheck> check_holders(const HardwareSurvey& survey) {
  std::vector<HealthCheck> checks;
  for (const auto* list : {&survey.video, &survey.gpio, &survey.hid})
    for (const FoundDevice& device : *list)
      if (!device.held_by.empty())
        checks.push_back(
            {"other programs", Verdict::limited,
             fmt::format("{} ({}) is open in {}", device.node, device.name, device.held_by),
             fmt::format("nothing, if that is what feeds it; if it is busy to octascope, end that "
                         "program: sudo fuser -k {}",
                         device.node)});
  return checks;
}

std::string fact(const FoundDevice& device, std::string_view key) {
  for (const auto& [name, value] : device.facts)
    if (name == key)
      return value;
  return "unknown";
}

std::vector<HealthCheck> check_display(const HardwareSurvey& survey) {
  if (survey.displays.empty())
    return {};
  for (const FoundDevice& display : survey.displays)
    if (display.usable)
      return {good("display", fmt::format("{}: {}, prefers {}", display.node,
                                          fact(display, "monitor"), fact(display, "mode")))};
  const auto connected = std::ranges::find_if(
      survey.displays, [](const FoundDevice& display) { return display.name == "connected"; });
  const FoundDevice& display =
      connected != survey.displays.end() ? *connected : survey.displays.front();
  return {{"display", Verdict::limited, fmt::format("{}: {}", display.node, display.why_not),
           display.remedy}};
}

} // namespace

std::vector<HealthCheck> check_hardware(const HardwareSurvey& survey) {
  std::vector<HealthCheck> checks{check_udev(survey.machine), check_rules(survey),
                                  check_drivers(survey.machine)};
  for (auto more : {check_permissions(survey), check_holders(survey), check_display(survey)})
    checks.insert(checks.end(), std::make_move_iterator(more.begin()),
                  std::make_move_iterator(more.end()));
  return checks;
}

} // namespace octascope::firmware_host

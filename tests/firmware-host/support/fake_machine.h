// A folder that looks like a machine's /sys, /dev, /run, /etc and /proc, as far as the survey
// looks.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include "firmware-host/devices/hardware_survey.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::tests {

class FakeMachine {
public:
  void add(const std::string& file, std::string_view text = "") {
    std::filesystem::create_directories((folder_.path() / file).parent_path());
    folder_.write(file, std::string{text});
  }
  // A node in /dev; `refused` to this user. Its group is whoever runs the test.
  void add_node(const std::string& node, bool refused = false, unsigned mode = 0660) {
    add(node.substr(1));
    ::chmod((folder_.path() / node.substr(1)).c_str(), mode);
    if (refused)
      refused_.insert(folder_.path() / node.substr(1));
  }
  // Gives a node to a group that is not root's, and tells its name.
  std::string give_to_a_group(const std::string& node) {
    const gid_t own = ::getegid();
    const group* const video = ::getgrnam("video");
    const gid_t other = own == 0 && video != nullptr ? video->gr_gid : own;
    static_cast<void>(::chown((folder_.path() / node.substr(1)).c_str(), ::geteuid(), other) == 0);
    const group* const entry = ::getgrgid(other);
    return entry != nullptr ? entry->gr_name : std::to_string(other);
  }
  void link(const std::string& from, const std::string& to) {
    std::filesystem::create_directories((folder_.path() / from).parent_path());
    std::filesystem::create_symlink(to, folder_.path() / from);
  }
  void add_camera(const std::string& name, std::string_view title, bool refused = false) {
    add("sys/class/video4linux/" + name + "/name", std::string{title} + "\n");
    add_node("/dev/" + name, refused);
  }
  void add_pedal(const std::string& name, std::string_view title, bool refused = false,
                 unsigned mode = 0660) {
    add("sys/class/hidraw/" + name + "/device/uevent",
        "DRIVER=hid-generic\nHID_ID=0003:000005F3:000000FF\nHID_NAME=" + std::string{title} +
            "\nHID_NAMES=no\n");
    add_node("/dev/" + name, refused, mode);
  }
  void add_connector(const std::string& name, std::string_view status,
                     std::string_view modes = "") {
    add("sys/class/drm/" + name + "/status", std::string{status} + "\n");
    add("sys/class/drm/" + name + "/modes", modes);
    add("sys/class/drm/" + name + "/enabled", "enabled\n");
  }
  // What every machine has that is well.
  void make_healthy() {
    add("run/udev/control");
    add("etc/udev/rules.d/70-octascope.rules");
  }

  // As one who may open all but what was refused.
  firmware_host::HardwareSurvey survey(std::vector<std::string> groups = {},
                                       std::vector<std::string> future_groups = {}) const {
    return firmware_host::survey_hardware(
        folder_.path(),
        {[this](const std::filesystem::path& file) { return !refused_.contains(file); },
         std::move(groups), std::move(future_groups)});
  }

private:
  ScratchFolder folder_;
  std::set<std::filesystem::path> refused_;
};

} // namespace octascope::tests

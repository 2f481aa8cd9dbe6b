#include "firmware-host/devices/node_access.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/linux/system/system_files.h"

namespace octascope::firmware_host {

namespace fs = std::filesystem;

const char* const install_rules_command =
    "sudo cp deploy/70-octascope.rules /etc/udev/rules.d/ && sudo udevadm control --reload "
    "&& sudo udevadm trigger";
const char* const start_udev_command = "sudo systemctl start systemd-udevd systemd-udev-trigger";

namespace {

std::string group_name(gid_t id) {
  std::array<char, 4096> text{};
  group entry{};
  group* found = nullptr;
  if (::getgrgid_r(id, &entry, text.data(), text.size(), &found) == 0 && found != nullptr)
    return entry.gr_name;
  return std::to_string(id);
}

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::ranges::find(list, name) != list.end();
}

// With what right the node's group may open it.
struct NodeOwner {
  std::string group;
  bool group_may_open = false;
};

std::optional<NodeOwner> owner_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0)
    return std::nullopt;
  return NodeOwner{group_name(status.st_gid), (status.st_mode & 0060) == 0060};
}

std::vector<std::string> groups_of_session() {
  std::vector<gid_t> ids(static_cast<std::size_t>(std::max(::getgroups(0, nullptr), 0)));
  if (::getgroups(static_cast<int>(ids.size()), ids.data()) < 0)
    ids.clear();
  ids.push_back(::getegid());
  std::vector<std::string> names;
  for (const gid_t id : ids)
    names.push_back(group_name(id));
  return names;
}

std::vector<std::string> groups_after_login() {
  std::array<char, 4096> text{};
  passwd entry{};
  passwd* found = nullptr;
  if (::getpwuid_r(::geteuid(), &entry, text.data(), text.size(), &found) != 0 || found == nullptr)
    return {};
  std::vector<gid_t> ids(256);
  int count = static_cast<int>(ids.size());
  if (::getgrouplist(entry.pw_name, entry.pw_gid, ids.data(), &count) < 0)
    return {};
  ids.resize(static_cast<std::size_t>(count));
  std::vector<std::string> names;
  for (const gid_t id : ids)
    names.push_back(group_name(id));
  return names;
}

} // namespace

Person Person::this_user() {
  return {[](const fs::path& file) { return ::access(file.c_str(), R_OK | W_OK) == 0; },
          groups_of_session(), groups_after_login()};
}

void judge_access(FoundDevice& device, const fs::path& root, const Person& person) {
  const fs::path file = root / fs::path{device.node}.relative_path();
  const auto owner = owner_of(file);
  if (!owner) {
    device.usable = false;
    device.why_not = fmt::format("the kernel lists it, but {} is not there", device.node);
    device.remedy = start_udev_command;
    return;
  }
  if (person.may_open(file))
    return;
  device.usable = false;
  if (!owner->group_may_open || owner->group == "root") {
    device.why_not = "only root may open it: the appliance's udev rules are missing or do not "
                     "know it";
    device.remedy = install_rules_command;
  } else if (contains(person.groups, owner->group)) {
    device.why_not =
        fmt::format("this user is in its group {}, and yet may not open it", owner->group);
    device.remedy = fmt::format("see who may: getfacl {}", device.node);
  } else if (contains(person.future_groups, owner->group)) {
    device.why_not = fmt::format("this user joined its group {} after logging in", owner->group);
    device.remedy = "log out and in again (or restart the machine)";
  } else {
    device.why_not = fmt::format("this user is not in its group {}", owner->group);
    device.remedy =
        fmt::format("sudo usermod -aG {} $USER, then log out and in again", owner->group);
  }
}

std::map<std::string, std::string> holders_of_nodes(const fs::path& root) {
  std::map<std::string, std::string> holders;
  const std::string own = std::to_string(::getpid());
  std::error_code error;
  for (fs::directory_iterator it{root / "proc", error}, end; !error && it != end;
       it.increment(error)) {
    const std::string pid = it->path().filename().string();
    if (pid == own || pid.find_first_not_of("0123456789") != std::string::npos)
      continue;
    const std::string holder =
        fmt::format("{} ({})", hal::linux_backend::first_line(it->path() / "comm"), pid);
    std::error_code ignored; // it ended meanwhile, or is another user's
    for (fs::directory_iterator file{it->path() / "fd", ignored}, none; !ignored && file != none;
         file.increment(ignored)) {
      std::error_code unreadable;
      const std::string target = fs::read_symlink(file->path(), unreadable).string();
      if (!target.starts_with("/dev/"))
        continue;
      std::string& all = holders[target];
      if (all.find(holder) == std::string::npos)
        all += (all.empty() ? "" : ", ") + holder;
    }
  }
  return holders;
}

} // namespace octascope::firmware_host

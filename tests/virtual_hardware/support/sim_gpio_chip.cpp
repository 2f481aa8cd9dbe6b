#include "tests/virtual_hardware/support/sim_gpio_chip.h"

#include <cerrno>
#include <fstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"

namespace octascope::tests {

using hal::Result;
using hal::linux_backend::FileDescriptor;
using hal::linux_backend::open_device;
using hal::linux_backend::system_failure;

namespace {

const std::string root = "/sys/kernel/config/gpio-sim";

Result<> write_text(const std::string& file, const std::string& text) {
  HAL_TRY(const auto opened, open_device(file, O_WRONLY));
  if (::write(opened.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    return system_failure(file, "writing \"" + text + "\"", errno);
  return {};
}

std::string read_line(const std::string& file) {
  std::ifstream in{file};
  std::string line;
  std::getline(in, line);
  return line;
}

Result<> make_folder(const std::string& folder) {
  if (::mkdir(folder.c_str(), 0755) != 0)
    return system_failure(folder, "making it", errno);
  return {};
}

} // namespace

std::string sim_gpio_missing() {
  if (::access(root.c_str(), F_OK) != 0)
    return "there is no " + root + ": this kernel has no gpio-sim, or configfs is not mounted";
  if (::access(root.c_str(), W_OK) != 0)
    return "no permission to write to " + root;
  return {};
}

Result<std::unique_ptr<SimGpioChip>> SimGpioChip::make(std::string name,
                                                       std::vector<std::string> line_names) {
  std::unique_ptr<SimGpioChip> chip{new SimGpioChip{std::move(name), std::move(line_names)}};
  HAL_CHECK(chip->describe());
  HAL_CHECK(chip->restore());
  return chip;
}

SimGpioChip::SimGpioChip(std::string name, std::vector<std::string> line_names)
    : folder_{root + "/" + std::move(name)}, line_names_{std::move(line_names)} {}

SimGpioChip::~SimGpioChip() {
  (void)remove(); // may be removed already
  for (std::size_t line = 0; line < line_names_.size(); ++line)
    ::rmdir((folder_ + "/bank0/line" + std::to_string(line)).c_str());
  ::rmdir((folder_ + "/bank0").c_str());
  ::rmdir(folder_.c_str());
}

Result<> SimGpioChip::describe() {
  const std::string bank = folder_ + "/bank0";
  Result<> done = make_folder(folder_).and_then([&] { return make_folder(bank); }).and_then([&] {
    return write_text(bank + "/num_lines", std::to_string(line_names_.size()));
  });
  for (std::size_t line = 0; done && line < line_names_.size(); ++line) {
    if (line_names_[line].empty())
      continue;
    const std::string folder = bank + "/line" + std::to_string(line);
    done = make_folder(folder).and_then(
        [&] { return write_text(folder + "/name", line_names_[line]); });
  }
  return done;
}

Result<> SimGpioChip::remove() {
  const std::lock_guard lock{mutex_};
  levels_.clear();
  return write_text(folder_ + "/live", "0");
}

Result<> SimGpioChip::restore() {
  const std::lock_guard lock{mutex_};
  return write_text(folder_ + "/live", "1").and_then([this] { return find_lines(); });
}

Result<> SimGpioChip::find_lines() {
  device_ = read_line(folder_ + "/dev_name");
  chip_ = read_line(folder_ + "/bank0/chip_name");
  levels_.clear();
  for (unsigned line = 0; line < line_names_.size(); ++line) {
    HAL_TRY(auto level, open_device(line_folder(line) + "/value", O_RDONLY));
    levels_.push_back(std::move(level));
  }
  return {};
}

std::string SimGpioChip::line_folder(unsigned line) const {
  return "/sys/devices/platform/" + device_ + "/" + chip_ + "/sim_gpio" + std::to_string(line);
}

bool SimGpioChip::level(unsigned line) const {
  const std::lock_guard lock{mutex_};
  char value = '0';
  return line < levels_.size() && ::pread(levels_[line].get(), &value, 1, 0) == 1 && value == '1';
}

Result<> SimGpioChip::pull(unsigned line, bool high) {
  const std::lock_guard lock{mutex_};
  return write_text(line_folder(line) + "/pull", high ? "pull-up" : "pull-down");
}

std::string SimGpioChip::node() const {
  const std::lock_guard lock{mutex_};
  return "/dev/" + chip_;
}

} // namespace octascope::tests

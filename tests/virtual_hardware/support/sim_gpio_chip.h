// A GPIO chip without hardware: the kernel's gpio-sim, made through configfs (which must be mounted
// at /sys/kernel/config; needs root). The other end of its lines is here: what level an output has,
// and what an input is pulled to.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::tests {

// Why no chip can be made here; empty when one can.
std::string sim_gpio_missing();

// Threads: free, so that one can pull the plug while another is the scanner.
class SimGpioChip {
public:
  // `name` is that of its folder in configfs, new; lines without a name are "".
  static hal::Result<std::unique_ptr<SimGpioChip>> make(std::string name,
                                                        std::vector<std::string> line_names);
  ~SimGpioChip();
  SimGpioChip(const SimGpioChip&) = delete;
  SimGpioChip& operator=(const SimGpioChip&) = delete;

  // As if its plug were pulled, in the middle of whatever goes on; and put in again. Its number may
  // be another one then. Linux 6.1 never gives back the numbers of lines that were held when their
  // chip went, and has 512 in all: a test that pulls often wants a chip of one line.
  hal::Result<> remove();
  hal::Result<> restore();

  // False also while it is removed. No allocation.
  bool level(unsigned line) const;
  hal::Result<> pull(unsigned line, bool high);

  // "/dev/gpiochip0".
  std::string node() const;

private:
  SimGpioChip(std::string name, std::vector<std::string> line_names);
  hal::Result<> describe();
  hal::Result<> find_lines();
  std::string line_folder(unsigned line) const;

  const std::string folder_; // in configfs
  const std::vector<std::string> line_names_;
  mutable std::mutex mutex_; // of what follows
  std::string chip_;         // "gpiochip0"
  std::string device_;       // "gpio-sim.0"
  std::vector<hal::linux_backend::FileDescriptor> levels_;
};

} // namespace octascope::tests

// Stands in the place of hidapi, so that what uses it runs without a device; and of the one ioctl
// by which a node is asked whether it is a HID device. Nodes are ordinary files of the test's.
//
// It keeps its last errors as hidapi does, unguarded, for the whole process and for each device:
// the thread sanitizer finds whoever breaks hidapi's thread rules.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace octascope::tests {

// One at a time. hidapi's functions have no place for an object: this is the process's.
class FakeHidapi {
public:
  FakeHidapi();
  FakeHidapi(const FakeHidapi&) = delete;
  FakeHidapi& operator=(const FakeHidapi&) = delete;
  ~FakeHidapi();

  // Listed `usages` times, as hidapi does it.
  void plug(const std::string& node, std::uint16_t vendor, std::uint16_t product, int usages = 1);
  void send(const std::string& node, std::vector<std::uint8_t> report);
  // Reading fails when all that was sent has been read.
  void pull(const std::string& node);
  // So many next readings fail, and nothing is gone.
  void break_off_reading(const std::string& node, int times);
  void refuse_to_open(bool refuses);

  std::vector<std::vector<std::uint8_t>> written(const std::string& node) const;
  int open_devices() const;
  int begun() const; // how often hid_init() was called, less hid_exit()
};

} // namespace octascope::tests

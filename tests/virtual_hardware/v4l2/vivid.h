// The kernel's virtual video driver (vivid) as a line camera that can be made to fail.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/linux/system/file_descriptor.h"

namespace octascope::tests {

class Vivid {
public:
  // Its capture node; nothing where the driver is missing.
  static std::optional<Vivid> find();

  // No fault from before is left, and the input is one of any size (HDMI).
  void reset() const;

  // A control by its name; a button is pressed with 0. False when it cannot be set.
  bool set(std::string_view name, std::int64_t value = 0) const;

  // As long as it is held the driver does not come back from a disconnect.
  hal::linux_backend::FileDescriptor hold() const;

  const std::string& node() const { return node_; }

  static constexpr int any_size_input = 3;

private:
  explicit Vivid(std::string node) : node_{std::move(node)} {}
  std::string node_;
};

} // namespace octascope::tests

// The named properties of a KMS object (plane, CRTC, connector), by which atomic commits speak.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend::kms {

class ObjectProperties {
public:
  ObjectProperties() = default;
  // `kind`: DRM_MODE_OBJECT_…. Empty where the card tells nothing.
  ObjectProperties(const FileDescriptor& card, std::uint32_t object, std::uint32_t kind);

  // 0: it has no such property.
  std::uint32_t id(std::string_view name) const;
  // At the time of construction.
  std::optional<std::uint64_t> value(std::string_view name) const;

private:
  struct Property {
    std::string name;
    std::uint32_t id = 0;
    std::uint64_t value = 0;
  };
  const Property* find(std::string_view name) const;

  std::vector<Property> properties_;
};

} // namespace octascope::hal::linux_backend::kms

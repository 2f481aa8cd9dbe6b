// The named properties of a KMS object (plane, CRTC, connector), which atomic commits set.
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
  // `kind`: DRM_MODE_OBJECT_…. Has no properties if the card returns none.
  ObjectProperties(const FileDescriptor& card, std::uint32_t object, std::uint32_t kind);

  // 0 if there is no such property.
  std::uint32_t id(std::string_view name) const;
  // The value at construction.
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

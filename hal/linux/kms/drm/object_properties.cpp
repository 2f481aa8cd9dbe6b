#include "hal/linux/kms/drm/object_properties.h"

#include "hal/linux/kms/drm/drm_resource.h"

namespace octascope::hal::linux_backend::kms {

ObjectProperties::ObjectProperties(const FileDescriptor& card, std::uint32_t object,
                                   std::uint32_t kind) {
  const DrmObjectProperties all{drmModeObjectGetProperties(card.get(), object, kind)};
  if (!all)
    return;
  for (std::uint32_t i = 0; i < all->count_props; ++i)
    if (const DrmProperty property{drmModeGetProperty(card.get(), all->props[i])})
      properties_.push_back({property->name, property->prop_id, all->prop_values[i]});
}

const ObjectProperties::Property* ObjectProperties::find(std::string_view name) const {
  for (const Property& property : properties_)
    if (property.name == name)
      return &property;
  return nullptr;
}

std::uint32_t ObjectProperties::id(std::string_view name) const {
  const Property* const property = find(name);
  return property != nullptr ? property->id : 0;
}

std::optional<std::uint64_t> ObjectProperties::value(std::string_view name) const {
  const Property* const property = find(name);
  return property != nullptr ? std::optional{property->value} : std::nullopt;
}

} // namespace octascope::hal::linux_backend::kms

#include "hal/linux/kms/scanout/atomic_request.h"

#include <cerrno>

#include <xf86drm.h>

namespace octascope::hal::linux_backend::kms {

namespace {

template <class T> std::uint64_t address_of(const std::vector<T>& values) {
  return reinterpret_cast<std::uintptr_t>(values.data());
}

} // namespace

AtomicRequest::AtomicRequest() {
  objects_.reserve(4);
  counts_.reserve(4);
  properties_.reserve(16);
  values_.reserve(16);
}

void AtomicRequest::clear() {
  objects_.clear();
  counts_.clear();
  properties_.clear();
  values_.clear();
}

void AtomicRequest::object(std::uint32_t object) {
  objects_.push_back(object);
  counts_.push_back(0);
}

void AtomicRequest::set(std::uint32_t property, std::uint64_t value) {
  if (property == 0)
    return;
  properties_.push_back(property);
  values_.push_back(value);
  ++counts_.back();
}

int AtomicRequest::commit(const FileDescriptor& card, std::uint32_t flags,
                          std::uint64_t number) const {
  drm_mode_atomic request{};
  request.flags = flags;
  request.count_objs = static_cast<std::uint32_t>(objects_.size());
  request.objs_ptr = address_of(objects_);
  request.count_props_ptr = address_of(counts_);
  request.props_ptr = address_of(properties_);
  request.prop_values_ptr = address_of(values_);
  request.user_data = number;
  return drmIoctl(card.get(), DRM_IOCTL_MODE_ATOMIC, &request) == 0 ? 0 : errno;
}

} // namespace octascope::hal::linux_backend::kms

// Properties of several objects, changed in one commit. libdrm's own request allocates and sorts
// anew at every commit; this one keeps its memory.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend::kms {

class AtomicRequest {
public:
  AtomicRequest();
  void clear();
  // What follows belongs to `object`. An object is named once.
  void object(std::uint32_t object);
  // Nothing happens where `property` is 0: the object does not have it.
  void set(std::uint32_t property, std::uint64_t value);
  // 0 or an errno. `number` comes back with the event, where the flags ask for one.
  int commit(const FileDescriptor& card, std::uint32_t flags, std::uint64_t number) const;

private:
  std::vector<std::uint32_t> objects_;
  std::vector<std::uint32_t> counts_; // of properties, for each object
  std::vector<std::uint32_t> properties_;
  std::vector<std::uint64_t> values_;
};

} // namespace octascope::hal::linux_backend::kms

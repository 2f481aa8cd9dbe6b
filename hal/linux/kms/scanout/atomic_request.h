// Changes properties of several objects in one commit. libdrm's own request allocates and sorts at
// every commit; this one keeps its memory.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend::kms {

class AtomicRequest {
public:
  AtomicRequest();
  void clear();
  // The following set() calls are for `object`. Call it once per object.
  void object(std::uint32_t object);
  // Does nothing if `property` is 0: the object does not have it.
  void set(std::uint32_t property, std::uint64_t value);
  // Returns 0 or an errno. If the flags request an event, it carries `number`.
  int commit(const FileDescriptor& card, std::uint32_t flags, std::uint64_t number) const;

private:
  std::vector<std::uint32_t> objects_;
  std::vector<std::uint32_t> counts_; // of properties, for each object
  std::vector<std::uint32_t> properties_;
  std::vector<std::uint64_t> values_;
};

} // namespace octascope::hal::linux_backend::kms

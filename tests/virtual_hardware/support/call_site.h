// Where a system call is made: which functions of ours and of the libraries led to it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace octascope::tests {

// The return addresses from one caller up, as far as the stack of this thread goes. Takes no lock
// and allocates nothing, but for names().
class CallStack {
public:
  // From the frame that returns to `caller` up, else (null) from here; it ends at `root`, a
  // function's address, where that is on the stack.
  static CallStack from(const void* caller, const void* root);

  // Of the addresses as the modules have them: the same in every process of one program, wherever
  // its libraries were mapped.
  std::uint64_t hash() const;

  // "libdrm.so.2 drmIoctl < libdrm.so.2 drmModeSetPlane < bench_kms": the innermost first;
  // functions that their module does not export have no name, and those in a row are told once.
  std::string names(std::size_t most) const;

private:
  std::span<const std::uintptr_t> addresses() const { return {addresses_.data(), count_}; }

  std::array<std::uintptr_t, 96> addresses_{};
  std::size_t count_ = 0;
};

} // namespace octascope::tests

// Which module an address lies in; usable in the handler of a fatal signal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace octascope::firmware_host {

// The process's mappings (proc_pid_maps(5)), read into preallocated memory. read() and find() are
// async-signal-safe; one thread. Large: make it static or part of something static.
class ModuleMap {
public:
  struct Place {
    std::string_view module;  // path, "[vdso]" …; empty: in none
    std::uint64_t offset = 0; // from where the module begins, as addr2line -e wants it
  };

  // Mappings that do not fit are left out.
  void read(const char* file = "/proc/self/maps");
  Place find(std::uint64_t address) const;

private:
  std::array<char, 512UL * 1024> text_{};
  std::size_t size_ = 0;
};

} // namespace octascope::firmware_host

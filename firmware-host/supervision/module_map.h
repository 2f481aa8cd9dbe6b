// Which module an address lies in, found from the handler of a fatal signal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace octascope::firmware_host {

// The process's own list of mappings (proc_pid_maps(5)), read into memory that was there before.
// read() and find() are async-signal-safe; one thread. Large: static, or within something static.
class ModuleMap {
public:
  struct Place {
    std::string_view module;  // path, "[vdso]" …; empty: in none
    std::uint64_t offset = 0; // from where the module begins, as addr2line -e wants it
  };

  // What does not fit is left out.
  void read(const char* file = "/proc/self/maps");
  Place find(std::uint64_t address) const;

private:
  std::array<char, 512UL * 1024> text_{};
  std::size_t size_ = 0;
};

} // namespace octascope::firmware_host

#include "tests/virtual_hardware/support/call_site.h"

#include <cstdlib>
#include <memory>
#include <string_view>

#include <cxxabi.h>
#include <dlfcn.h>
#include <link.h>
#include <unwind.h>

namespace octascope::tests {

namespace {

struct Walk {
  std::uintptr_t caller; // 0: it was met
  const void* root;
  std::span<std::uintptr_t> addresses;
  std::size_t count = 0;
};

_Unwind_Reason_Code step(_Unwind_Context* context, void* data) {
  Walk& walk = *static_cast<Walk*>(data);
  const std::uintptr_t address = _Unwind_GetIP(context);
  if (address == 0 || walk.count == walk.addresses.size() ||
      (walk.root != nullptr &&
       _Unwind_FindEnclosingFunction(reinterpret_cast<void*>(address - 1)) == walk.root))
    return _URC_END_OF_STACK;
  if (walk.caller == address)
    walk.caller = 0;
  if (walk.caller == 0)
    walk.addresses[walk.count++] = address;
  return _URC_NO_REASON;
}

void add_to(std::uint64_t& hash, std::uint64_t value) { // FNV-1a
  for (int byte = 0; byte < 8; ++byte, value >>= 8)
    hash = (hash ^ (value & 0xff)) * 0x100000001b3;
}

std::string_view without_folder(std::string_view path) {
  return path.substr(path.rfind('/') + 1); // npos + 1 is 0
}

// Without its arguments.
std::string readable(const char* symbol) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> name{
      abi::__cxa_demangle(symbol, nullptr, nullptr, &status), &std::free};
  const std::string_view whole = status == 0 ? name.get() : symbol;
  return std::string{whole.substr(0, whole.find('('))};
}

} // namespace

CallStack CallStack::from(const void* caller, const void* root) {
  CallStack stack;
  Walk walk{reinterpret_cast<std::uintptr_t>(caller), root, stack.addresses_};
  _Unwind_Backtrace(step, &walk);
  stack.count_ = walk.count;
  return stack;
}

std::uint64_t CallStack::hash() const {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::uintptr_t address : addresses()) {
    dl_find_object module{};
    if (_dl_find_object(reinterpret_cast<void*>(address), &module) != 0)
      continue; // made while it runs
    add_to(hash, std::hash<std::string_view>{}(module.dlfo_link_map->l_name));
    add_to(hash, address - module.dlfo_link_map->l_addr);
  }
  return hash;
}

std::string CallStack::names(std::size_t most) const {
  std::string names, last;
  std::size_t told = 0;
  for (const std::uintptr_t address : addresses()) {
    Dl_info info{};
    if (dladdr(reinterpret_cast<void*>(address - 1), &info) == 0)
      continue;
    std::string name{without_folder(info.dli_fname)};
    if (info.dli_sname != nullptr)
      name += " " + readable(info.dli_sname);
    if (name == last)
      continue;
    names += (told > 0 ? " < " : "") + name;
    last = std::move(name);
    if (++told == most)
      break;
  }
  return names;
}

} // namespace octascope::tests

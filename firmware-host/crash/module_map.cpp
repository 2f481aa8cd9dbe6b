#include "firmware-host/crash/module_map.h"

#include <algorithm>

#include <fcntl.h>
#include <unistd.h>

namespace octascope::firmware_host {

namespace {

std::uint64_t take_hex(std::string_view& rest) {
  std::uint64_t value = 0;
  for (; !rest.empty(); rest.remove_prefix(1)) {
    const char c = rest.front();
    if (c >= '0' && c <= '9')
      value = value * 16 + static_cast<std::uint64_t>(c - '0');
    else if (c >= 'a' && c <= 'f')
      value = value * 16 + static_cast<std::uint64_t>(c - 'a') + 10;
    else
      break;
  }
  return value;
}

void skip(std::string_view& rest, bool spaces) {
  while (!rest.empty() && (rest.front() == ' ') == spaces)
    rest.remove_prefix(1);
}

struct Line {
  std::uint64_t begin = 0, end = 0;
  std::string_view path;
};

// "55d0c8a00000-55d0c8a21000 r--p 00000000 08:01 1234    /usr/bin/octascope"
Line parse(std::string_view rest) {
  Line line;
  line.begin = take_hex(rest);
  if (!rest.empty())
    rest.remove_prefix(1);
  line.end = take_hex(rest);
  for (int field = 0; field < 4; ++field) { // rights, offset, device, inode
    skip(rest, true);
    skip(rest, false);
  }
  skip(rest, true);
  line.path = rest;
  return line;
}

} // namespace

void ModuleMap::read(const char* file) {
  size_ = 0;
  const int descriptor = ::open(file, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    return;
  for (ssize_t n = 1; n > 0 && size_ < text_.size();) {
    n = ::read(descriptor, text_.data() + size_, text_.size() - size_);
    if (n > 0)
      size_ += static_cast<std::size_t>(n);
  }
  ::close(descriptor);
}

// A module's mappings follow one another, the first has its beginning.
ModuleMap::Place ModuleMap::find(std::uint64_t address) const {
  std::string_view rest{text_.data(), size_};
  std::string_view module;
  std::uint64_t module_begin = 0;
  while (!rest.empty()) {
    const std::size_t length = std::min(rest.find('\n'), rest.size());
    const Line line = parse(rest.substr(0, length));
    rest.remove_prefix(std::min(length + 1, rest.size()));
    if (line.path != module || line.path.empty()) {
      module = line.path;
      module_begin = line.begin;
    }
    if (address >= line.begin && address < line.end)
      return {module, address - module_begin};
  }
  return {};
}

} // namespace octascope::firmware_host

#include "firmware-host/commands/size_text.h"

#include <fmt/format.h>

namespace octascope::firmware_host {

std::string size_words(std::uint64_t bytes) {
  const auto size = static_cast<double>(bytes);
  return size < 1e9 ? fmt::format("{:.1f} MB", size / 1e6) : fmt::format("{:.2f} GB", size / 1e9);
}

} // namespace octascope::firmware_host

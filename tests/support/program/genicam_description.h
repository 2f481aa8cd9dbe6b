// What a GenICam camera says that it can, rewritten.
#pragma once

#include <string>

namespace octascope::tests {

// The description of Aravis's camera, with Mono8 as its only pixel format.
inline std::string with_8_bits_alone(std::string description) {
  for (const char* format : {"BayerGR8", "BayerRG8", "BayerGB8", "BayerBG8", "Mono10", "Mono12",
                             "Mono16", "RGB8", "RGB8Packed", "BGR8"}) {
    const std::string end = "</EnumEntry>";
    const auto at = description.find("<EnumEntry Name=\"" + std::string{format} + "\"");
    if (at != std::string::npos)
      description.erase(at, description.find(end, at) + end.size() - at);
  }
  return description;
}

} // namespace octascope::tests

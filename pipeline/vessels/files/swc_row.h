// One row of an SWC file, from text to numbers.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

struct SwcRow {
  std::uint32_t id = 0;
  std::uint32_t type = 0;
  std::array<float, 3> position_mm{};
  float radius_mm = 0;
  std::uint32_t parent = no_parent; // an id
};

inline constexpr int swc_fields = 7;
inline constexpr int swc_id_field = 0;
inline constexpr int swc_parent_field = 6;

struct SwcRowFault {
  const char* at = nullptr; // in the line: the token that is wrong, or where one is missing
  std::string found;
  std::string expected;
};

enum class SwcLine : std::uint8_t { node, comment, blank, wrong };

// `line` ends with its line feed. Its numbers are in units of 10^shift mm. Fills `row` for a node
// and `fault` for what is wrong.
SwcLine read_swc_line(std::string_view line, int shift, SwcRow& row, SwcRowFault& fault);

// The token of a field that is known to be there, for messages.
std::string_view swc_token(std::string_view line, int field);

} // namespace octascope::pipeline

#include "pipeline/vessels/files/swc_row.h"

#include <cmath>

#include <fmt/format.h>

#include "hal/plain_text.h"
#include "pipeline/vessels/files/decimal.h"
#include "pipeline/vessels/files/swc_reader.h"

namespace octascope::pipeline {
namespace {

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

// Also at the carriage return of a CRLF.
bool at_end(const char* at) {
  return *at == '\n' || (*at == '\r' && at[1] == '\n');
}

const char* skip_blanks(const char* at) {
  while (is_blank(*at))
    ++at;
  return at;
}

std::string_view token_at(const char* at) {
  const char* end = at;
  while (!is_blank(*end) && !at_end(end))
    ++end;
  return {at, static_cast<std::size_t>(end - at)};
}

constexpr std::array<std::string_view, swc_fields> field_names{"id", "type",   "x",     "y",
                                                               "z",  "radius", "parent"};

std::string expected_of(int field) {
  switch (field) {
  case swc_id_field: return fmt::format("a whole number, 0 to {}", largest_swc_id);
  case 1: return "a whole number, 0 to 4294967295";
  case 5: return "a finite decimal number, 0 or more";
  case swc_parent_field: return fmt::format("-1 or an id, 0 to {}", largest_swc_id);
  default: return "a finite decimal number";
  }
}

// Reads field by field; the first that is wrong ends it.
class RowReader {
public:
  RowReader(const char* at, int shift, SwcRowFault& fault)
      : at_{at}, shift_{shift}, fault_{fault} {}

  bool read(SwcRow& row) {
    return whole_number(0, largest_swc_id, row.id) && whole_number(1, 0xFFFFFFFF, row.type) &&
           length(2, row.position_mm[0]) && length(3, row.position_mm[1]) &&
           length(4, row.position_mm[2]) && radius(row.radius_mm) && parent(row) && end();
  }

private:
  bool refuse(int field) {
    const std::string_view token = token_at(at_);
    const std::string_view name = field_names[static_cast<std::size_t>(field)];
    fault_.at = at_;
    if (token.empty() || token.front() == '#') {
      fault_.found = fmt::format("{} of {} numbers", field, swc_fields);
      fault_.expected = fmt::format("the {} here: id type x y z radius parent", name);
    } else {
      fault_.found = fmt::format("\"{}\" as {}", hal::shortened(token), name);
      fault_.expected = expected_of(field);
    }
    return false;
  }

  // Behind a token there is a blank or the end of the line; in front of the next, blanks.
  bool leave(int field, const char* end) {
    if (!is_blank(*end) && !at_end(end))
      return refuse(field);
    at_ = skip_blanks(end);
    return true;
  }

  bool whole_number(int field, std::uint32_t largest, std::uint32_t& value) {
    constexpr int most_digits = 19; // fit into 64 bits
    std::uint64_t number = 0;
    const char* digit = at_;
    for (; *digit >= '0' && *digit <= '9' && digit - at_ < most_digits; ++digit)
      number = 10 * number + static_cast<std::uint64_t>(*digit - '0');
    if (digit == at_ || number > largest)
      return refuse(field);
    value = static_cast<std::uint32_t>(number);
    return leave(field, digit);
  }

  bool length(int field, float& value) {
    Decimal decimal;
    const char* const end = read_decimal(at_, shift_, decimal);
    if (decimal.fault == DecimalFault::no_number)
      return refuse(field);
    const bool too_large = decimal.fault == DecimalFault::too_large ||
                           std::fabs(decimal.value) > largest_vessel_length_mm;
    if (too_large && (is_blank(*end) || at_end(end))) {
      refuse(field);
      fault_.expected = fmt::format("a number of at most {:g} mm", largest_vessel_length_mm);
      return false;
    }
    value = decimal.value;
    return leave(field, end);
  }

  bool radius(float& value) {
    const char* const token = at_;
    if (!length(5, value))
      return false;
    if (value >= 0)
      return true;
    at_ = token;
    return refuse(5);
  }

  bool parent(SwcRow& row) {
    if (at_[0] == '-' && at_[1] == '1') {
      row.parent = no_parent;
      return leave(swc_parent_field, at_ + 2);
    }
    const char* const token = at_;
    if (!whole_number(swc_parent_field, largest_swc_id, row.parent))
      return false;
    if (row.parent != row.id)
      return true;
    at_ = token;
    refuse(swc_parent_field);
    fault_.expected = "another node's id, or -1: no node is its own parent";
    return false;
  }

  bool end() {
    if (at_end(at_) || *at_ == '#')
      return true;
    fault_.at = at_;
    fault_.found = fmt::format("\"{}\" behind the parent", hal::shortened(token_at(at_)));
    fault_.expected = fmt::format("the end of the row after {} numbers", swc_fields);
    return false;
  }

  const char* at_;
  int shift_;
  SwcRowFault& fault_;
};

} // namespace

SwcLine read_swc_line(std::string_view line, int shift, SwcRow& row, SwcRowFault& fault) {
  const char* const at = skip_blanks(line.data());
  if (at_end(at))
    return SwcLine::blank;
  if (*at == '#')
    return SwcLine::comment;
  return RowReader{at, shift, fault}.read(row) ? SwcLine::node : SwcLine::wrong;
}

std::string_view swc_token(std::string_view line, int field) {
  const char* at = skip_blanks(line.data());
  for (int i = 0; i < field; ++i)
    at = skip_blanks(at + token_at(at).size());
  return token_at(at);
}

} // namespace octascope::pipeline

// What octascope itself writes into the comments of an SWC file, which has no place for it.
//
//   # octascope unit um          the unit of the file's lengths, um or mm
//   # octascope roots 3          how many trees there are: a file that has so many is a forest
//                               without being declared one
//   # octascope orders 0012b     one digit a node, 0 to b (eleven): the orders of the next rows
//
// The orders of all rows are there or none are: an orders line in front of each piece of the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "pipeline/vessels/files/tree_reading.h"

namespace octascope::pipeline {

inline constexpr std::string_view swc_unit_comment = "# octascope unit ";
inline constexpr std::string_view swc_roots_comment = "# octascope roots ";
inline constexpr std::string_view swc_orders_comment = "# octascope orders ";
inline constexpr std::string_view order_digits = "0123456789ab";

inline std::string_view unit_word(LengthUnit unit) {
  return unit == LengthUnit::um ? "um" : "mm";
}

// Gathers orders while the rows go by.
class SwcOrders {
public:
  // An orders comment's text behind its beginning, and how many nodes came before it.
  void take(std::string_view digits, std::size_t nodes) {
    fit_ = fit_ && orders_.size() == nodes;
    for (const char digit : digits) {
      const std::size_t order = order_digits.find(digit);
      fit_ = fit_ && order != std::string_view::npos;
      if (!fit_)
        break;
      orders_.push_back(static_cast<std::uint8_t>(order));
    }
  }

  // One a node; empty where there are none, or they belong to other rows than these.
  std::vector<std::uint8_t> finish(std::size_t nodes) && {
    if (!fit_ || orders_.size() != nodes)
      return {};
    return std::move(orders_);
  }

private:
  std::vector<std::uint8_t> orders_;
  bool fit_ = true;
};

} // namespace octascope::pipeline

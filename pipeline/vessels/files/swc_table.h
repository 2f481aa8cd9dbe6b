// Collects the rows of an SWC file and makes a tree of them.
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "pipeline/vessels/files/swc_reader.h"
#include "pipeline/vessels/files/swc_row.h"

namespace octascope::pipeline {

// What is wrong with a row that is valid by itself.
struct SwcTreeFault {
  std::size_t row = 0; // among the nodes, from 0
  int field = 0;       // of the row
  std::string found;
  std::string expected;
};

class SwcTable {
public:
  void reserve(std::size_t rows);
  void add(const SwcRow& row);
  std::size_t rows() const { return ids_.size(); }
  std::uint64_t roots() const;

  // Turns parents from ids into places in the table and sorts rows where parents come later. Says
  // the gravest thing that is wrong: ids that occur twice, then parents that are nowhere, then
  // cycles, then what the options do not allow; and the first of its kind in the file. Afterwards
  // `tree` is complete but for orders, and `counts` has nodes, roots, late parents and types.
  // `orders` has one a row, or none, and is sorted like the rows. Where options.stop is requested
  // it leaves without a fault, and the tree is none.
  std::optional<SwcTreeFault> finish(const TreeReadOptions& options,
                                     std::vector<std::uint8_t>& orders, VesselTree& tree,
                                     SwcCounts& counts);

private:
  std::optional<SwcTreeFault> find_twice(const std::stop_token& stop) const;
  std::optional<SwcTreeFault> resolve_parents(const std::stop_token& stop);
  std::optional<SwcTreeFault> check_roots(const TreeReadOptions& options) const;
  void make_index(const std::stop_token& stop);
  std::uint32_t find(std::uint32_t id) const; // its row, or no_parent

  VesselTree tree_; // parents are ids until they are resolved
  std::vector<std::uint32_t> ids_;
  bool consecutive_ = true; // each id is the one before, plus 1
  std::uint32_t smallest_id_ = largest_swc_id;
  std::uint32_t largest_id_ = 0;
  // Where ids are not consecutive: rows by id where the ids lie close together, else rows sorted by
  // their ids.
  std::vector<std::uint32_t> row_of_id_;
  std::vector<std::uint32_t> sorted_rows_;
  std::map<std::uint32_t, std::uint64_t> types_;
  std::uint64_t* count_of_last_type_ = nullptr;
  std::uint32_t last_type_ = 0;
};

} // namespace octascope::pipeline

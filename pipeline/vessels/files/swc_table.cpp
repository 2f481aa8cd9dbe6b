#include "pipeline/vessels/files/swc_table.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "pipeline/vessels/stoppable.h"

namespace octascope::pipeline {
namespace {

VesselBranch branch_of(std::uint32_t type) {
  const bool ours = type >= first_branch_type && type < first_branch_type + vessel_branch_count - 1;
  return ours ? static_cast<VesselBranch>(type - first_branch_type + 1) : VesselBranch::unknown;
}

std::uint64_t count_late(const std::vector<std::uint32_t>& parents) {
  std::uint64_t late = 0;
  for (std::size_t i = 0; i < parents.size(); ++i)
    late += parents[i] != no_parent && parents[i] > i ? 1U : 0U;
  return late;
}

// Rows with parents in front of their children, in the given order otherwise; `cycle` gets a member
// where parents lead back to a row. Up from each row to what is placed already, and down again.
struct Sorted {
  std::vector<std::uint32_t> rows;
  std::optional<std::uint32_t> cycle;
};
Sorted sort_by_parents(const std::vector<std::uint32_t>& parents, const std::stop_token& stop) {
  StopCheck stopped{stop};
  enum : std::uint8_t { open, on_the_way, placed };
  std::vector<std::uint8_t> state(parents.size(), open);
  std::vector<std::uint32_t> way;
  Sorted sorted;
  sorted.rows.reserve(parents.size());
  for (std::uint32_t row = 0; row < parents.size(); ++row) {
    std::uint32_t at = row;
    for (; at != no_parent && state[at] == open; at = parents[at]) {
      state[at] = on_the_way;
      way.push_back(at);
    }
    if (at != no_parent && state[at] == on_the_way) {
      sorted.cycle = at;
      return sorted;
    }
    for (; !way.empty(); way.pop_back()) {
      state[way.back()] = placed;
      sorted.rows.push_back(way.back());
      if (stopped())
        return sorted;
    }
  }
  return sorted;
}

std::size_t cycle_length(const std::vector<std::uint32_t>& parents, std::uint32_t member) {
  std::size_t length = 1;
  for (std::uint32_t at = parents[member]; at != member; at = parents[at])
    ++length;
  return length;
}

template <class Value>
void permute(std::vector<Value>& values, const std::vector<std::uint32_t>& rows) {
  std::vector<Value> sorted;
  sorted.reserve(values.size());
  for (const std::uint32_t row : rows)
    sorted.push_back(values[row]);
  values = std::move(sorted);
}

void permute(VesselTree& tree, const std::vector<std::uint32_t>& rows,
             const std::stop_token& stop) {
  permute(tree.positions_mm, rows);
  if (stop.stop_requested())
    return;
  permute(tree.radii_mm, rows);
  permute(tree.branches, rows);
  if (stop.stop_requested())
    return;
  permute(tree.parents, rows);
  std::vector<std::uint32_t> place(rows.size());
  for (std::uint32_t i = 0; i < rows.size(); ++i)
    place[rows[i]] = i;
  for (std::uint32_t& parent : tree.parents)
    parent = parent == no_parent ? no_parent : place[parent];
}

} // namespace

void SwcTable::reserve(std::size_t rows) {
  tree_.positions_mm.reserve(rows);
  tree_.radii_mm.reserve(rows);
  tree_.parents.reserve(rows);
  tree_.branches.reserve(rows);
  ids_.reserve(rows);
}

void SwcTable::add(const SwcRow& row) {
  consecutive_ = consecutive_ && (ids_.empty() || row.id == ids_.back() + 1);
  smallest_id_ = std::min(smallest_id_, row.id);
  largest_id_ = std::max(largest_id_, row.id);
  if (count_of_last_type_ == nullptr || row.type != last_type_) {
    last_type_ = row.type;
    count_of_last_type_ = &types_[row.type];
  }
  ++*count_of_last_type_;
  ids_.push_back(row.id);
  tree_.positions_mm.push_back(row.position_mm);
  tree_.radii_mm.push_back(row.radius_mm);
  tree_.parents.push_back(row.parent);
  tree_.branches.push_back(branch_of(row.type));
}

void SwcTable::make_index(const std::stop_token& stop) {
  if (consecutive_)
    return;
  const std::uint64_t span = std::uint64_t{largest_id_} - smallest_id_ + 1;
  constexpr std::uint64_t close = 4; // times the rows: more than that is sorted instead
  if (span <= close * rows()) {
    row_of_id_.assign(span, no_parent);
    for (std::uint32_t row = 0; row < rows(); ++row) {
      std::uint32_t& place = row_of_id_[ids_[row] - smallest_id_];
      place = std::min(place, row);
    }
    return;
  }
  sorted_rows_.resize(rows());
  std::iota(sorted_rows_.begin(), sorted_rows_.end(), 0U);
  stoppable_sort(
      sorted_rows_,
      [&](std::uint32_t a, std::uint32_t b) {
        return std::pair{ids_[a], a} < std::pair{ids_[b], b};
      },
      stop);
}

std::uint32_t SwcTable::find(std::uint32_t id) const {
  if (id < smallest_id_ || id > largest_id_)
    return no_parent;
  if (consecutive_)
    return id - smallest_id_;
  if (!row_of_id_.empty())
    return row_of_id_[id - smallest_id_];
  const auto found =
      std::ranges::lower_bound(sorted_rows_, id, {}, [&](std::uint32_t row) { return ids_[row]; });
  return found != sorted_rows_.end() && ids_[*found] == id ? *found : no_parent;
}

// find() gives the first row of an id: any other row of it is there twice.
std::optional<SwcTreeFault> SwcTable::find_twice(const std::stop_token& stop) const {
  if (consecutive_)
    return std::nullopt;
  StopCheck stopped{stop};
  for (std::uint32_t row = 0; row < rows() && !stopped(); ++row) {
    if (find(ids_[row]) != row)
      return SwcTreeFault{row, swc_id_field,
                          fmt::format("the id {} for the second time", ids_[row]), "each id once"};
  }
  return std::nullopt;
}

std::uint64_t SwcTable::roots() const {
  return static_cast<std::uint64_t>(std::ranges::count(tree_.parents, no_parent));
}

std::optional<SwcTreeFault> SwcTable::resolve_parents(const std::stop_token& stop) {
  StopCheck stopped{stop};
  for (std::size_t row = 0; row < rows() && !stopped(); ++row) {
    std::uint32_t& parent = tree_.parents[row];
    if (parent == no_parent)
      continue;
    const std::uint32_t place = find(parent);
    if (place == no_parent)
      return SwcTreeFault{row, swc_parent_field,
                          fmt::format("the parent {}, which no row has", parent),
                          "the id of a row, or -1"};
    parent = place;
  }
  return std::nullopt;
}

std::optional<SwcTreeFault> SwcTable::check_roots(const TreeReadOptions& options) const {
  const auto is_root = [](std::uint32_t parent) { return parent == no_parent; };
  const auto first = std::ranges::find_if(tree_.parents, is_root);
  if (options.forest || first == tree_.parents.end())
    return std::nullopt;
  const auto second = std::find_if(first + 1, tree_.parents.end(), is_root);
  if (second == tree_.parents.end())
    return std::nullopt;
  return SwcTreeFault{static_cast<std::size_t>(second - tree_.parents.begin()), swc_parent_field,
                      "a second root", "one; several are allowed as a forest (--forest)"};
}

std::optional<SwcTreeFault> SwcTable::finish(const TreeReadOptions& options,
                                             std::vector<std::uint8_t>& orders, VesselTree& tree,
                                             SwcCounts& counts) {
  const auto stopped = [&] { return options.stop.stop_requested(); };
  make_index(options.stop);
  if (stopped())
    return std::nullopt;
  if (auto fault = find_twice(options.stop))
    return fault;
  if (stopped())
    return std::nullopt;
  if (auto fault = resolve_parents(options.stop))
    return fault;
  if (stopped())
    return std::nullopt;
  row_of_id_ = {};
  sorted_rows_ = {};
  counts.late_parents = count_late(tree_.parents);
  Sorted sorted;
  if (counts.late_parents > 0) {
    sorted = sort_by_parents(tree_.parents, options.stop);
    if (stopped())
      return std::nullopt;
    if (sorted.cycle)
      return SwcTreeFault{*sorted.cycle, swc_parent_field,
                          fmt::format("a cycle of {} nodes, {} among them",
                                      cycle_length(tree_.parents, *sorted.cycle),
                                      ids_[*sorted.cycle]),
                          "parents that lead to a root"};
  }
  if (counts.late_parents > 0 && options.strict) {
    std::size_t row = 0;
    while (tree_.parents[row] == no_parent || tree_.parents[row] < row)
      ++row;
    return SwcTreeFault{row, swc_parent_field,
                        fmt::format("the parent {} in a later row", ids_[tree_.parents[row]]),
                        "it in front of its children (--strict)"};
  }
  if (auto fault = check_roots(options))
    return fault;
  ids_ = {};
  if (!sorted.rows.empty()) {
    permute(tree_, sorted.rows, options.stop);
    if (!orders.empty())
      permute(orders, sorted.rows);
  }
  if (stopped())
    return std::nullopt;
  counts.nodes = tree_.nodes();
  counts.roots = roots();
  counts.types = std::move(types_);
  tree = std::move(tree_);
  return std::nullopt;
}

} // namespace octascope::pipeline

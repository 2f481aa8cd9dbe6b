#include "pipeline/vessels/files/swc_writer.h"

#include <algorithm>
#include <charconv>
#include <string>

#include <fmt/format.h>

#include "pipeline/vessels/files/decimal.h"
#include "pipeline/vessels/files/swc_comments.h"
#include "pipeline/vessels/files/swc_reader.h"
#include "pipeline/vessels/files/tree_writing.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t nodes_in_piece = 128; // an orders line stays short enough for any reader
constexpr std::size_t longest_id = 10;
constexpr std::size_t longest_row = 4 * longest_decimal + 3 * longest_id + 8;
constexpr std::size_t flush_bytes = std::size_t{1} << 20;

std::uint32_t type_of(VesselBranch branch) {
  return branch == VesselBranch::unknown
             ? 0
             : first_branch_type + static_cast<std::uint32_t>(branch) - 1;
}

class SwcText {
public:
  SwcText(const VesselTree& tree, LengthUnit unit)
      : tree_{tree}, shift_{unit == LengthUnit::um ? 3 : 0} {
    text_ = fmt::format("# octascope vessel tree: id type x y z radius parent\n"
                        "# types 16, 17, 18: RCA, LAD, LCX; 0: unknown\n{}{}\n{}{}\n",
                        swc_unit_comment, unit_word(unit), swc_roots_comment,
                        std::ranges::count(tree.parents, no_parent));
  }

  // The nodes from `first` on that share an orders line.
  void add_piece(std::size_t first) {
    const std::size_t end = std::min(first + nodes_in_piece, tree_.nodes());
    text_ += swc_orders_comment;
    for (std::size_t i = first; i < end; ++i)
      text_ += order_digits[tree_.orders[i]];
    text_ += '\n';
    for (std::size_t i = first; i < end; ++i)
      add_node(i);
  }

  std::string& text() { return text_; }

private:
  void add_node(std::size_t i) {
    char row[longest_row];
    char* at = row;
    const auto whole = [&](std::uint32_t number) {
      at = std::to_chars(at, at + longest_id, number).ptr;
      *at++ = ' ';
    };
    const auto length = [&](float mm) {
      at = write_decimal(at, mm, shift_);
      *at++ = ' ';
    };
    whole(static_cast<std::uint32_t>(i + 1));
    whole(type_of(tree_.branches[i]));
    for (const float mm : tree_.positions_mm[i])
      length(mm);
    length(tree_.radii_mm[i]);
    if (tree_.parents[i] == no_parent) {
      *at++ = '-';
      *at++ = '1';
    } else {
      whole(tree_.parents[i] + 1);
      --at;
    }
    *at++ = '\n';
    text_.append(row, at);
  }

  const VesselTree& tree_;
  int shift_;
  std::string text_;
};

} // namespace

hal::Result<> write_swc(const fs::path& file, const VesselTree& tree, LengthUnit unit,
                        const std::function<void(double)>& progress, Readers readers) {
  HAL_CHECK(check_tree_to_write(file, tree, largest_swc_id));
  HAL_TRY(auto out, AtomicFile::create(file, readers));
  SwcText swc{tree, unit};
  std::uint64_t written = 0;
  for (std::size_t first = 0; first < tree.nodes(); first += nodes_in_piece) {
    swc.add_piece(first);
    const bool last = first + nodes_in_piece >= tree.nodes();
    if (swc.text().size() < flush_bytes && !last)
      continue;
    HAL_CHECK(out.write_at(written, std::as_bytes(std::span{swc.text()})));
    written += swc.text().size();
    swc.text().clear();
    if (progress)
      progress(std::min(1.0, static_cast<double>(first + nodes_in_piece) /
                                 static_cast<double>(tree.nodes())));
  }
  return out.commit();
}

} // namespace octascope::pipeline

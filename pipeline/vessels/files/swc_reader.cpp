#include "pipeline/vessels/files/swc_reader.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <istream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/number_text.h"
#include "hal/plain_text.h"
#include "pipeline/files/input_file.h"
#include "pipeline/vessels/files/swc_comments.h"
#include "pipeline/vessels/files/swc_row.h"
#include "pipeline/vessels/files/swc_table.h"
#include "pipeline/vessels/vessel_orders.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::size_t block_bytes = std::size_t{4} << 20; // also the longest line
constexpr std::string_view expected_file = "an SWC file";

class SwcReader {
public:
  SwcReader(const fs::path& name, const TreeReadOptions& options)
      : name_{name}, options_{options}, unit_{options.unit.value_or(LengthUnit::um)} {}

  void reserve(std::size_t rows) { table_.reserve(rows); }
  std::size_t rows() const { return table_.rows(); }

  // Any number of whole lines, each with its line feed.
  hal::Result<> take(std::string_view lines);

  // When all lines were taken. `line_text` gives a line of the file anew, by its number from 1.
  template <class LineText> hal::Result<SwcTree> finish(LineText line_text);

private:
  hal::Result<> take_comment(std::string_view line);
  tl::unexpected<hal::Error> refuse(std::uint64_t line, std::size_t column, std::string_view found,
                                    std::string_view expected) const {
    return hal::fail(ErrorCode::bad_data, "{}:{}:{}: found {}, expected {}", name_.string(), line,
                     column, found, expected);
  }
  hal::Result<> take_line(std::string_view line, int shift);
  std::uint64_t line_of(std::size_t row) const;

  fs::path name_;
  const TreeReadOptions& options_;
  LengthUnit unit_;
  SwcTable table_;
  SwcCounts counts_;
  SwcOrders orders_;
  std::uint64_t roots_written_ = 1; // by write_swc(), in a comment
  // Lines without a node: in front of which row, and how many up to there. For messages.
  struct Skipped {
    std::size_t row;
    std::uint64_t lines;
  };
  std::vector<Skipped> skipped_;
};

hal::Result<> SwcReader::take_comment(std::string_view line) {
  std::string_view text = line.substr(0, line.find_last_not_of("\r\n \t") + 1);
  if (text.starts_with(swc_orders_comment))
    orders_.take(text.substr(swc_orders_comment.size()), table_.rows());
  if (text.starts_with(swc_roots_comment)) {
    std::string_view number = text.substr(swc_roots_comment.size());
    roots_written_ = hal::take_number<std::uint64_t>(number).value_or(roots_written_);
  }
  if (text.starts_with(swc_unit_comment)) {
    const std::string_view word = text.substr(swc_unit_comment.size());
    const std::string_view declared = unit_word(unit_);
    if (word != declared)
      return refuse(counts_.rows, swc_unit_comment.size() + 1,
                    fmt::format("\"{}\", the unit it was written in", hal::shortened(word)),
                    fmt::format("{}, the unit declared for it (--unit)", declared));
  }
  return {};
}

hal::Result<> SwcReader::take_line(std::string_view line, int shift) {
  ++counts_.rows;
  SwcRow row;
  SwcRowFault fault;
  switch (read_swc_line(line, shift, row, fault)) {
  case SwcLine::node:
    if (table_.rows() == options_.limits.rows)
      return refuse(counts_.rows, 1, "one node more",
                    fmt::format("the end: {} are the limit", options_.limits.rows));
    table_.add(row);
    return {};
  case SwcLine::wrong:
    return refuse(counts_.rows, static_cast<std::size_t>(fault.at - line.data()) + 1, fault.found,
                  fault.expected);
  case SwcLine::comment: ++counts_.comments; break;
  case SwcLine::blank: ++counts_.blanks; break;
  }
  if (skipped_.empty() || skipped_.back().row != table_.rows())
    skipped_.push_back({table_.rows(), 0});
  skipped_.back().lines = counts_.comments + counts_.blanks;
  return line.starts_with('#') ? take_comment(line) : hal::Result<>{};
}

hal::Result<> SwcReader::take(std::string_view lines) {
  const int shift = unit_ == LengthUnit::um ? -3 : 0;
  if (counts_.rows == 0 && lines.starts_with(byte_order_mark))
    lines.remove_prefix(byte_order_mark.size());
  while (!lines.empty()) {
    const std::size_t bytes = lines.find('\n') + 1;
    HAL_CHECK(take_line(lines.substr(0, bytes), shift));
    lines.remove_prefix(bytes);
  }
  return {};
}

std::uint64_t SwcReader::line_of(std::size_t row) const {
  const auto behind = std::ranges::upper_bound(skipped_, row, {}, &Skipped::row);
  return row + 1 + (behind == skipped_.begin() ? 0 : (behind - 1)->lines);
}

template <class LineText> hal::Result<SwcTree> SwcReader::finish(LineText line_text) {
  if (table_.rows() == 0)
    return refuse(counts_.rows + 1, 1, "the end of the file and no node",
                  "rows of id type x y z radius parent");
  SwcTree result;
  result.unit = unit_;
  std::vector<std::uint8_t> orders = std::move(orders_).finish(table_.rows());
  TreeReadOptions options = options_;
  options.forest = options.forest || table_.roots() == roots_written_;
  if (const auto fault = table_.finish(options, orders, result.tree, counts_)) {
    const std::uint64_t line = line_of(fault->row);
    const std::string text = line_text(line) + "\n";
    const std::string_view token = swc_token(text, fault->field);
    return refuse(line, static_cast<std::size_t>(token.data() - text.data()) + 1, fault->found,
                  fault->expected);
  }
  if (options_.stop.stop_requested())
    return reading_stopped(name_);
  HAL_TRY(const auto zeros, mend_zero_radii(result.tree, options_.zero_radius, name_));
  counts_.zero_radii = zeros;
  counts_.coincident = count_coincident(result.tree);
  counts_.orders_in_file = !orders.empty();
  result.tree.orders = std::move(orders);
  if (!counts_.orders_in_file)
    assign_vessel_orders(result.tree, options_.stop);
  if (options_.stop.stop_requested())
    return reading_stopped(name_);
  result.counts = std::move(counts_);
  return result;
}

// The line of that number, from 1, without its end: for messages.
std::string nth_line(std::istream&& text, std::uint64_t number) {
  std::string line;
  for (std::uint64_t at = 0; at < number; ++at)
    std::getline(text, line);
  return line.starts_with(byte_order_mark) ? line.substr(byte_order_mark.size()) : line;
}

} // namespace

hal::Result<SwcTree> parse_swc(std::string_view text, const fs::path& name,
                               const TreeReadOptions& options) {
  if (text.size() > options.limits.bytes)
    return hal::fail(ErrorCode::bad_data,
                     "{}: found {} bytes, more than the limit of {}, expected {}", name.string(),
                     text.size(), options.limits.bytes, expected_file);
  SwcReader reader{name, options};
  const std::size_t whole = text.rfind('\n') + 1;
  hal::Result<> taken = reader.take(text.substr(0, whole));
  if (taken && whole < text.size()) // a last line without an end
    taken = reader.take(std::string{text.substr(whole)} + "\n");
  if (!taken)
    return tl::make_unexpected(taken.error());
  return reader.finish([&](std::uint64_t number) {
    return nth_line(std::istringstream{std::string{text}}, number);
  });
}

hal::Result<SwcTree> read_swc(const fs::path& file, const TreeReadOptions& options) {
  HAL_TRY(const auto input, InputFile::open(file, expected_file, options.limits.bytes));
  SwcReader reader{file, options};
  std::string block(std::min<std::uint64_t>(block_bytes, input.bytes() + 1) + 1, '\0');
  std::size_t kept = 0; // bytes of a line whose end is in the next block
  std::uint64_t done = 0;
  while (true) {
    const std::size_t room = block.size() - 1 - kept; // but for a last line feed
    HAL_TRY(const auto filled, input.read({block.data() + kept, room}));
    const bool last = filled < room;
    std::size_t there = kept + filled;
    if (last && there > 0 && block[there - 1] != '\n')
      block[there++] = '\n';
    const std::size_t whole = std::string_view{block.data(), there}.rfind('\n') + 1;
    if (whole == 0 && !last)
      return hal::fail(ErrorCode::bad_data, "{}: found a line of more than {} bytes, expected {}",
                       file.string(), room, expected_file);
    HAL_CHECK(reader.take({block.data(), whole}));
    if (done == 0) // the rest will have rows of about this length
      reader.reserve(static_cast<std::size_t>(
          1.05 * static_cast<double>(reader.rows()) * static_cast<double>(input.bytes()) /
              static_cast<double>(std::max<std::size_t>(whole, 1)) +
          16));
    done += filled;
    if (options.progress)
      options.progress(input.bytes() == 0 ? 1
                                          : std::min(1.0, static_cast<double>(done) /
                                                              static_cast<double>(input.bytes())));
    if (options.stop.stop_requested())
      return reading_stopped(file);
    if (last)
      break;
    kept = there - whole;
    std::memmove(block.data(), block.data() + whole, kept);
  }
  return reader.finish([&](std::uint64_t number) { return nth_line(std::ifstream{file}, number); });
}

} // namespace octascope::pipeline

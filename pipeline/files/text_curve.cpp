#include "pipeline/files/text_curve.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/number_text.h"
#include "hal/plain_text.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

static_assert(std::endian::native == std::endian::little, "raw files are little-endian");

namespace {

// The whole file, when it is a regular one of 1 to `longest` bytes.
hal::Result<std::string> read_bytes(const fs::path& file, std::uintmax_t longest,
                                    std::string_view expected) {
  const auto refuse = [&](ErrorCode fault, std::string_view found) {
    return hal::fail(fault, "{}: {}, expected {}", file.string(), found, expected);
  };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    return refuse(ErrorCode::absent, "there is no such file");
  if (fs::is_directory(status))
    return refuse(ErrorCode::invalid_argument, "is a directory");
  if (!fs::is_regular_file(status))
    return refuse(ErrorCode::invalid_argument, "is not a regular file");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error)
    return refuse(ErrorCode::system, error.message());
  if (size == 0)
    return refuse(ErrorCode::bad_data, "is empty");
  if (size > longest)
    return refuse(ErrorCode::bad_data, fmt::format("has {} bytes, far too many", size));
  std::ifstream in{file, std::ios::binary};
  if (!in)
    return refuse(ErrorCode::denied,
                  fmt::format("cannot be opened: {}", std::generic_category().message(errno)));
  std::string bytes(size, '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size)))
    return refuse(ErrorCode::system, "cannot be read to its end");
  return bytes;
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\v\f";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos)
    return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::optional<double> finite_number(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-')
    text.remove_prefix(1);
  const auto value = hal::number_of<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

// Calls take(line number from 1, text) for every line that holds more than blanks and a comment,
// until it returns an Error.
template <typename Take> hal::Result<> for_each_line(std::string_view rest, Take take) {
  if (rest.starts_with("\xEF\xBB\xBF"))
    rest.remove_prefix(3);
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    std::string_view text = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    text = trim(text.substr(0, text.find('#')));
    if (text.empty())
      continue;
    HAL_CHECK(take(line, text));
  }
  return {};
}

// The numbers of a line with separators between them; empty when one is no finite number.
std::vector<double> split_numbers(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t end = text.find_first_of(",; \t");
    const auto value = finite_number(text.substr(0, end));
    if (!value)
      return {};
    numbers.push_back(*value);
    if (end == std::string_view::npos)
      return numbers;
    // One comma or semicolon at most between two numbers, with blanks around it.
    text = trim(text.substr(end));
    if (text.front() == ',' || text.front() == ';')
      text = trim(text.substr(1));
  }
}

// One number a line, at most `most`. Messages say "exactly" or "at most" so many are expected.
hal::Result<std::vector<double>> parse_numbers(const fs::path& file, std::size_t most,
                                               std::string_view bound) {
  // Generous: a number seldom takes 30 bytes, and there may be comments.
  const std::uintmax_t longest = 65536 + 256 * static_cast<std::uintmax_t>(most);
  const std::string count =
      bound == "exactly" ? fmt::format("{}", most) : fmt::format("{} {}", bound, most);
  HAL_TRY(const auto bytes,
          read_bytes(file, longest, fmt::format("a text file of {} numbers, one a line", count)));

  std::vector<double> values;
  if (auto read = for_each_line(
          bytes,
          [&](std::size_t line, std::string_view text) -> hal::Result<> {
            if (values.size() == most)
              return hal::fail(ErrorCode::bad_data,
                               "{}:{}: found one number more (\"{}\"), expected {} {}",
                               file.string(), line, hal::shortened(text), bound, most);
            const auto value = finite_number(text);
            if (!value)
              return hal::fail(ErrorCode::bad_data,
                               "{}:{}: found \"{}\" as number {} of {}, expected one finite number "
                               "with a decimal point",
                               file.string(), line, hal::shortened(text), values.size(), count);
            values.push_back(*value);
            return {};
          });
      !read)
    return tl::make_unexpected(read.error());
  return values;
}

} // namespace

hal::Result<std::vector<double>> read_text_curve(const fs::path& file, std::size_t expected) {
  auto values = parse_numbers(file, expected, "exactly");
  if (values && values->size() != expected)
    return hal::fail(ErrorCode::bad_data, "{}: found {} numbers, expected {}", file.string(),
                     values->size(), expected);
  return values;
}

hal::Result<std::vector<double>> read_text_numbers(const fs::path& file, std::size_t most) {
  return parse_numbers(file, most, "at most");
}

hal::Result<std::vector<TextRow>> read_text_rows(const fs::path& file, std::size_t most,
                                                 std::initializer_list<std::size_t> counts) {
  const std::string wanted =
      fmt::format("{} finite numbers with decimal points", fmt::join(counts, " or "));
  const std::uintmax_t longest = 65536 + 256 * static_cast<std::uintmax_t>(most);
  HAL_TRY(const auto bytes,
          read_bytes(file, longest,
                     fmt::format("a text file of at most {} lines of {}", most, wanted)));
  std::vector<TextRow> rows;
  const auto take = [&](std::size_t line, std::string_view text) -> hal::Result<> {
    const auto refuse = [&](std::string_view expected) {
      return hal::fail(ErrorCode::bad_data, "{}:{}: found \"{}\", expected {}", file.string(), line,
                       hal::shortened(text), expected);
    };
    if (rows.size() == most)
      return refuse(fmt::format("the end: {} lines are the most", most));
    std::vector<double> numbers = split_numbers(text);
    if (std::ranges::find(counts, numbers.size()) == counts.end())
      return refuse(wanted);
    if (!rows.empty() && numbers.size() != rows.front().numbers.size())
      return refuse(
          fmt::format("{} numbers as in line {}", rows.front().numbers.size(), rows.front().line));
    rows.push_back({line, std::move(numbers)});
    return {};
  };
  HAL_CHECK(for_each_line(bytes, take));
  return rows;
}

hal::Result<std::vector<float>> read_float_curve(const fs::path& file, std::size_t expected) {
  const std::size_t expected_bytes = expected * sizeof(float);
  const std::string words =
      fmt::format("{} bytes ({} little-endian 32-bit floats)", expected_bytes, expected);
  HAL_TRY(const auto bytes, read_bytes(file, 65536 + 4 * expected_bytes, words));
  if (bytes.size() != expected_bytes)
    return hal::fail(ErrorCode::bad_data, "{}: found {} bytes, expected {}", file.string(),
                     bytes.size(), words);
  std::vector<float> values(expected);
  bytes.copy(reinterpret_cast<char*>(values.data()), expected_bytes);
  for (std::size_t i = 0; i < expected; ++i) {
    if (!std::isfinite(values[i]))
      return hal::fail(ErrorCode::bad_data, "{}: value {} is {}, expected a finite number",
                       file.string(), i, values[i]);
  }
  return values;
}

} // namespace octascope::pipeline

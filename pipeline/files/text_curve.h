// Curves as text files with one or several numbers per line, and as raw floats.
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <vector>

#include "hal/result.h"

namespace octascope::pipeline {

// Reads exactly `expected` finite numbers, one per line. Blank lines, comments (# to the end of the
// line), LF and CRLF line ends and a byte-order mark are accepted; anything else is refused with
// file, line, found and expected. Whatever the locale, the decimal separator is a point.
hal::Result<std::vector<double>> read_text_curve(const std::filesystem::path& file,
                                                 std::size_t expected);

// The same for all numbers in the file, up to `most`.
hal::Result<std::vector<double>> read_text_numbers(const std::filesystem::path& file,
                                                   std::size_t most);

// The same for lines of several numbers separated by commas, semicolons, blanks or tabs: up to
// `most` lines, all with the same count of numbers, which must be one of `counts`. `line` counts
// from 1 in the file.
struct TextRow {
  std::size_t line = 0;
  std::vector<double> numbers;
};
hal::Result<std::vector<TextRow>> read_text_rows(const std::filesystem::path& file,
                                                 std::size_t most,
                                                 std::initializer_list<std::size_t> counts);

// Reads exactly `expected` finite little-endian 32-bit floats and nothing else.
hal::Result<std::vector<float>> read_float_curve(const std::filesystem::path& file,
                                                 std::size_t expected);

} // namespace octascope::pipeline

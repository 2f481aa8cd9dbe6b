// Curves as people write them: one number a line.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "hal/result.h"

namespace octascope::pipeline {

// Reads exactly `expected` finite numbers. Blank lines, comments (# to the end of the line), LF and
// CRLF line ends and a byte-order mark are fine; anything else is refused with file, line, found
// and expected. Independent of the locale: the decimal sign is a point.
hal::Result<std::vector<double>> read_text_curve(const std::filesystem::path& file,
                                                 std::size_t expected);

// The same for as many numbers as there are, up to `most`.
hal::Result<std::vector<double>> read_text_numbers(const std::filesystem::path& file,
                                                   std::size_t most);

// Reads exactly `expected` finite little-endian 32-bit floats and nothing else.
hal::Result<std::vector<float>> read_float_curve(const std::filesystem::path& file,
                                                 std::size_t expected);

} // namespace octascope::pipeline

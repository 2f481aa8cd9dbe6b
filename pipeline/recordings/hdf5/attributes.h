// Attributes of a file: texts and numbers that are scalars.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "hal/result.h"
#include "pipeline/recordings/hdf5/hdf5.h"

namespace octascope::pipeline {

// Made, or for numbers written anew. Text is UTF-8 of its own length. False: HDF5 failed.
bool write_text(hid_t file, const char* name, const std::string& text);
bool write_whole(hid_t file, const char* name, std::int64_t value);
bool write_real(hid_t file, const char* name, double value);

// "attribute NAME: what".
tl::unexpected<hal::Error> bad_attribute(const char* name, const std::string& what);

// Of whatever type another program may have made them: docs/RECORDINGS.md. ErrorCode::bad_data: the
// message names the attribute, what was found, and what was expected.
hal::Result<std::string> read_text(hid_t file, const char* name); // of one mebibyte at most
hal::Result<std::int64_t> read_whole(hid_t file, const char* name);
hal::Result<double> read_real(hid_t file, const char* name);

inline constexpr int largest_size = 65536; // of an axis

// Reads one attribute after the other until one is wrong.
class AttributeReader {
public:
  explicit AttributeReader(hid_t file) : file_(file) {}

  void read(const char* name, std::string& value);
  void read(const char* name, bool& value);
  void read(const char* name, int& value, int lowest = 1, int highest = largest_size);
  void read(const char* name, double& value); // above zero
  // Older files do not have it.
  void read_if_there(const char* name, std::string& value);

  const std::optional<hal::Error>& error() const { return error_; }

private:
  template <typename T> void take(T& value, auto&& read_it) {
    if (error_)
      return;
    if (auto got = read_it())
      value = std::move(*got);
    else
      error_ = got.error();
  }

  hid_t file_;
  std::optional<hal::Error> error_;
};

} // namespace octascope::pipeline

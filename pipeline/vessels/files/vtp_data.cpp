#include "pipeline/vessels/files/vtp_data.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>

#include <fmt/format.h>
#include <zlib.h>

#include "hal/number_text.h"

namespace octascope::pipeline {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian");

tl::unexpected<hal::Error> refuse(const pugi::xml_node& array, std::string_view found,
                                  std::string_view expected) {
  return hal::fail(hal::ErrorCode::bad_data, "array \"{:.60}\": found {}, expected {}",
                   array.attribute("Name").value(), found, expected);
}

constexpr std::string_view blanks = " \t\r\n";

// Bytes one after the other, from raw data or from base64. Groups of base64 may be padded and
// followed by others: the header of compressed data is encoded by itself.
class ByteStream {
public:
  ByteStream(std::string_view text, bool base64) : rest_{text}, base64_{base64} {}

  // No more than so many are left.
  std::uint64_t at_most() const {
    return base64_ ? decoded_.size() + rest_.size() / 4 * 3 : rest_.size();
  }

  // False when there are fewer, or what is there is no base64.
  bool take(std::uint64_t count, std::string& bytes) {
    bytes.clear();
    if (count > at_most())
      return false;
    if (!base64_) {
      bytes = rest_.substr(0, count);
      rest_.remove_prefix(count);
      return true;
    }
    bytes.reserve(count + 3);
    bytes = std::move(decoded_);
    decoded_.clear();
    while (bytes.size() < count) {
      if (!decode_group(bytes))
        return false;
    }
    decoded_ = bytes.substr(count);
    bytes.resize(count);
    return true;
  }

private:
  static int value_of(char c) {
    if (c >= 'A' && c <= 'Z')
      return c - 'A';
    if (c >= 'a' && c <= 'z')
      return c - 'a' + 26;
    if (c >= '0' && c <= '9')
      return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
  }

  bool decode_group(std::string& bytes) {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
    if (rest_.size() < 4)
      return false;
    const std::size_t padding = rest_[3] != '=' ? 0 : rest_[2] != '=' ? 1 : 2;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const int value = i < 4 - padding ? value_of(rest_[i]) : 0;
      if (value < 0)
        return false;
      bits = bits << 6 | static_cast<std::uint32_t>(value);
    }
    for (std::size_t i = 0; i < 3 - padding; ++i)
      bytes += static_cast<char>(bits >> (16 - 8 * i) & 0xFF);
    rest_.remove_prefix(4);
    return true;
  }

  std::string_view rest_;
  bool base64_;
  std::string decoded_; // of the last group, not taken yet
};

class DataReader {
public:
  DataReader(const pugi::xml_node& array, const VtpEncoding& encoding, ByteStream stream)
      : array_{array}, encoding_{encoding}, stream_{std::move(stream)} {}

  hal::Result<std::string> read(std::uint64_t expected) {
    return encoding_.compressed ? read_compressed(expected) : read_plain(expected);
  }

private:
  tl::unexpected<hal::Error> cut_off() const {
    return refuse(array_, "data that end too early, or are no base64", "all of them");
  }

  std::optional<std::uint64_t> word() {
    std::string bytes;
    if (!stream_.take(static_cast<std::uint64_t>(encoding_.header_bytes), bytes))
      return std::nullopt;
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data(), bytes.size());
    return value;
  }

  hal::Result<std::string> read_plain(std::uint64_t expected) {
    const auto bytes = word();
    if (!bytes)
      return cut_off();
    if (*bytes != expected)
      return refuse(array_, fmt::format("{} bytes", *bytes), fmt::format("{}", expected));
    std::string data;
    if (!stream_.take(expected, data))
      return cut_off();
    return data;
  }

  hal::Result<std::string> read_compressed(std::uint64_t expected) {
    const auto blocks = word();
    const auto whole = word();
    const auto last = word();
    if (!blocks || !whole || !last || *blocks > stream_.at_most())
      return cut_off();
    std::vector<std::uint64_t> sizes;
    for (std::uint64_t i = 0; i < *blocks; ++i) {
      const auto size = word();
      if (!size)
        return cut_off();
      sizes.push_back(*size);
    }
    std::string data;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const std::uint64_t bytes = i + 1 == sizes.size() && *last != 0 ? *last : *whole;
      if (bytes > expected - data.size())
        return refuse(array_, "more bytes in its blocks", fmt::format("{}", expected));
      HAL_CHECK(inflate(sizes[i], bytes, data));
    }
    if (data.size() != expected)
      return refuse(array_, fmt::format("{} bytes", data.size()), fmt::format("{}", expected));
    return data;
  }

  hal::Result<> inflate(std::uint64_t compressed, std::uint64_t bytes, std::string& data) {
    std::string packed;
    if (!stream_.take(compressed, packed))
      return cut_off();
    constexpr std::uint64_t most_gain = 1032; // of zlib: more is a lie, and would cost memory
    const std::size_t done = data.size();
    uLongf length = bytes;
    if (bytes > most_gain * (compressed + 1))
      return refuse(array_, "a block that says it is larger than it can be", "a zlib block");
    data.resize(done + bytes);
    const int status = ::uncompress(reinterpret_cast<Bytef*>(data.data() + done), &length,
                                    reinterpret_cast<const Bytef*>(packed.data()), packed.size());
    if (status != Z_OK || length != bytes)
      return refuse(array_, "a block that does not unpack to the size it says", "a zlib block");
    return {};
  }

  const pugi::xml_node& array_;
  const VtpEncoding& encoding_;
  ByteStream stream_;
};

std::size_t bytes_of_type(std::string_view type) {
  if (type == "Int8" || type == "UInt8")
    return 1;
  if (type == "Int16" || type == "UInt16")
    return 2;
  if (type == "Float32" || type == "Int32" || type == "UInt32")
    return 4;
  return type == "Float64" || type == "Int64" || type == "UInt64" ? 8 : 0;
}

template <class Number> bool allowed(Number value) {
  if constexpr (std::is_floating_point_v<Number>)
    return std::isfinite(value);
  return true;
}

// From the file's type to the wanted; nothing where a number does not fit.
template <class Stored, class Number>
bool convert(std::string_view bytes, std::vector<Number>& out) {
  for (std::size_t i = 0; i < bytes.size() / sizeof(Stored); ++i) {
    Stored stored{};
    std::memcpy(&stored, bytes.data() + i * sizeof(Stored), sizeof(Stored));
    if constexpr (std::is_integral_v<Number> && !std::is_integral_v<Stored>)
      return false;
    else if constexpr (std::is_integral_v<Number> && std::is_signed_v<Stored>) {
      if (stored < 0)
        return false;
    }
    if (!allowed(stored))
      return false;
    out.push_back(static_cast<Number>(stored));
  }
  return true;
}

template <class Number>
bool convert(std::string_view type, std::string_view bytes, std::vector<Number>& out) {
  if (type == "Float32")
    return convert<float>(bytes, out);
  if (type == "Float64")
    return convert<double>(bytes, out);
  if (type == "Int8")
    return convert<std::int8_t>(bytes, out);
  if (type == "UInt8")
    return convert<std::uint8_t>(bytes, out);
  if (type == "Int16")
    return convert<std::int16_t>(bytes, out);
  if (type == "UInt16")
    return convert<std::uint16_t>(bytes, out);
  if (type == "Int32")
    return convert<std::int32_t>(bytes, out);
  if (type == "UInt32")
    return convert<std::uint32_t>(bytes, out);
  if (type == "Int64")
    return convert<std::int64_t>(bytes, out);
  return type == "UInt64" && convert<std::uint64_t>(bytes, out);
}

template <class Number>
hal::Result<std::vector<Number>> read_ascii(const pugi::xml_node& array, std::uint64_t count) {
  std::vector<Number> numbers;
  std::string_view rest = array.child_value();
  while (true) {
    rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
    if (rest.empty())
      break;
    const std::string_view token = rest.substr(0, rest.find_first_of(blanks));
    const auto number = hal::number_of<Number>(token);
    if (!number || !allowed(*number))
      return refuse(array, fmt::format("\"{:.40}\" as number {}", token, numbers.size() + 1),
                    std::is_integral_v<Number> ? "a whole number, 0 or more" : "a finite number");
    numbers.push_back(*number);
    rest.remove_prefix(token.size());
  }
  if (numbers.size() != count)
    return refuse(array, fmt::format("{} numbers", numbers.size()), fmt::format("{}", count));
  return numbers;
}

hal::Result<ByteStream> open_data(const pugi::xml_node& array, const VtpEncoding& encoding) {
  const std::string_view format = array.attribute("format").value();
  if (format == "binary")
    return ByteStream{array.child_value(), true};
  if (format != "appended")
    return refuse(array, fmt::format("the format \"{:.40}\"", format), "ascii, binary or appended");
  const std::uint64_t offset = array.attribute("offset").as_ullong(encoding.appended.size());
  if (offset >= encoding.appended.size())
    return refuse(array, fmt::format("the offset {}", array.attribute("offset").value()),
                  fmt::format("one within {} appended bytes", encoding.appended.size()));
  return ByteStream{encoding.appended.substr(offset), encoding.appended_is_base64};
}

template <class Number>
hal::Result<std::vector<Number>> read_array(const pugi::xml_node& array,
                                            const VtpEncoding& encoding, std::uint64_t count) {
  std::vector<Number> numbers;
  if (count == 0)
    return numbers;
  if (!array)
    return refuse(array, "none", fmt::format("{} numbers", count));
  const std::string_view type = array.attribute("type").value();
  const std::size_t bytes = bytes_of_type(type);
  if (bytes == 0)
    return refuse(array, fmt::format("the type \"{:.40}\"", type), "Float32, Int64 or the like");
  if (std::string_view{array.attribute("format").as_string("ascii")} == "ascii")
    return read_ascii<Number>(array, count);
  HAL_TRY(auto stream, open_data(array, encoding));
  HAL_TRY(const auto data, DataReader{array, encoding, std::move(stream)}.read(count * bytes));
  numbers.reserve(count);
  if (!convert(type, data, numbers))
    return refuse(array, fmt::format("number {} out of range", numbers.size() + 1),
                  std::is_integral_v<Number> ? "whole numbers, 0 or more" : "finite numbers");
  return numbers;
}

} // namespace

hal::Result<std::vector<double>>
read_vtp_numbers(const pugi::xml_node& array, const VtpEncoding& encoding, std::uint64_t count) {
  return read_array<double>(array, encoding, count);
}

hal::Result<std::vector<std::uint64_t>>
read_vtp_indices(const pugi::xml_node& array, const VtpEncoding& encoding, std::uint64_t count) {
  return read_array<std::uint64_t>(array, encoding, count);
}

} // namespace octascope::pipeline

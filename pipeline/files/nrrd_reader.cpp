#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "hal/number_text.h"
#include "pipeline/files/input_file.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/files/nrrd_bytes.h"
#include "pipeline/files/nrrd_header.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

constexpr std::string_view expected_file = "a NRRD volume";

enum class ValueType : std::uint8_t {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

// As the format spells them, and all other spellings that it knows.
struct TypeName {
  std::string_view name;
  ValueType type;
};
constexpr TypeName type_names[] = {{"signed char", ValueType::int8},
                                   {"int8", ValueType::int8},
                                   {"int8_t", ValueType::int8},
                                   {"uchar", ValueType::uint8},
                                   {"unsigned char", ValueType::uint8},
                                   {"uint8", ValueType::uint8},
                                   {"uint8_t", ValueType::uint8},
                                   {"short", ValueType::int16},
                                   {"short int", ValueType::int16},
                                   {"signed short", ValueType::int16},
                                   {"signed short int", ValueType::int16},
                                   {"int16", ValueType::int16},
                                   {"int16_t", ValueType::int16},
                                   {"ushort", ValueType::uint16},
                                   {"unsigned short", ValueType::uint16},
                                   {"unsigned short int", ValueType::uint16},
                                   {"uint16", ValueType::uint16},
                                   {"uint16_t", ValueType::uint16},
                                   {"int", ValueType::int32},
                                   {"signed int", ValueType::int32},
                                   {"int32", ValueType::int32},
                                   {"int32_t", ValueType::int32},
                                   {"uint", ValueType::uint32},
                                   {"unsigned int", ValueType::uint32},
                                   {"uint32", ValueType::uint32},
                                   {"uint32_t", ValueType::uint32},
                                   {"longlong", ValueType::int64},
                                   {"long long", ValueType::int64},
                                   {"long long int", ValueType::int64},
                                   {"signed long long", ValueType::int64},
                                   {"signed long long int", ValueType::int64},
                                   {"int64", ValueType::int64},
                                   {"int64_t", ValueType::int64},
                                   {"ulonglong", ValueType::uint64},
                                   {"unsigned long long", ValueType::uint64},
                                   {"unsigned long long int", ValueType::uint64},
                                   {"uint64", ValueType::uint64},
                                   {"uint64_t", ValueType::uint64},
                                   {"float", ValueType::float32},
                                   {"double", ValueType::float64}};

// Calls `use` with a value of the type.
template <class Use> auto with_type(ValueType type, Use use) {
  switch (type) {
  case ValueType::int8: return use(std::int8_t{});
  case ValueType::uint8: return use(std::uint8_t{});
  case ValueType::int16: return use(std::int16_t{});
  case ValueType::uint16: return use(std::uint16_t{});
  case ValueType::int32: return use(std::int32_t{});
  case ValueType::uint32: return use(std::uint32_t{});
  case ValueType::int64: return use(std::int64_t{});
  case ValueType::uint64: return use(std::uint64_t{});
  case ValueType::float64: return use(double{});
  case ValueType::float32: break;
  }
  return use(float{});
}

// What a stored value means: level = at_zero + value × step.
struct Scale {
  double at_zero = 0;
  double step = 1;

  Scale behind(const Scale& first) const {
    return {at_zero + first.at_zero * step, first.step * step};
  }
  bool operator==(const Scale&) const = default;
};

template <class Value> Value value_at(const std::byte* at, bool swap) {
  std::array<std::byte, sizeof(Value)> bytes;
  std::memcpy(bytes.data(), at, sizeof(Value));
  if (swap)
    std::ranges::reverse(bytes);
  return std::bit_cast<Value>(bytes);
}

template <class Value, class Level>
hal::Result<std::vector<Level>> read_levels(const NrrdHeader& header, NrrdBytes& bytes,
                                            const NrrdSize& size, bool swap, const Scale& scale) {
  const std::size_t count = size.bytes / sizeof(Value);
  constexpr std::size_t values_at_once = std::size_t{1} << 16;
  std::vector<std::byte> some(std::min(count, values_at_once) * sizeof(Value));
  std::vector<Level> levels(count);
  for (std::size_t done = 0; done < count; done += values_at_once) {
    const std::size_t values = std::min(count - done, values_at_once);
    HAL_TRY(const auto got, bytes.read(std::span{some}.first(values * sizeof(Value))));
    if (got < values * sizeof(Value))
      return size.refuse(header, done * sizeof(Value) + got);
    for (std::size_t i = 0; i < values; ++i) {
      const auto value = value_at<Value>(some.data() + i * sizeof(Value), swap);
      if constexpr (std::is_same_v<Level, std::uint8_t>)
        levels[done + i] = value;
      else
        levels[done + i] =
            static_cast<float>(scale.at_zero + static_cast<double>(value) * scale.step);
    }
  }
  return levels;
}

class NrrdReader {
public:
  explicit NrrdReader(NrrdHeader header) : header_(std::move(header)) {}

  // `data`: the data file's bytes, or those behind an attached header.
  hal::Result<NrrdVolume> read(std::span<const std::byte> data);

private:
  hal::Result<> check_dimension() const;
  hal::Result<ValueType> type() const;
  hal::Result<bool> swapped(ValueType type) const;
  hal::Result<Scale> scale_of_keys(ValueType type) const;
  hal::Result<Scale> scale(ValueType type) const;
  hal::Result<> note_what_follows(NrrdBytes& bytes, std::size_t b_scan_bytes);

  NrrdHeader header_;
  std::vector<std::string> remarks_;
};

hal::Result<NrrdVolume> NrrdReader::read(std::span<const std::byte> data) {
  HAL_CHECK(check_dimension());
  HAL_TRY(const auto type, this->type());
  HAL_TRY(const bool swap, swapped(type));
  HAL_TRY(const auto scale, this->scale(type));
  HAL_TRY(const auto geometry, nrrd_geometry(header_, remarks_));
  return with_type(type, [&](auto zero) -> hal::Result<NrrdVolume> {
    using Value = decltype(zero);
    const std::size_t count = geometry.voxels();
    const NrrdSize size{count * sizeof(Value),
                        fmt::format("{} = {} × {} × {} × {}", count * sizeof(Value),
                                    geometry.depths, geometry.a_scans, geometry.b_scans,
                                    sizeof(Value))};
    HAL_TRY(const auto bytes, NrrdBytes::open(header_, data, size));
    NrrdVolume volume{geometry, {}};
    if (std::is_same_v<Value, std::uint8_t> && scale == Scale{lowest_level_db, level_step_db}) {
      HAL_TRY(volume.levels,
              read_levels<std::uint8_t, std::uint8_t>(header_, *bytes, size, swap, scale));
    } else {
      HAL_TRY(volume.levels, read_levels<Value, float>(header_, *bytes, size, swap, scale));
    }
    HAL_CHECK(note_what_follows(*bytes, geometry.b_scan_voxels() * sizeof(Value)));
    volume.remarks = std::move(remarks_);
    if (const std::string* content = header_.find_key(nrrd_content))
      volume.content = *content;
    return volume;
  });
}

hal::Result<> NrrdReader::check_dimension() const {
  HAL_TRY(const auto dimension, header_.integer("dimension"));
  if (dimension != 3)
    return header_.refuse_field("dimension", "3: depth, A-scans, B-scans; `unu slice` takes one "
                                             "volume out of several");
  return {};
}

hal::Result<ValueType> NrrdReader::type() const {
  const std::string* found = header_.find("type");
  if (found != nullptr) {
    const auto* const known =
        std::ranges::find(type_names, in_small_letters(*found), &TypeName::name);
    if (known != std::end(type_names))
      return known->type;
  }
  return header_.refuse_field("type", "uint8, float, double or an integer of 8 to 64 bits");
}

hal::Result<bool> NrrdReader::swapped(ValueType type) const {
  if (with_type(type, [](auto zero) { return sizeof(zero); }) == 1)
    return false;
  const std::string* found = header_.find("endian");
  const std::string order = found == nullptr ? "" : in_small_letters(*found);
  if (order == "little" || order == "big")
    return order == "big";
  return header_.refuse_field("endian", "little or big, for a type of several bytes");
}

// Ours write them for 8-bit counts; they hold for whatever type another program made of these.
hal::Result<Scale> NrrdReader::scale_of_keys(ValueType type) const {
  const auto number = [&](std::string_view key, double otherwise) -> hal::Result<double> {
    const std::string* text = header_.find_key(key);
    if (text == nullptr)
      return otherwise;
    const auto value = hal::number_of<double>(*text);
    if (!value || !std::isfinite(*value))
      return header_.refuse(fmt::format("{}:={}", key, text->substr(0, 80)), "a number");
    return *value;
  };
  const bool counts = type == ValueType::uint8 && header_.find("old min") == nullptr;
  Scale scale;
  HAL_TRY(scale.at_zero, number("lowest_level_db", counts ? lowest_level_db : 0));
  HAL_TRY(scale.step, number("level_step_db", counts ? level_step_db : 1));
  return scale;
}

// With `old min` and `old max` integers are what they were quantised to, as `unu quantize` does it:
// 2^bits cells, a value in the middle of its cell.
hal::Result<Scale> NrrdReader::scale(ValueType type) const {
  HAL_TRY(const auto of_keys, scale_of_keys(type));
  const bool is_float = type == ValueType::float32 || type == ValueType::float64;
  if (is_float || (header_.find("old min") == nullptr && header_.find("old max") == nullptr))
    return of_keys;
  std::array<double, 2> range{};
  for (std::size_t i = 0; i < 2; ++i) {
    const char* const field = i == 0 ? "old min" : "old max";
    const std::string* text = header_.find(field);
    const auto value = text == nullptr ? std::nullopt : hal::number_of<double>(*text);
    if (!value || !std::isfinite(*value))
      return header_.refuse_field(field, "a number; both old min and old max, or neither");
    range[i] = *value;
  }
  return with_type(type, [&](auto zero) -> Scale {
    using Limits = std::numeric_limits<decltype(zero)>;
    const double least = static_cast<double>(Limits::lowest());
    const double step = (range[1] - range[0]) / (static_cast<double>(Limits::max()) - least + 1);
    return of_keys.behind({range[0] + (0.5 - least) * step, step});
  });
}

// As teem does, less than a B-scan behind the volume is no part of it; more says that sizes or type
// are not those of the data.
hal::Result<> NrrdReader::note_what_follows(NrrdBytes& bytes, std::size_t b_scan_bytes) {
  std::array<std::byte, 4096> some{};
  std::size_t surplus = 0;
  for (std::size_t got = some.size(); got == some.size() && surplus < b_scan_bytes;) {
    HAL_TRY(got, bytes.read(some));
    surplus += got;
  }
  if (surplus >= b_scan_bytes)
    return header_.refuse("data for more B-scans than sizes says",
                          "sizes and type to be those of the data");
  if (surplus > 0)
    remarks_.push_back(fmt::format("{} bytes behind the volume are left out", surplus));
  return {};
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace

hal::Result<NrrdVolume> parse_nrrd(std::span<const std::byte> file, std::string_view name) {
  HAL_TRY(auto header, NrrdHeader::parse(text_of(file), std::string{name}));
  if (header.find("data file") != nullptr)
    return header.refuse_field("data file", "the data behind the header");
  const auto data = file.subspan(header.bytes());
  return NrrdReader{std::move(header)}.read(data);
}

hal::Result<NrrdVolume> read_nrrd(const fs::path& file) {
  HAL_TRY(const auto input, InputFile::open(file, expected_file, UINT64_MAX));
  if (input.bytes() == 0)
    return hal::fail(ErrorCode::bad_data, "{}: is empty, expected {}", file.string(),
                     expected_file);
  HAL_TRY(const auto mapped, input.map());
  HAL_TRY(auto header, NrrdHeader::parse(text_of(mapped.bytes()), file.string()));
  if (header.find("data file") == nullptr) {
    const auto data = mapped.bytes().subspan(header.bytes());
    return NrrdReader{std::move(header)}.read(data);
  }
  const fs::path data_path = file.parent_path() / *header.find("data file");
  HAL_TRY(
      const auto data,
      InputFile::open(data_path, fmt::format("the data file of {}", file.string()), UINT64_MAX));
  if (data.bytes() == 0)
    return hal::fail(ErrorCode::bad_data, "{}: is empty, expected the data of {}",
                     data_path.string(), file.string());
  HAL_TRY(const auto mapped_data, data.map());
  return NrrdReader{std::move(header)}.read(mapped_data.bytes());
}

} // namespace octascope::pipeline

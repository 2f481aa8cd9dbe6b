#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "pipeline/files/nrrd.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

using Fields = std::map<std::string, std::string, std::less<>>;

// A header is small: what has none in its first lines is no NRRD file.
constexpr int most_header_lines = 256;

class NrrdReader {
public:
  explicit NrrdReader(fs::path file) : file_(std::move(file)) {}

  hal::Result<NrrdVolume> read();

private:
  tl::unexpected<hal::Error> refuse(std::string_view found, std::string_view expected) const {
    return hal::fail(ErrorCode::bad_data, "{}: found {}, expected {}", file_.string(), found,
                     expected);
  }
  hal::Result<> open();
  hal::Result<> read_fields();
  std::optional<std::string> next_line();
  hal::Result<> expect(std::string_view field, std::initializer_list<std::string_view> values);
  template <class Number> hal::Result<std::array<Number, 3>> three(std::string_view field) const;
  hal::Result<VolumeGeometry> geometry() const;
  template <class Voxel> hal::Result<NrrdVolume> read_voxels(const VolumeGeometry& geometry);

  fs::path file_;
  std::ifstream in_;
  Fields fields_;
};

hal::Result<NrrdVolume> NrrdReader::read() {
  HAL_CHECK(open());
  HAL_CHECK(read_fields()
                .and_then([&] { return expect("dimension", {"3"}); })
                .and_then([&] { return expect("encoding", {"raw"}); })
                .and_then([&] {
                  return expect("type", {"uint8", "uchar", "unsigned char", "float"});
                }));
  const bool is_float = fields_["type"] == "float";
  if (is_float || fields_.contains("endian")) {
    HAL_CHECK(expect("endian", {"little"}));
  }
  HAL_TRY(const auto found, geometry());
  return is_float ? read_voxels<float>(found) : read_voxels<std::uint8_t>(found);
}

hal::Result<> NrrdReader::open() {
  std::error_code error;
  const fs::file_status status = fs::status(file_, error);
  if (status.type() == fs::file_type::not_found)
    return hal::fail(ErrorCode::absent, "{}: there is no such file, expected a NRRD volume",
                     file_.string());
  if (!fs::is_regular_file(status))
    return refuse(fs::is_directory(status) ? "a directory" : "no regular file", "a NRRD volume");
  in_.open(file_, std::ios::binary);
  if (!in_)
    return hal::fail(ErrorCode::denied, "{}: cannot be opened: {}", file_.string(),
                     std::generic_category().message(errno));
  return {};
}

// Without its end; nothing at the end of the file or when the line is longer than any of a header.
std::optional<std::string> NrrdReader::next_line() {
  std::string line;
  for (int c = in_.get(); c != std::char_traits<char>::eof(); c = in_.get()) {
    if (c == '\n') {
      if (!line.empty() && line.back() == '\r')
        line.pop_back();
      return line;
    }
    if (line.size() == longest_nrrd_line)
      return std::nullopt;
    line.push_back(static_cast<char>(c));
  }
  return std::nullopt;
}

hal::Result<> NrrdReader::read_fields() {
  const auto magic = next_line();
  if (!magic || magic->size() != 8 || !magic->starts_with("NRRD000"))
    return refuse("no NRRD magic in its first line", "NRRD0001 to NRRD0005");
  for (int count = 0; count < most_header_lines; ++count) {
    const auto line = next_line();
    if (!line)
      return refuse("a header that does not end", "an empty line before the data");
    if (line->empty())
      return {};
    const std::size_t colon = line->find(':');
    const bool key_and_value = colon != std::string::npos && line->substr(colon, 2) == ":=";
    if (line->front() == '#' || key_and_value)
      continue;
    if (colon == std::string::npos || line->substr(colon, 2) != ": ")
      return refuse(fmt::format("the header line \"{}\"", *line), "\"field: value\"");
    const std::string name = line->substr(0, colon);
    if (name == "data file" || name == "datafile" || name.find("skip") != std::string::npos)
      return refuse(fmt::format("the field \"{}\"", name), "the data right behind the header");
    if (!fields_.emplace(name, line->substr(colon + 2)).second)
      return refuse(fmt::format("the field \"{}\" twice", name), "it once");
  }
  return refuse(fmt::format("more than {} header lines", most_header_lines), "fewer");
}

hal::Result<> NrrdReader::expect(std::string_view field,
                                 std::initializer_list<std::string_view> values) {
  const auto found = fields_.find(field);
  if (found == fields_.end())
    return refuse(fmt::format("no field \"{}\"", field), "it in the header");
  if (std::ranges::find(values, found->second) == values.end())
    return refuse(fmt::format("{}: {}", field, found->second),
                  fmt::format("{}: {}", field, *values.begin()));
  return {};
}

template <class Number>
hal::Result<std::array<Number, 3>> NrrdReader::three(std::string_view field) const {
  const auto found = fields_.find(field);
  if (found == fields_.end())
    return refuse(fmt::format("no field \"{}\"", field), "it in the header");
  std::array<Number, 3> numbers{};
  const char* at = found->second.data();
  const char* const end = at + found->second.size();
  for (Number& number : numbers) {
    while (at != end && *at == ' ')
      ++at;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc{})
      return refuse(fmt::format("{}: {}", field, found->second), "three numbers");
    at = stop;
  }
  if (!std::all_of(at, end, [](char c) { return c == ' '; }))
    return refuse(fmt::format("{}: {}", field, found->second), "three numbers");
  return numbers;
}

hal::Result<VolumeGeometry> NrrdReader::geometry() const {
  HAL_TRY(const auto sizes, three<int>("sizes"));
  constexpr int most = 1 << 20; // three of them stay within 64 bits
  for (const int size : sizes) {
    if (size < 1 || size > most)
      return refuse(fmt::format("the size {}", size), fmt::format("1 to {}", most));
  }
  VolumeGeometry geometry{sizes[0], sizes[1], sizes[2], 1000, 1000, 1000};
  if (fields_.contains("spacings")) {
    HAL_TRY(const auto spacings_mm, three<double>("spacings"));
    for (const double spacing : spacings_mm) {
      if (!std::isfinite(spacing) || spacing <= 0)
        return refuse(fmt::format("the spacing {}", spacing), "more than 0 mm");
    }
    geometry.depth_spacing_um = spacings_mm[0] * 1000;
    geometry.a_spacing_um = spacings_mm[1] * 1000;
    geometry.b_spacing_um = spacings_mm[2] * 1000;
  }
  return geometry;
}

template <class Voxel>
hal::Result<NrrdVolume> NrrdReader::read_voxels(const VolumeGeometry& geometry) {
  const auto header_bytes = static_cast<std::uintmax_t>(in_.tellg());
  std::error_code error;
  const std::uintmax_t found = fs::file_size(file_, error) - header_bytes;
  const std::uintmax_t expected = geometry.voxels() * sizeof(Voxel);
  if (error || found != expected)
    return refuse(fmt::format("{} bytes of data", found),
                  fmt::format("{} = {} × {} × {} × {}", expected, geometry.depths, geometry.a_scans,
                              geometry.b_scans, sizeof(Voxel)));
  std::vector<Voxel> voxels(geometry.voxels());
  if (!in_.read(reinterpret_cast<char*>(voxels.data()), static_cast<std::streamsize>(expected)))
    return hal::fail(ErrorCode::system, "{}: cannot be read to its end", file_.string());
  return NrrdVolume{geometry, std::move(voxels)};
}

} // namespace

hal::Result<NrrdVolume> read_nrrd(const fs::path& file) {
  return NrrdReader{file}.read();
}

} // namespace octascope::pipeline

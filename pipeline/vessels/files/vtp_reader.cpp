#include "pipeline/vessels/files/vtp_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "pipeline/files/input_file.h"
#include "pipeline/vessels/centrelines/centreline_joiner.h"
#include "pipeline/vessels/centrelines/line_ends.h"
#include "pipeline/vessels/files/vtp_data.h"
#include "pipeline/vessels/vessel_orders.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

constexpr std::string_view expected_file = "VTK XML poly data (.vtp)";
constexpr std::string_view appended_tag = "<AppendedData";
constexpr std::string_view appended_end = "</AppendedData>";

// The XML, and what lies behind its underscore: raw bytes are no XML and must not reach its parser.
struct VtpParts {
  std::string xml;
  std::string_view appended;
};

VtpParts split(std::string_view text) {
  VtpParts parts;
  const std::size_t tag = text.find(appended_tag);
  const std::size_t end = text.rfind(appended_end);
  const std::size_t underscore =
      tag == std::string_view::npos ? tag : text.find('_', text.find('>', tag));
  if (underscore == std::string_view::npos || end == std::string_view::npos || end < underscore) {
    parts.xml = text;
    return parts;
  }
  parts.appended = text.substr(underscore + 1, end - underscore - 1);
  parts.xml = std::string{text.substr(0, underscore)} + std::string{text.substr(end)};
  return parts;
}

std::string place_in(std::string_view text, std::ptrdiff_t offset) {
  const std::string_view before = text.substr(
      0, std::min(text.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0))));
  const auto line = std::ranges::count(before, '\n') + 1;
  return fmt::format("{}:{}", line, before.size() - (before.rfind('\n') + 1) + 1);
}

bool is_radius(std::string_view name) {
  if (name == "MaximumInscribedSphereRadius")
    return true;
  return std::ranges::equal(name, std::string_view{"radius"}, [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
  });
}

class VtpReader {
public:
  VtpReader(const fs::path& name, const TreeReadOptions& options)
      : name_{name}, options_{options}, unit_{options.unit.value_or(LengthUnit::mm)} {}

  hal::Result<VtpTree> read(std::string_view text);

private:
  tl::unexpected<hal::Error> refuse(std::string_view found, std::string_view expected) const {
    return hal::fail(ErrorCode::bad_data, "{}: found {}, expected {}", name_.string(), found,
                     expected);
  }
  tl::unexpected<hal::Error> told(const hal::Error& error) const {
    return hal::fail(error.code, "{}: {}", name_.string(), error.message);
  }
  hal::Result<> read_encoding(const pugi::xml_node& file, std::string_view appended);
  hal::Result<std::uint64_t> count_of(const pugi::xml_node& piece, const char* attribute) const;
  hal::Result<> read_piece(const pugi::xml_node& piece);
  hal::Result<> read_points(const pugi::xml_node& piece, std::uint64_t points);
  hal::Result<> read_radii(const pugi::xml_node& piece, std::uint64_t points);
  hal::Result<> read_lines(const pugi::xml_node& piece, std::uint64_t lines, std::uint64_t first,
                           std::uint64_t points);
  hal::Result<VtpTree> join();

  fs::path name_;
  const TreeReadOptions& options_;
  LengthUnit unit_;
  VtpEncoding encoding_;
  Centrelines lines_;
  VtpCounts counts_;
};

hal::Result<VtpTree> VtpReader::read(std::string_view text) {
  const VtpParts parts = split(text);
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(
      parts.xml.data(), parts.xml.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed)
    return hal::fail(ErrorCode::bad_data, "{}:{}: found no XML: {}, expected {}", name_.string(),
                     place_in(parts.xml, parsed.offset), parsed.description(), expected_file);
  const pugi::xml_node file = document.child("VTKFile");
  if (!file)
    return refuse("XML without a VTKFile", expected_file);
  HAL_CHECK(read_encoding(file, parts.appended));
  const pugi::xml_node data = file.child("PolyData");
  for (const pugi::xml_node& piece : data.children("Piece")) {
    HAL_CHECK(read_piece(piece));
    if (options_.stop.stop_requested())
      return reading_stopped(name_);
  }
  return join();
}

hal::Result<> VtpReader::read_encoding(const pugi::xml_node& file, std::string_view appended) {
  const std::string_view type = file.attribute("type").value();
  if (type != "PolyData")
    return refuse(fmt::format("VTK data of the type \"{:.40}\"", type), "PolyData");
  const std::string_view order = file.attribute("byte_order").as_string("LittleEndian");
  if (order != "LittleEndian")
    return refuse(fmt::format("the byte order \"{:.40}\"", order), "LittleEndian");
  const std::string_view header = file.attribute("header_type").as_string("UInt32");
  if (header != "UInt32" && header != "UInt64")
    return refuse(fmt::format("the header type \"{:.40}\"", header), "UInt32 or UInt64");
  const std::string_view compressor = file.attribute("compressor").value();
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
    return refuse(fmt::format("the compressor \"{:.40}\"", compressor),
                  "vtkZLibDataCompressor or none");
  const pugi::xml_node section = file.child("AppendedData");
  const std::string_view encoding = section.attribute("encoding").as_string("base64");
  if (encoding != "raw" && encoding != "base64")
    return refuse(fmt::format("appended data in \"{:.40}\"", encoding), "raw or base64");
  encoding_.header_bytes = header == "UInt64" ? 8 : 4;
  encoding_.compressed = !compressor.empty();
  encoding_.appended_is_base64 = encoding == "base64";
  encoding_.appended = appended;
  return {};
}

hal::Result<std::uint64_t> VtpReader::count_of(const pugi::xml_node& piece,
                                               const char* attribute) const {
  const std::string_view text = piece.attribute(attribute).as_string("0");
  std::uint64_t count = 0;
  const bool digits = !text.empty() && text.size() < 16 &&
                      std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  for (const char c : digits ? text : std::string_view{})
    count = 10 * count + static_cast<std::uint64_t>(c - '0');
  if (!digits || count > options_.limits.rows)
    return refuse(fmt::format("{}=\"{:.40}\"", attribute, text),
                  fmt::format("0 to {}", options_.limits.rows));
  return count;
}

hal::Result<> VtpReader::read_piece(const pugi::xml_node& piece) {
  const auto points = count_of(piece, "NumberOfPoints");
  const auto lines = count_of(piece, "NumberOfLines");
  if (!points || !lines)
    return tl::make_unexpected((points ? lines : points).error());
  for (const char* others : {"NumberOfVerts", "NumberOfPolys", "NumberOfStrips"}) {
    HAL_TRY(const auto cells, count_of(piece, others));
    counts_.other_cells += cells;
  }
  const std::uint64_t first = lines_.positions_mm.size();
  if (first + *points > options_.limits.rows)
    return refuse(fmt::format("more than {} points", options_.limits.rows), "fewer");
  if (*points == 0)
    return {};
  counts_.points += *points;
  counts_.lines += *lines;
  return read_points(piece, *points)
      .and_then([&] { return read_radii(piece, *points); })
      .and_then([&] { return read_lines(piece, *lines, first, *points); });
}

hal::Result<> VtpReader::read_points(const pugi::xml_node& piece, std::uint64_t points) {
  const pugi::xml_node array = piece.child("Points").child("DataArray");
  if (!array)
    return refuse("no array of points", "one in a piece that has some");
  if (array.attribute("NumberOfComponents").as_int(3) != 3)
    return refuse("points that have not 3 components", "x, y and z");
  const auto numbers = read_vtp_numbers(array, encoding_, 3 * points);
  if (!numbers)
    return told(numbers.error());
  const double scale = unit_ == LengthUnit::um ? 1e-3 : 1;
  for (std::size_t i = 0; i < points; ++i) {
    std::array<double, 3> place{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] = (*numbers)[3 * i + axis] * scale;
      if (std::fabs(place[axis]) > double{largest_vessel_length_mm})
        return refuse(fmt::format("point {} at {:g} mm", i, place[axis]),
                      fmt::format("at most {:g} mm", largest_vessel_length_mm));
    }
    lines_.positions_mm.push_back(place);
  }
  return {};
}

hal::Result<> VtpReader::read_radii(const pugi::xml_node& piece, std::uint64_t points) {
  const pugi::xml_node point_data = piece.child("PointData");
  const pugi::xml_node array = point_data.find_child([](const pugi::xml_node& node) {
    return std::string_view{node.name()} == "DataArray" &&
           is_radius(node.attribute("Name").value());
  });
  if (!array) {
    std::string names;
    for (const pugi::xml_node& other : point_data.children("DataArray"))
      names +=
          fmt::format("{}\"{:.40}\"", names.empty() ? "" : ", ", other.attribute("Name").value());
    return refuse(names.empty() ? "no array at the points"
                                : fmt::format("the point arrays {:.200}", names),
                  "one named \"radius\" or \"MaximumInscribedSphereRadius\"");
  }
  counts_.radius_array = array.attribute("Name").value();
  if (array.attribute("NumberOfComponents").as_int(1) != 1)
    return refuse("radii of several components", "one a point");
  const auto radii = read_vtp_numbers(array, encoding_, points);
  if (!radii)
    return told(radii.error());
  const double scale = unit_ == LengthUnit::um ? 1e-3 : 1;
  for (std::size_t i = 0; i < points; ++i) {
    const double radius = (*radii)[i] * scale;
    if (!(radius >= 0 && radius <= double{largest_vessel_length_mm}))
      return refuse(fmt::format("the radius {:g} mm at point {}", radius, i),
                    fmt::format("0 to {:g} mm", largest_vessel_length_mm));
    lines_.radii_mm.push_back(radius);
  }
  return {};
}

hal::Result<> VtpReader::read_lines(const pugi::xml_node& piece, std::uint64_t lines,
                                    std::uint64_t first, std::uint64_t points) {
  const auto array = [&](const char* name) {
    return piece.child("Lines").find_child_by_attribute("DataArray", "Name", name);
  };
  if (lines > 0 && (!array("offsets") || !array("connectivity")))
    return refuse("lines without connectivity and offsets", "both arrays");
  const auto ends = read_vtp_indices(array("offsets"), encoding_, lines);
  if (!ends)
    return told(ends.error());
  const std::uint64_t before = lines_.points.size();
  const std::uint64_t count = ends->empty() ? 0 : ends->back();
  if (!std::ranges::is_sorted(*ends))
    return refuse("offsets of lines that fall", "each line behind the one before");
  if (count > options_.limits.rows || before + count > options_.limits.rows)
    return refuse(fmt::format("lines of {} points", count),
                  fmt::format("at most {}", options_.limits.rows));
  const auto indices = read_vtp_indices(array("connectivity"), encoding_, count);
  if (!indices)
    return told(indices.error());
  for (const std::uint64_t index : *indices) {
    if (index >= points)
      return refuse(fmt::format("a line through point {}", index),
                    fmt::format("points 0 to {}", points - 1));
    lines_.points.push_back(first + index);
  }
  for (const std::uint64_t end : *ends)
    lines_.ends.push_back(before + end);
  return {};
}

hal::Result<VtpTree> VtpReader::join() {
  if (lines_.points.empty())
    return refuse(
        fmt::format("{} points, no line and {} other cells", counts_.points, counts_.other_cells),
        "centrelines: lines with a radius at every point");
  JoinedCentrelines joined = join_centrelines(lines_);
  if (!joined.loop.empty())
    return refuse(fmt::format("a loop: two ways to {}", joined.loop), "a tree");
  VtpTree result;
  result.unit = unit_;
  result.tree = std::move(joined.tree);
  if (result.tree.nodes() == 0)
    return refuse("no line of two points or more", "centrelines");
  counts_.nodes = result.tree.nodes();
  counts_.merged_points = joined.merged_points;
  counts_.unused_points = joined.unused_points;
  counts_.short_lines = joined.short_lines;
  counts_.roots = static_cast<std::uint64_t>(std::ranges::count(result.tree.parents, no_parent));
  if (counts_.roots > 1 && !options_.forest)
    return refuse(fmt::format("{} pieces: no end of one lies within {:g} of the radius of another",
                              counts_.roots, end_within_radii),
                  "one; several are allowed as a forest (--forest)");
  HAL_TRY(const auto zeros, mend_zero_radii(result.tree, options_.zero_radius, name_));
  counts_.zero_radii = zeros;
  counts_.coincident = count_coincident(result.tree);
  assign_vessel_orders(result.tree, options_.stop);
  if (options_.stop.stop_requested())
    return reading_stopped(name_);
  result.counts = std::move(counts_);
  return result;
}

} // namespace

hal::Result<VtpTree> parse_vtp(std::string_view text, const fs::path& name,
                               const TreeReadOptions& options) {
  return VtpReader{name, options}.read(text);
}

hal::Result<VtpTree> read_vtp(const fs::path& file, const TreeReadOptions& options) {
  HAL_TRY(const auto input, InputFile::open(file, expected_file, options.limits.bytes));
  HAL_TRY(const auto text, input.read_rest(options.limits.bytes));
  auto read = parse_vtp(text, file, options);
  if (read && options.progress)
    options.progress(1);
  return read;
}

} // namespace octascope::pipeline

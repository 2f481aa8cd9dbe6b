#include "pipeline/vessels/files/vtp_writer.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "pipeline/files/atomic_file.h"
#include "pipeline/vessels/files/decimal.h"
#include "pipeline/vessels/files/tree_reading.h"
#include "pipeline/vessels/files/tree_writing.h"

namespace octascope::pipeline {

namespace {

// Numbers a line of text holds.
constexpr std::size_t a_row = 12;

struct VesselLines {
  std::vector<std::uint32_t> nodes; // of all vessels, one after the other
  std::vector<std::uint64_t> ends;  // of each vessel in `nodes`: one past its last
};

// Children lie behind their parents.
VesselLines lines_of(const VesselTree& tree) {
  const std::size_t nodes = tree.nodes();
  std::vector<std::uint32_t> children(nodes);
  std::vector<std::uint32_t> only_child(nodes, no_parent);
  for (std::uint32_t i = 0; i < nodes; ++i)
    if (const std::uint32_t parent = tree.parents[i]; parent != no_parent) {
      ++children[parent];
      only_child[parent] = i;
    }
  VesselLines lines;
  for (std::uint32_t first = 0; first < nodes; ++first) {
    const std::uint32_t parent = tree.parents[first];
    if (parent == no_parent || (tree.parents[parent] != no_parent && children[parent] == 1))
      continue; // a root, or the vessel of its parent goes on here
    lines.nodes.push_back(parent);
    std::uint32_t node = first;
    for (; children[node] == 1; node = only_child[node])
      lines.nodes.push_back(node);
    lines.nodes.push_back(node);
    lines.ends.push_back(lines.nodes.size());
  }
  return lines;
}

class VtpText {
public:
  void add(std::string_view text) { text_ += text; }
  void begin(std::string_view attributes) {
    text_ += fmt::format("<DataArray {} format=\"ascii\">\n", attributes);
    in_row_ = 0;
  }
  void end() { text_ += "\n</DataArray>\n"; }
  void add_length(float mm) {
    char decimal[longest_decimal];
    add_number({decimal, write_decimal(decimal, mm, 0)});
  }
  void add_index(std::uint64_t index) { add_number(fmt::format_int{index}.c_str()); }
  std::string_view text() const { return text_; }

private:
  void add_number(std::string_view number) {
    if (in_row_ > 0)
      text_ += in_row_ % a_row == 0 ? '\n' : ' ';
    text_ += number;
    ++in_row_;
  }

  std::string text_;
  std::size_t in_row_ = 0;
};

} // namespace

hal::Result<> write_vtp(const std::filesystem::path& file, const VesselTree& tree) {
  HAL_CHECK(check_tree_to_write(file, tree, TreeLimits{}.rows));
  const VesselLines lines = lines_of(tree);
  if (lines.ends.empty())
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        "{}: cannot be written: found {} nodes without a segment, expected one or more",
        file.string(), tree.nodes());
  VtpText vtp;
  vtp.add(fmt::format("<?xml version=\"1.0\"?>\n"
                      "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
                      "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" "
                      "NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
                      "<PointData Scalars=\"Radius\">\n",
                      tree.nodes(), lines.ends.size()));
  vtp.begin("type=\"Float32\" Name=\"Radius\"");
  for (const float radius : tree.radii_mm)
    vtp.add_length(radius);
  vtp.end();
  vtp.add("</PointData>\n<Points>\n");
  vtp.begin("type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\"");
  for (const auto& position : tree.positions_mm)
    for (const float mm : position)
      vtp.add_length(mm);
  vtp.end();
  vtp.add("</Points>\n<Lines>\n");
  vtp.begin("type=\"Int64\" Name=\"connectivity\"");
  for (const std::uint32_t node : lines.nodes)
    vtp.add_index(node);
  vtp.end();
  vtp.begin("type=\"Int64\" Name=\"offsets\"");
  for (const std::uint64_t end : lines.ends)
    vtp.add_index(end);
  vtp.end();
  vtp.add("</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n");
  return write_atomically(file, vtp.text());
}

} // namespace octascope::pipeline

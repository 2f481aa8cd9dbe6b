// Centrelines in VTK's files: what VTK 9.1 itself wrote (tests/centrelines), and what it would not.
#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/files/tree_file.h"
#include "pipeline/vessels/files/vtp_reader.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"
#include "tests/support/program/built_places.h"

namespace octascope::pipeline {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

struct Text {
  std::string points = "0 0 0  1 0 0  2 0 0  1 0 0  1 1 0";
  std::string radii = "3 2 1 2 0.5";
  std::string connectivity = "0 1 2 3 4";
  std::string offsets = "3 5";
  int point_count = 5;
  int line_count = 2;
  std::string file_attributes = "type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\"";
  std::string radius_name = "Radius";
  std::string point_type = "Float32";

  std::string file() const {
    return fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile {}>\n<PolyData>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfLines=\"{}\">\n"
        "<PointData><DataArray type=\"Float32\" Name=\"{}\" format=\"ascii\">{}</DataArray>"
        "</PointData>\n"
        "<Points><DataArray type=\"{}\" NumberOfComponents=\"3\" format=\"ascii\">{}</DataArray>"
        "</Points>\n"
        "<Lines><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">{}</DataArray>\n"
        "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">{}</DataArray></Lines>\n"
        "</Piece>\n</PolyData>\n</VTKFile>\n",
        file_attributes, point_count, line_count, radius_name, radii, point_type, points,
        connectivity, offsets);
  }
};

VtpTree good(std::string_view text, const TreeReadOptions& options = {}) {
  return tests::must(parse_vtp(text, "v.vtp", options));
}

std::string refusal(std::string_view text, const TreeReadOptions& options = {}) {
  const hal::Error error = tests::error_of(parse_vtp(text, "v.vtp", options));
  EXPECT_EQ(error.code, hal::ErrorCode::bad_data);
  EXPECT_THAT(error.message, testing::StartsWith("v.vtp:"));
  return error.message;
}

template <class Spoil> std::string refusal_of(Spoil spoil) {
  Text text;
  spoil(text);
  return refusal(text.file());
}

// Three lines from the root to a tip each, as VMTK has them, of 10, 9 and 5 points: two share six
// points, and all three the first three.
TEST(VtpReader, reads_what_vtk_writes_in_every_encoding) {
  VesselTree first;
  int files = 0;
  for (const auto& entry : fs::directory_iterator{tests::source_folder() / "tests/centrelines"}) {
    const auto read = tests::must(read_vtp(entry.path()));
    const VesselTree& tree = read.tree;
    EXPECT_EQ(read.counts.points, 24U);
    EXPECT_EQ(read.counts.lines, 3U);
    EXPECT_EQ(read.counts.merged_points, 9U);
    EXPECT_EQ(read.counts.roots, 1U);
    EXPECT_EQ(read.counts.radius_array, "MaximumInscribedSphereRadius");
    ASSERT_EQ(tree.nodes(), 15U) << entry.path();
    if (files++ == 0)
      first = tree;
    EXPECT_EQ(tree.positions_mm, first.positions_mm) << entry.path();
    EXPECT_EQ(tree.radii_mm, first.radii_mm);
    EXPECT_EQ(tree.parents, first.parents);
    EXPECT_EQ(tree.orders, first.orders);
  }
  EXPECT_EQ(files, 6);
  EXPECT_EQ(first.parents[0], no_parent);
  for (std::size_t i = 0; i < first.nodes(); ++i) { // as they were made
    const auto [x, y, z] = first.positions_mm[i];
    float expected = 2 - z / 2; // the trunk
    if (x > 0)
      expected = 0.9F - x / 3;
    else if (x < 0)
      expected = 1 + x / 3;
    else if (y > 0)
      expected = 0.5F - y / 8;
    EXPECT_NEAR(first.radii_mm[i], expected, 1e-5F) << x << " " << y << " " << z;
  }
  std::vector<int> children(first.nodes(), 0);
  for (const std::uint32_t parent : first.parents)
    if (parent != no_parent)
      ++children[parent];
  EXPECT_EQ(std::ranges::count(children, 2), 2);
  EXPECT_EQ(std::ranges::count(children, 0), 3);
}

TEST(VtpReader, joins_lines_at_one_place) {
  const VtpTree read = good(Text{}.file());
  EXPECT_THAT(read.tree.parents, ElementsAre(no_parent, 0U, 1U, 1U));
  EXPECT_THAT(read.tree.radii_mm, ElementsAre(3.0F, 2.0F, 1.0F, 0.5F));
  EXPECT_EQ(read.counts.merged_points, 1U);
  EXPECT_EQ(read.counts.nodes, 4U);
  EXPECT_EQ(read.unit, LengthUnit::mm);
}

TEST(VtpReader, joins_ends_within_a_tenth_of_the_radius_only) {
  Text text;
  text.points = "0 0 0  1 0 0  2 0 0  1 0 0.19  1 1 0";
  EXPECT_EQ(good(text.file()).counts.nodes, 4U);
  text.points = "0 0 0  1 0 0  2 0 0  1 0 0.21  1 1 0";
  EXPECT_THAT(refusal(text.file()), HasSubstr("found 2 pieces: no end of one lies within 0.1 of "
                                              "the radius of another, expected one; several are "
                                              "allowed as a forest"));
  TreeReadOptions options;
  options.forest = true;
  EXPECT_EQ(good(text.file(), options).counts.roots, 2U);
  text.radii = "3 2 1 2.2 0.5";
  EXPECT_EQ(refusal(text.file()).find("found 2 pieces"), 7U); // the trunk's is the smaller one
}

// The branch comes first in the file, and begins on the trunk: the trunk's mouth is the root.
TEST(VtpReader, begins_where_no_line_leads_to) {
  Text text;
  text.connectivity = "3 4 0 1 2";
  text.offsets = "2 5";
  const VtpTree read = good(text.file());
  EXPECT_EQ(read.tree.positions_mm[0], (std::array{0.0F, 0.0F, 0.0F}));
  EXPECT_EQ(read.counts.roots, 1U);
}

TEST(VtpReader, counts_what_it_leaves_out) {
  Text text;
  text.points += " 7 7 7  8 8 8";
  text.radii += " 1 1";
  text.point_count = 7;
  text.connectivity += " 5";
  text.offsets += " 6";
  text.line_count = 3;
  std::string file = text.file();
  file.insert(file.find("NumberOfLines"), "NumberOfVerts=\"4\" NumberOfPolys=\"2\" ");
  const VtpTree read = good(file);
  EXPECT_EQ(read.counts.nodes, 4U);
  EXPECT_EQ(read.counts.unused_points, 1U);
  EXPECT_EQ(read.counts.short_lines, 1U);
  EXPECT_EQ(read.counts.other_cells, 6U);
}

TEST(VtpReader, takes_the_unit_and_the_radius_policy_as_swc_does) {
  Text text;
  text.radii = "3 0 1 0 0.5";
  TreeReadOptions options;
  options.unit = LengthUnit::um;
  const VtpTree read = good(text.file(), options);
  EXPECT_EQ(read.counts.zero_radii, 1U);
  EXPECT_THAT(read.tree.radii_mm, ElementsAre(0.003F, 0.003F, 0.001F, 0.0005F));
  options.zero_radius = ZeroRadius::refuse;
  EXPECT_THAT(refusal(text.file(), options), HasSubstr("found 1 nodes of radius 0, expected none"));
}

TEST(VtpReader, says_what_is_wrong) {
  EXPECT_THAT(refusal("<VTKFile>\n<Poly"), HasSubstr("v.vtp:2:"));
  EXPECT_THAT(refusal("<svg/>"), HasSubstr("found XML without a VTKFile"));
  EXPECT_THAT(refusal_of([](Text& t) { t.file_attributes = "type=\"ImageData\""; }),
              HasSubstr("found VTK data of the type \"ImageData\", expected PolyData"));
  EXPECT_THAT(
      refusal_of([](Text& t) { t.file_attributes = "type=\"PolyData\" byte_order=\"BigEndian\""; }),
      HasSubstr("found the byte order \"BigEndian\", expected LittleEndian"));
  EXPECT_THAT(
      refusal_of([](Text& t) { t.file_attributes += " compressor=\"vtkLZ4DataCompressor\""; }),
      HasSubstr("found the compressor \"vtkLZ4DataCompressor\", expected vtkZLib"));
  EXPECT_THAT(refusal_of([](Text& t) { t.file_attributes += " header_type=\"UInt16\""; }),
              HasSubstr("found the header type \"UInt16\""));
  EXPECT_THAT(refusal_of([](Text& t) { t.radius_name = "thickness"; }),
              HasSubstr("found the point arrays \"thickness\", expected one named \"radius\""));
  EXPECT_THAT(refusal_of([](Text& t) { t.radii = "1 2 nan 4 5"; }),
              HasSubstr("array \"Radius\": found \"nan\" as number 3, expected a finite number"));
  EXPECT_THAT(refusal_of([](Text& t) { t.radii = "1 2 -3 4 5"; }),
              HasSubstr("found the radius -3 mm at point 2"));
  EXPECT_THAT(refusal_of([](Text& t) { t.radii = "1 2 3 4"; }),
              HasSubstr("array \"Radius\": found 4 numbers, expected 5"));
  EXPECT_THAT(refusal_of([](Text& t) { t.points = "0 0 0 1e10 0 0 2 0 0 1 0 0 1 1 0"; }),
              HasSubstr("found point 1 at 1e+10 mm, expected at most 1e+09 mm"));
  EXPECT_THAT(refusal_of([](Text& t) { t.point_type = "Float128"; }),
              HasSubstr("found the type \"Float128\""));
  EXPECT_THAT(refusal_of([](Text& t) { t.connectivity = "0 1 2 3 5"; }),
              HasSubstr("found a line through point 5, expected points 0 to 4"));
  EXPECT_THAT(refusal_of([](Text& t) { t.connectivity = "0 1 2 3 -1"; }),
              HasSubstr("found \"-1\" as number 5, expected a whole number"));
  EXPECT_THAT(refusal_of([](Text& t) { t.offsets = "3 2"; }),
              HasSubstr("offsets of lines that fall"));
  EXPECT_THAT(refusal_of([](Text& t) { t.point_count = -1; }),
              HasSubstr("found NumberOfPoints=\"-1\", expected 0 to"));
  EXPECT_THAT(refusal_of([](Text& t) { t.point_count = 2'000'000'000; }),
              HasSubstr("found NumberOfPoints=\"2000000000\""));
  EXPECT_THAT(refusal_of([](Text& t) { t.line_count = 0; }),
              HasSubstr("found 5 points, no line and 0 other cells, expected centrelines"));
}

TEST(VtpReader, refuses_loops) {
  Text text;
  text.connectivity = "0 1 4 2 4 0";
  text.offsets = "4 6";
  text.points = "0 0 0  1 0 0  2 0 0  5 5 5  1 1 0";
  EXPECT_THAT(refusal(text.file()), HasSubstr("found a loop: two ways to point"));
}

// Sizes that data say of themselves are not believed.
TEST(VtpReader, refuses_data_that_end_early) {
  const fs::path folder = tests::source_folder() / "tests/centrelines";
  for (const char* name : {"appended_raw_u64.vtp", "appended_raw_zlib_u32.vtp", "binary_u32.vtp",
                           "appended_base64_u32.vtp"}) {
    std::string text = tests::whole_file(folder / name);
    const bool appended = text.find("<AppendedData") != std::string::npos;
    const std::size_t at = appended ? text.find('_', text.find("<AppendedData")) + 12
                                    : text.find('>', text.find("Radius")) + 30;
    const std::size_t end = appended ? text.rfind("\n  </AppendedData>") : text.find("\n", at);
    text.erase(at, end - at);
    const std::string message = refusal(text);
    EXPECT_THAT(message, HasSubstr("found")) << name;
  }
}

TEST(TreeFile, is_told_by_its_content) {
  const tests::ScratchFolder folder;
  const auto swc = tests::must(read_tree(folder.write("a.vtp", "1 0 0 0 0 1 -1\n")));
  EXPECT_TRUE(std::holds_alternative<SwcCounts>(swc.counts));
  EXPECT_EQ(swc.unit, LengthUnit::um);
  const auto vtp = tests::must(read_tree(folder.write("b.swc", "\xEF\xBB\xBF" + Text{}.file())));
  EXPECT_TRUE(std::holds_alternative<VtpCounts>(vtp.counts));
  EXPECT_EQ(vtp.unit, LengthUnit::mm);
  EXPECT_THAT(read_tree(folder.write("c.swc", {"\0\1\2", 3})),
              tests::FailsSaying("c.swc: found bytes that are no text, expected a "
                                 "vessel tree: a .vessels file, SWC text or VTK XML poly data"));
}

} // namespace
} // namespace octascope::pipeline

// octascope vessels info: what it says of a tree, and of what is none.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "tests/support/files/mutation.h"
#include "tests/support/program/built_places.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// A trunk of two segments, two twigs, in a sequence that is not the tree's, with one radius
// missing and one node upon its parent.
constexpr std::string_view small = "# small\n\n"
                                   "5 17 1000 -500 0 40 2\n"
                                   "1 17 0 0 0 200 -1\n"
                                   "2 17 1000 0 0 190 1\n"
                                   "3 17 1000 0 0 180 2\n"
                                   "4 17 1000 500 250 0 3\n";

json info(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"vessels", "info", "--json"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const ProgramResult result = run_well(words);
  EXPECT_EQ(result.err, "");
  return json::parse(result.out, nullptr, false);
}

TEST(VesselsInfo, tells_a_tree_in_json) {
  const ScratchFolder folder;
  const json told = info({folder.write("small.swc", small)});
  expect_all(told, json::parse(R"({
    "kind": "swc", "unit": "um", "nodes": 5, "segments": 4, "roots": 1, "branch_points": 1,
    "tips": 2, "bounds_mm": [[0, -0.5, 0], [1, 0.5, 0.25]], "rows": 7, "comments": 1, "blanks": 1,
    "late_parents": 1, "zero_radii": 1, "coincident": 1, "branches": {"lad": 4}
  })"));
  EXPECT_EQ(told.at("types"), json::parse(R"({"17": 5})"));
  int segments = 0;
  for (const json& order : told.at("orders"))
    segments += order.at("segments").get<int>();
  EXPECT_EQ(segments, 4);
}

TEST(VesselsInfo, takes_the_unit_from_the_command_line) {
  const ScratchFolder folder;
  const json told = info({folder.write("small.swc", small), "--unit", "mm"});
  EXPECT_EQ(told.at("bounds_mm"), json::parse("[[0, -500, 0], [1000, 500, 250]]"));
}

TEST(VesselsInfo, reads_centrelines_of_vtk) {
  const json told = info({(source_folder() / "tests/centrelines/binary_zlib_u64.vtp").string()});
  expect_all(told, {{"kind", "vtp"}, {"nodes", 15}, {"branch_points", 2}, {"merged_points", 9}});
}

TEST(VesselsInfo, speaks_to_people) {
  const ScratchFolder folder;
  const ProgramResult result = run_well({"vessels", "info", folder.write("small.swc", small)});
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("5 nodes, 4 segments, 1 roots, 1 branch points, 2 tips"));
  EXPECT_THAT(result.out, HasSubstr("bounds 0 to 1, -0.5 to 0.5, 0 to 0.25 mm"));
  EXPECT_THAT(result.out, HasSubstr("1 nodes of radius 0, given their parent's"));
}

TEST(VesselsInfo, compares_nothing_but_coronary_arteries) {
  const ScratchFolder folder;
  EXPECT_FALSE(info({folder.write("small.swc", small)}).contains("table"));
}

TEST(VesselsInfo, finds_a_damaged_file_of_ours) {
  const ScratchFolder folder;
  ASSERT_EQ(run_octascope({"vessels", "convert", folder.write("small.swc", small), "--out",
                           folder / "small.vessels"})
                .exit_status,
            0);
  std::string bytes = whole_file(folder / "small.vessels");
  bytes[bytes.size() - 9] ^= 1;
  const ProgramResult result =
      run_octascope({"vessels", "info", folder.write("small.vessels", bytes)});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_THAT(result.err, HasSubstr("small.vessels: "));
  EXPECT_THAT(result.err, HasSubstr("checksum"));
}

TEST(VesselsConvert, goes_to_our_format_and_back) {
  const ScratchFolder folder;
  const std::filesystem::path swc = folder.write("small.swc", small);
  const auto convert = [&](const std::filesystem::path& from, const std::filesystem::path& to) {
    const ProgramResult result = run_well({"vessels", "convert", from, "--out", to});
    EXPECT_EQ(result.out, to.string() + ": 5 nodes written\n");
    EXPECT_EQ(result.err, "");
  };
  convert(swc, folder / "small.vessels");
  convert(folder / "small.vessels", folder / "back.swc");
  const json told = info({folder / "small.vessels"});
  EXPECT_THAT(told.at("provenance").get<std::string>(),
              HasSubstr("small.swc, lengths in um, converted by octascope "));
  EXPECT_EQ(told.at("coincident"), 1);
  const json before = info({swc});
  const json after = info({folder / "back.swc"});
  for (const char* same : {"nodes", "segments", "roots", "branch_points", "tips", "branches"}) {
    EXPECT_EQ(told.at(same), before.at(same)) << same;
    EXPECT_EQ(after.at(same), before.at(same)) << same;
  }
  EXPECT_EQ(told.at("bounds_mm"), before.at("bounds_mm"));
  EXPECT_NEAR(told.at("length_mm").get<double>(), before.at("length_mm").get<double>(), 1e-3);
}

TEST(VesselsConvert, keeps_a_tree_of_one_node) {
  const ScratchFolder folder;
  const std::filesystem::path swc = folder.write("one.swc", "1 0 1000 2000 3000 4 -1\n");
  run_well({"vessels", "convert", swc, "--out", folder / "one.vessels"});
  const json told = info({folder / "one.vessels"});
  expect_all(told, json::parse(R"({"nodes": 1, "lone_roots": 1, "tips": 1,
                                   "bounds_mm": [[1, 2, 3], [1, 2, 3]]})"));
}

TEST(VesselsConvert, writes_nothing_of_a_bad_file) {
  const ScratchFolder folder;
  const std::filesystem::path bad = folder.write("bad.swc", "1 0 0 0 0 1 2\n");
  const ProgramResult result =
      run_octascope({"vessels", "convert", bad, "--out", folder / "bad.vessels"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_THAT(result.err, HasSubstr("octascope vessels convert: " + bad.string() + ":1:13: "));
  EXPECT_EQ(folder.count(), 1);
}

struct BadTree {
  std::string name;
  std::string text;
  std::string told;                   // with @ for the file
  std::vector<std::string> more = {}; // arguments
  int exit_status = 1;
  friend void PrintTo(const BadTree& tree, std::ostream* out) { *out << tree.name; }
};

class BadTrees : public testing::TestWithParam<BadTree> {};

TEST_P(BadTrees, are_refused_in_one_line) {
  const ScratchFolder folder;
  const std::string file = folder.write("bad.swc", GetParam().text);
  std::vector<std::string> words{"vessels", "info", file};
  words.insert(words.end(), GetParam().more.begin(), GetParam().more.end());
  const std::string said = run_refused(folder, words, GetParam().exit_status);
  std::string told = GetParam().told;
  if (told.starts_with('@'))
    told.replace(0, 1, "octascope vessels info: " + file);
  EXPECT_THAT(said, HasSubstr(told));
}

INSTANTIATE_TEST_SUITE_P(
    Vessels, BadTrees,
    testing::Values(
        BadTree{"garbage", "1 0 0 zero 0 1 -1\n",
                "@:1:7: found \"zero\" as y, expected a finite decimal number\n"},
        BadTree{"no_root", "1 0 0 0 0 1 2\n2 0 0 0 0 1 1\n",
                "@:1:13: found a cycle of 2 nodes, 1 among them, expected parents that lead to a "
                "root\n"},
        BadTree{"two_roots", "1 0 0 0 0 1 -1\n2 0 0 0 0 1 -1\n",
                "@:2:13: found a second root, expected one; several are allowed as a forest "
                "(--forest)\n"},
        BadTree{"late_and_strict",
                "2 0 0 0 0 1 1\n1 0 0 0 0 1 -1\n",
                "@:1:13: found the parent 1 in a later row",
                {"--strict"}},
        BadTree{"zero_and_refused",
                "1 0 0 0 0 0 -1\n",
                "@: found 1 nodes of radius 0, expected none",
                {"--zero-radius", "refuse"}},
        BadTree{"empty", "", "@:1:1: found the end of the file and no node"},
        BadTree{"half_of_xml", "<VTKFile type=\"PolyData\">\n<PolyData", "@:2:9: found no XML: "},
        BadTree{"unknown_unit", "1 0 0 0 0 1 -1\n", "--unit", {"--unit", "inch"}, 2},
        BadTree{"two_files", "1 0 0 0 0 1 -1\n", "another.swc", {"another.swc"}, 2}),
    [](const auto& test) { return test.param.name; });

TEST(VesselsInfo, refuses_what_is_no_file) {
  const ScratchFolder folder;
  const ProgramResult missing = run_octascope({"vessels", "info", folder / "nowhere.swc"});
  EXPECT_EQ(missing.exit_status, 1);
  EXPECT_THAT(missing.err, HasSubstr("nowhere.swc: cannot be opened: No such file or directory, "
                                     "expected a vessel tree"));
  const ProgramResult directory = run_octascope({"vessels", "info", folder.path()});
  EXPECT_EQ(directory.exit_status, 2);
  EXPECT_THAT(directory.err, HasSubstr("is a directory, expected a vessel tree"));
}

} // namespace
} // namespace octascope::tests

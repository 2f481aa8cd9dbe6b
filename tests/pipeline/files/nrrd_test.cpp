#include <cstdlib>
#include <numeric>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/files/nrrd.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;

NrrdVolume float_volume() {
  NrrdVolume volume{{4, 3, 2, 3.5, 10, 37.5}, {}};
  std::vector<float> levels(24);
  std::iota(levels.begin(), levels.end(), -7.25F);
  volume.levels = levels;
  return volume;
}

class Nrrd : public testing::Test {
protected:
  // What the reader says about our own file with `from` replaced by `to`.
  std::string refusal(const std::string& from, const std::string& to) {
    EXPECT_TRUE(write_nrrd(folder / "v.nrrd", float_volume()));
    std::string text = tests::whole_file(folder / "v.nrrd");
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const auto volume = read_nrrd(folder.write("changed.nrrd", text));
    EXPECT_FALSE(volume) << to;
    return volume ? "" : volume.error().message;
  }
  tests::ScratchFolder folder;
};

TEST_F(Nrrd, comes_back_as_it_went) {
  const auto volume = float_volume();
  ASSERT_TRUE(write_nrrd(folder / "v.nrrd", volume));
  const auto read = tests::must(read_nrrd(folder / "v.nrrd"));
  EXPECT_EQ(read.geometry.depths, 4);
  EXPECT_EQ(read.geometry.a_scans, 3);
  EXPECT_EQ(read.geometry.b_scans, 2);
  EXPECT_NEAR(read.geometry.depth_spacing_um, 3.5, 1e-9);
  EXPECT_NEAR(read.geometry.b_spacing_um, 37.5, 1e-9);
  EXPECT_EQ(read.levels, volume.levels);
  EXPECT_THAT(read.remarks, testing::IsEmpty());

  NrrdVolume counts{volume.geometry, std::vector<std::uint8_t>(24, 200)};
  ASSERT_TRUE(write_nrrd(folder / "v.nrrd", counts));
  const auto again = tests::must(read_nrrd(folder / "v.nrrd"));
  EXPECT_EQ(again.levels, counts.levels);
}

TEST_F(Nrrd, notes_are_in_the_header_whatever_they_hold) {
  const NrrdVolume volume{{2, 2, 1, 3.5, 10, 37.5}, std::vector<std::uint8_t>{1, 2, 3, 4}};
  const NrrdNotes notes{{"SIMULATED", "yes"}, {"source", "two\nlines, a \\ and µ\r"}};
  auto writer = tests::must(NrrdWriter::create(folder / "v.nrrd", volume.geometry, NrrdType::uint8,
                                               notes, Readers::owner));
  ASSERT_TRUE(writer.write_b_scan(0, std::get<0>(volume.levels)));
  ASSERT_TRUE(writer.commit());
  EXPECT_THAT(tests::whole_file(folder / "v.nrrd"),
              HasSubstr("\nSIMULATED:=yes\nsource:=two\\nlines, a \\\\ and µ \n\n"));
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(folder / "v.nrrd").permissions(),
            perms::owner_read | perms::owner_write);
  const auto read = tests::must(read_nrrd(folder / "v.nrrd"));
  EXPECT_EQ(read.levels, volume.levels);
  if (std::system("command -v teem-unu > /dev/null") == 0) {
    const std::string out = (folder / "head").string();
    EXPECT_EQ(std::system(
                  fmt::format("teem-unu head {} > {}", (folder / "v.nrrd").string(), out).c_str()),
              0);
    EXPECT_THAT(tests::whole_file(out), HasSubstr("source:=two\\nlines, a \\\\ and µ"));
  }
}

TEST_F(Nrrd, notes_that_no_reader_would_take_are_refused) {
  const VolumeGeometry geometry{2, 2, 1, 3.5, 10, 37.5};
  const auto create = [&](std::size_t bytes) {
    return NrrdWriter::create(folder / "v.nrrd", geometry, NrrdType::uint8,
                              {{"k", std::string(bytes, 'x')}});
  };
  EXPECT_TRUE(create(4093));
  EXPECT_THAT(create(4094), tests::FailsWith(hal::ErrorCode::invalid_argument));
  EXPECT_EQ(folder.count(), 0);
}

TEST_F(Nrrd, teem_reads_it) {
  if (std::system("command -v teem-unu > /dev/null") != 0)
    GTEST_SKIP() << "no teem-unu (Debian package teem-apps)";
  ASSERT_TRUE(write_nrrd(folder / "v.nrrd", float_volume()));
  const std::string out = (folder / "minmax").string();
  ASSERT_EQ(std::system(
                fmt::format("teem-unu minmax {} > {}", (folder / "v.nrrd").string(), out).c_str()),
            0);
  EXPECT_THAT(tests::whole_file(out), HasSubstr("min: -7.25"));
  EXPECT_THAT(tests::whole_file(out), HasSubstr("max: 15.75"));
}

TEST_F(Nrrd, header_is_the_contract) {
  ASSERT_TRUE(write_nrrd(folder / "v.nrrd", float_volume()));
  const std::string text = tests::whole_file(folder / "v.nrrd");
  EXPECT_TRUE(text.starts_with("NRRD0005\n"));
  for (const char* field : {"type: float\n", "dimension: 3\n", "sizes: 4 3 2\n",
                            "space: 3D-right-handed\n", "space units: \"mm\" \"mm\" \"mm\"\n",
                            "space directions: (0,0,0.0035) (0.01,0,0) (0,0.0375,0)\n",
                            "space origin: (0.005,0.01875,0.00175)\n",
                            "kinds: domain domain domain\n", "endian: little\n", "encoding: raw\n"})
    EXPECT_THAT(text, HasSubstr(field));
  EXPECT_EQ(text.size(), text.find("\n\n") + 2 + 24 * sizeof(float));
}

TEST_F(Nrrd, decibels_are_said_of_levels_alone) {
  const auto header = [&](const NrrdNotes& notes) {
    auto writer = tests::must(
        NrrdWriter::create(folder / "v.nrrd", float_volume().geometry, NrrdType::float32, notes));
    for (const int b : {0, 1})
      EXPECT_TRUE(writer.write_b_scan(b, std::vector<float>(12)));
    EXPECT_TRUE(writer.commit());
    return tests::whole_file(folder / "v.nrrd");
  };
  EXPECT_THAT(header({}), HasSubstr("\n# OCT volume, 20 log10(|Y|/N) of camera counts\n"));
  EXPECT_EQ(tests::must(read_nrrd(folder / "v.nrrd")).content, "");
  EXPECT_THAT(header({{"content", "flow"}}), testing::Not(HasSubstr("log10")));
  EXPECT_EQ(tests::must(read_nrrd(folder / "v.nrrd")).content, "flow");
}

TEST_F(Nrrd, appears_complete_or_not_at_all) {
  {
    auto writer = tests::must(
        NrrdWriter::create(folder / "v.nrrd", float_volume().geometry, NrrdType::uint8));
    EXPECT_TRUE(writer.write_b_scan(0, std::vector<std::uint8_t>(12)));
    EXPECT_FALSE(std::filesystem::exists(folder / "v.nrrd"));
    EXPECT_FALSE(writer.write_b_scan(0, std::vector<float>(12)));
    EXPECT_FALSE(writer.write_b_scan(0, std::vector<std::uint8_t>(11)));
    EXPECT_FALSE(writer.write_b_scan(2, std::vector<std::uint8_t>(12)));
  }
  EXPECT_EQ(folder.count(), 0);
  ASSERT_TRUE(write_nrrd(folder / "v.nrrd", float_volume()));
  ASSERT_TRUE(write_nrrd(folder / "v.nrrd", float_volume())); // replaces
  EXPECT_EQ(folder.count(), 1);
}

TEST_F(Nrrd, is_not_written_where_it_cannot_be) {
  EXPECT_FALSE(write_nrrd(folder / "no/such/v.nrrd", float_volume()));
  EXPECT_FALSE(write_nrrd(folder.path(), float_volume()));
  EXPECT_FALSE(write_nrrd("/dev/null", float_volume()));
  NrrdVolume short_volume = float_volume();
  short_volume.levels = std::vector<float>(23);
  EXPECT_FALSE(write_nrrd(folder / "v.nrrd", short_volume));
}

TEST_F(Nrrd, refuses_what_it_does_not_know) {
  EXPECT_THAT(refusal("endian: little", "endian: middle"),
              HasSubstr("found endian: middle, expected little or big"));
  EXPECT_THAT(refusal("endian: little\n", ""), HasSubstr("no field \"endian\""));
  EXPECT_THAT(refusal("encoding: raw", "encoding: gzip"), HasSubstr("encoding: gzip"));
  EXPECT_THAT(refusal("encoding: raw", "encoding: hex"), HasSubstr("encoding: hex"));
  EXPECT_THAT(refusal("type: float", "type: block"), HasSubstr("type: block"));
  EXPECT_THAT(refusal("type: float", "type: short"), HasSubstr("more B-scans"));
  EXPECT_THAT(refusal("dimension: 3", "dimension: 4"), HasSubstr("dimension: 4"));
  EXPECT_THAT(refusal("sizes: 4 3 2", "sizes: 4 3 3"),
              HasSubstr("found 96 bytes of data, expected 144 = 4 × 3 × 3 × 4"));
  EXPECT_THAT(refusal("sizes: 4 3 2", "sizes: 4 -3 2"), HasSubstr("the size -3"));
  EXPECT_THAT(refusal("sizes: 4 3 2", "sizes: 4 3"), HasSubstr("expected three numbers"));
  EXPECT_THAT(refusal("sizes: 4 3 2", "sizes: 4 3 2 1"), HasSubstr("expected three numbers"));
  EXPECT_THAT(refusal("labels:", "spacings: nan 1 1\nlabels:"), HasSubstr("the spacing nan"));
  EXPECT_THAT(refusal("labels:", "data file: x\nlabels:"), HasSubstr("the data file of"));
  EXPECT_THAT(refusal("NRRD0005", "PNG-0005"), HasSubstr("no NRRD magic"));
  EXPECT_THAT(refusal("labels: ", "encoding: raw\nlabels: "), HasSubstr("\"encoding\" twice"));
  EXPECT_FALSE(read_nrrd(folder / "missing.nrrd"));
  EXPECT_FALSE(read_nrrd(folder.path()));
  EXPECT_FALSE(read_nrrd(folder.write("short", "NRRD0005\ntype: float\n")));
  EXPECT_FALSE(read_nrrd(folder.write("empty", "")));
}

} // namespace
} // namespace octascope::pipeline

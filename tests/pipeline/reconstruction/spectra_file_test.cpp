#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/reconstruction/spectra_file.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;

TEST(SpectraShape, is_three_whole_numbers) {
  const auto shape = tests::must(SpectraShape::parse("3,20,1024"));
  EXPECT_EQ(shape, (SpectraShape{3, 20, 1024}));
  for (const char* text :
       {"", "3", "3,20", "3,20,1024,1", "3,20,", ",20,1024", "3, 20,1024", "a,b,c", "3.0,20,1024",
        "3,20,99999999999999999999", "3,20,1024 ", "0x3,1,16"})
    EXPECT_FALSE(SpectraShape::parse(text)) << text;
}

TEST(SpectraShape, counts_are_within_reason) {
  EXPECT_EQ(SpectraShape::parse("0,1,16").error().message,
            "shape: B (B-scans) is 0, expected 1 to 1048576");
  EXPECT_THAT(SpectraShape::parse("1,-1,16").error().message, HasSubstr("is -1, expected 1 to"));
  EXPECT_THAT(SpectraShape::parse("1,1,15").error().message, HasSubstr("is 15, expected 16 to"));
  EXPECT_FALSE(SpectraShape::parse("2147483647,2147483647,2147483647"));
}

class SpectraFiles : public testing::Test {
protected:
  std::string refusal(const std::filesystem::path& file, const SpectraShape& shape) {
    return tests::error_of(SpectraFile::open(file, shape, hal::SampleType::u16)).message;
  }
  tests::ScratchFolder folder;
};

TEST_F(SpectraFiles, hands_out_b_scans) {
  std::vector<std::uint16_t> counts(3 * 2 * 16);
  std::iota(counts.begin(), counts.end(), std::uint16_t{0});
  const auto file = folder.write_values<std::uint16_t>("s.raw", counts);
  const auto spectra = tests::must(SpectraFile::open(file, {3, 2, 16}, hal::SampleType::u16));
  const auto b_scan = spectra.b_scan(2);
  ASSERT_EQ(b_scan.size(), 64U);
  EXPECT_EQ(reinterpret_cast<const std::uint16_t*>(b_scan.data())[31], 95);
  EXPECT_FALSE(spectra.find_non_finite(0));
}

TEST_F(SpectraFiles, refuses_sizes_that_do_not_fit) {
  const auto file = folder.write("s.raw", std::string(190, 'x'));
  EXPECT_EQ(refusal(file, {3, 2, 16}),
            file.string() + ": found 190 bytes, expected 192 bytes = 3 B-scans × 2 A-scans × 16 "
                            "samples × 2");
  EXPECT_THAT(refusal(folder.write("empty", ""), {3, 2, 16}), HasSubstr("found 0 bytes"));
  EXPECT_THAT(refusal(folder.write("long", std::string(193, 'x')), {3, 2, 16}),
              HasSubstr("found 193 bytes"));
}

TEST_F(SpectraFiles, refuses_what_is_no_file) {
  EXPECT_THAT(refusal(folder / "missing", {3, 2, 16}), HasSubstr("missing: cannot be opened"));
  EXPECT_EQ(SpectraFile::open(folder / "missing", {3, 2, 16}, hal::SampleType::u16).error().code,
            hal::ErrorCode::absent);
  EXPECT_THAT(refusal(folder.path(), {3, 2, 16}), HasSubstr("is a directory"));
  EXPECT_THAT(refusal("/dev/zero", {3, 2, 16}), HasSubstr("is not a regular file"));
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal(folder / "pipe", {3, 2, 16}), HasSubstr("is not a regular file"));
}

TEST_F(SpectraFiles, refuses_shapes_that_make_no_sense) {
  EXPECT_THAT(refusal(folder / "missing", {0, 2, 16}), HasSubstr("B (B-scans) is 0"));
  EXPECT_THAT(refusal(folder / "missing", {1, -2, 16}), HasSubstr("is -2"));
}

TEST_F(SpectraFiles, finds_floats_that_are_none) {
  std::vector<float> values(2 * 2 * 16, 1.0F);
  values[2 * 16 + 16 + 5] = std::nanf("");
  const auto file = folder.write_values<float>("f.raw", values);
  const auto spectra = tests::must(SpectraFile::open(file, {2, 2, 16}, hal::SampleType::f32));
  EXPECT_FALSE(spectra.find_non_finite(0));
  EXPECT_EQ(spectra.find_non_finite(1),
            file.string() + ": B-scan 1, A-scan 1, sample 5 is nan, expected a finite number");
}

} // namespace
} // namespace octascope::pipeline

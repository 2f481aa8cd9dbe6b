// octascope reconstruct --flow as a user runs it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/files/nrrd.h"
#include "tests/program/program_support.h"
#include "tests/support/spectra/scattering_spectra.h"

namespace octascope::tests {
namespace {

// Each B-scan of these spectra is of another place: two of them are no repeats.
TEST(ReconstructFlow, of_b_scans_that_moved_is_left_out_and_counted) {
  const pipeline::SpectraShape shape{8, 48, 512};
  const ScratchFolder folder;
  const auto spectra = folder.write_values<std::uint16_t>(
      "s.raw", scattering_spectra(shape, [](int, int) { return 40; }));
  const std::string flow = folder / "flow.nrrd";
  const ProgramResult result = run_well({"reconstruct", "--spectra", spectra.string(), "--shape",
                                         "8,48,512", "--repeats", "2", "--out", folder / "v.nrrd",
                                         "--flow", flow, "--decorrelation", folder / "d.nrrd"});
  EXPECT_THAT(result.err,
              testing::HasSubstr("the flow of 4 of 4 B-scans is not told: their repeats have"));
  const auto read = pipeline::read_nrrd(flow);
  ASSERT_TRUE(read) << read.error().message;
  const auto& values = std::get<std::vector<float>>(read->levels);
  EXPECT_EQ(values.size(), std::size_t{4 * 48 * 256});
  EXPECT_TRUE(std::ranges::all_of(values, [](float value) { return std::isnan(value); }));

  const ScratchFolder trees;
  EXPECT_THAT(
      run_refused(trees, {"vessels", "trace", folder / "d.nrrd", "--out", trees / "tree.swc"}),
      testing::HasSubstr(
          "found decorrelation, expected a flow volume: octascope reconstruct --flow"));
}

} // namespace
} // namespace octascope::tests

// Tissue that crosses zero delay, in the built program: docs/HAZARDS.md, row 7.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "tests/support/spectra/scattering_spectra.h"

namespace octascope::tests {
namespace {

class UpperBorder : public testing::Test {
protected:
  // The report of a run over tissue whose surface is so many bins below zero delay.
  nlohmann::json run(double surface_bins) {
    const pipeline::SpectraShape shape{small_b_scans, small_a_scans, 256};
    const auto counts = scattering_spectra(shape, [&](int, int) { return surface_bins; });
    const std::string report = folder.path() / "report.json";
    run_well(small_run(folder,
                       {"--spectra", folder.write_values<std::uint16_t>("s.raw", counts), "--shape",
                        fmt::format("{},{},{}", shape.b_scans, shape.a_scans, shape.samples),
                        "--duration", "1.6", "--snapshot", snapshot, "--report", report}));
    return read_report(report);
  }
  // Of the notice line: where it stands depends on the panels that spectra from a file leave.
  int notice() const {
    const pipeline::Image picture = read_snapshot(snapshot);
    return count_colour(picture, {0, small_height / 2, small_width, small_height / 2},
                        ui::palette::warning);
  }

  ScratchFolder folder;
  const std::string snapshot = folder.path() / "picture.png";
};

TEST_F(UpperBorder, that_tissue_crosses_is_told_while_it_does_and_counted) {
  const nlohmann::json report = run(-20);
  const nlohmann::json fault = find_fault(report, "picture", "upper_border");
  ASSERT_FALSE(fault.is_null()) << report.dump(2);
  EXPECT_GE(fault.at("count"), 3) << "once a volume";
  EXPECT_THAT(fault.at("message").get<std::string>(), testing::HasSubstr("upside down"));
  EXPECT_GT(notice(), 10);
}

TEST_F(UpperBorder, with_a_gap_above_the_tissue_is_not_mentioned) {
  const nlohmann::json report = run(16);
  EXPECT_TRUE(find_fault(report, "picture", "upper_border").is_null());
  EXPECT_EQ(notice(), 0);
  EXPECT_GE(report.at("volumes").at("published"), 3);
}

} // namespace
} // namespace octascope::tests

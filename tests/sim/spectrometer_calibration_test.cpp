#include <fstream>

#include <gtest/gtest.h>

#include "pipeline/files/config_document.h"
#include "sim/spectrometer/spectrometer_calibration.h"
#include "tests/support/fails_with.h"

namespace octascope::sim {
namespace {

std::vector<double> numbers_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<double> numbers;
  for (double value = 0; in >> value;)
    numbers.push_back(value);
  return numbers;
}

TEST(SpectrometerCalibration, the_file_holds_the_curves_that_went_in) {
  const std::filesystem::path folder =
      std::filesystem::path{testing::TempDir()} / "octascope_spectrometer_calibration";
  std::filesystem::create_directories(folder);
  SpectrometerConfig config;
  config.samples = 512;
  const Spectrometer s = *Spectrometer::make(config);
  pipeline::ScanPlan plan;
  plan.depth_spacing_um = 4.25;
  ASSERT_TRUE(write_calibration(s, plan, folder / "twin.toml"));

  const auto document = pipeline::ConfigDocument::load(folder / "twin.toml");
  ASSERT_TRUE(document) << document.error().message;
  pipeline::ConfigTable root = document->root();
  EXPECT_EQ(root.table("spectrometer").integer("samples", 0, {0, 4096}), 512);
  EXPECT_DOUBLE_EQ(root.table("depth").number("spacing_um", 0, {0, 100}), 4.25);
  EXPECT_EQ(root.table("dispersion").integer("sign", 0, {-1, 1}), 1);
  const auto k = numbers_in(*root.table("k_linear").path("table"));
  const auto theta = numbers_in(*root.table("dispersion").path("table"));
  ASSERT_EQ(k.size(), 512U);
  ASSERT_EQ(theta.size(), 512U);
  for (std::size_t m = 0; m < 512; ++m) {
    EXPECT_NEAR(k[m], s.true_k_positions()[m], 1e-8);
    EXPECT_NEAR(theta[m], s.true_dispersion_rad()[m], 1e-8);
  }
  std::filesystem::remove_all(folder);
}

TEST(SpectrometerCalibration, a_folder_that_is_not_there_is_named) {
  EXPECT_THAT(write_calibration(*Spectrometer::make({}), {}, "/nonexistent/twin.toml"),
              tests::FailsSaying("/nonexistent"));
}

} // namespace
} // namespace octascope::sim

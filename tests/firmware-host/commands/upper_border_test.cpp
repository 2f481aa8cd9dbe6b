// Tissue at the upper border in whole volumes: phantoms, real tissue, and both moved across zero
// delay. docs/RECONSTRUCTION.md has the shares that are printed here.
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "firmware-host/run/volume_source.h"
#include "pipeline/calibration/calibration.h"
#include "sim/phantoms/phantom.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/test_data.h"
#include "tests/support/files/tissue_calibration.h"
#include "tests/support/must.h"
#include "tests/support/spectra/scattering_spectra.h"

namespace octascope::firmware_host {
namespace {

VolumeRequest of_phantom(std::string_view name) {
  VolumeRequest request;
  request.phantom = name;
  return request;
}

VolumeRequest of_spectra(const std::filesystem::path& file, const pipeline::SpectraShape& shape,
                         std::optional<std::filesystem::path> calibration = {}) {
  VolumeRequest request;
  request.recording = RecordingOptions{file, shape};
  request.calibration = std::move(calibration);
  return request;
}

// Share of the A-scans that are lit.
double share_of(const VolumeRequest& request, const std::string& what) {
  const auto loaded = load_volume(request);
  EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().message);
  if (!loaded)
    return -1;
  const pipeline::BorderCount& count = loaded->volume.metadata.upper_border;
  EXPECT_GT(count.looked_at, 0) << what;
  EXPECT_EQ(pipeline::is_at_upper_border(count),
            count.lit >= pipeline::share_at_border * count.looked_at);
  std::printf("%s: %d of %d A-scans lit\n", what.c_str(), count.lit, count.looked_at);
  return static_cast<double>(count.lit) / count.looked_at;
}

TEST(UpperBorderOf, every_phantom_is_free) {
  for (const std::string_view phantom : sim::phantom_names)
    EXPECT_LT(share_of(of_phantom(phantom), std::string{phantom}), 0.005);
}

TEST(UpperBorderOf, simulated_tissue_is_told_where_it_crosses_zero_delay) {
  const pipeline::SpectraShape shape{16, 32, 256};
  const tests::ScratchFolder folder;
  const auto share = [&](double surface_bins, const std::string& what) {
    const auto counts =
        tests::scattering_spectra(shape, [&](int, int a) { return surface_bins + 0.1 * a; });
    const auto file = folder.write_values<std::uint16_t>("s.raw", counts);
    return share_of(of_spectra(file, shape), what);
  };
  EXPECT_EQ(share(16, "simulated, surface 16 to 19 bins below zero delay"), 0);
  EXPECT_GT(share(-25, "simulated, surface 25 to 22 bins above zero delay"), 0.8);
  EXPECT_GT(share(-2, "simulated, surface at zero delay"), 0.8);
}

class RealTissue : public testing::Test {
protected:
  static constexpr pipeline::SpectraShape shape{100, 100, 1024};
  const tests::TissueCalibration calibration_file;
  const std::filesystem::path calibration = calibration_file.file();
  const std::filesystem::path spectra =
      tests::test_data_folder() / "sd-oct-tissue/spectra_u16_100x100x1024.raw";
};

TEST_F(RealTissue, leaves_the_upper_border_free) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/spectra_u16_100x100x1024.raw");
  EXPECT_LT(share_of(of_spectra(spectra, shape, calibration), "real tissue"), 0.035);
}

// Multiplied by a cosine over k, tissue appears both higher and lower by so many bins: the higher
// half of it crosses zero delay and is folded as it would be in front of the microscope.
TEST_F(RealTissue, is_told_where_it_is_moved_across_zero_delay) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/spectra_u16_100x100x1024.raw");
  const auto loaded = tests::must(pipeline::Calibration::load(calibration, shape.samples));
  const auto file = tests::must(pipeline::SpectraFile::open(spectra, shape, hal::SampleType::u16));
  constexpr double moved_bins = 60;
  const auto samples = static_cast<std::size_t>(shape.samples);
  std::vector<double> factor(samples);
  std::size_t m = 0; // the first sample uniform in k that lies behind pixel p
  for (std::size_t p = 0; p < samples; ++p) {
    while (m + 1 < samples && loaded.positions[m] < static_cast<double>(p))
      ++m;
    factor[p] = std::cos(2 * std::numbers::pi * moved_bins * static_cast<double>(m) /
                         static_cast<double>(samples));
  }
  constexpr int b_scans = 8;
  std::vector<std::uint16_t> moved;
  for (int b = 0; b < b_scans; ++b) {
    const std::span<const std::byte> bytes = file.b_scan(b * 12);
    const auto* counts = reinterpret_cast<const std::uint16_t*>(bytes.data());
    std::vector<double> mean(samples);
    for (std::size_t i = 0; i < samples * 100; ++i)
      mean[i % samples] += counts[i] / 100.0;
    for (std::size_t i = 0; i < samples * 100; ++i)
      moved.push_back(static_cast<std::uint16_t>(
          std::lround(30000 + 2 * (counts[i] - mean[i % samples]) * factor[i % samples])));
  }
  const tests::ScratchFolder folder;
  const auto written = folder.write_values<std::uint16_t>("moved.raw", moved);
  EXPECT_GT(share_of(of_spectra(written, {b_scans, 100, 1024}, calibration),
                     "real tissue, moved 60 bins"),
            0.3);
}

} // namespace
} // namespace octascope::firmware_host

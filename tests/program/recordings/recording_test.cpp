// Real spectra through the whole program: played live, and reconstructed into a file.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "tests/support/files/test_data.h"
#include "tests/support/files/tissue_calibration.h"

namespace octascope::tests {
namespace {

using testing::HasSubstr;

constexpr const char* spectra_file = "sd-oct-tissue/spectra_u16_100x100x1024.raw";

std::string spectra() {
  return test_data_folder() / spectra_file;
}

std::string calibration(const ScratchFolder& folder) {
  const std::string curves = (test_data_folder() / "sd-oct-tissue").string();
  return folder.write("calibration.toml", "[spectrometer]\nsamples = 1024\n[k_linear]\ntable = \"" +
                                              curves +
                                              "/k_linear.txt\"\ninterpolation = "
                                              "\"sinc8\"\n[dispersion]\ntable = \"" +
                                              curves +
                                              "/dispersion_rad.txt\"\nsign = 1\n[depth]\n"
                                              "spacing_um = 3.5\na_spacing_um = 10.0\n"
                                              "b_spacing_um = 10.0\n");
}

// Share of the rectangle's pixels that are grey and brighter than `level`.
double bright_share(const pipeline::Image& picture, const ui::Rect& where, int level) {
  int bright = 0;
  for (int y = where.y; y < where.bottom(); ++y) {
    for (int x = where.x; x < where.right(); ++x) {
      const auto* p = &picture.pixels[3 * static_cast<std::size_t>(y * picture.width + x)];
      const bool grey = std::abs(p[0] - p[1]) < 12 && std::abs(p[1] - p[2]) < 12;
      bright += grey && p[0] > level;
    }
  }
  return static_cast<double>(bright) / (where.width * where.height);
}

TEST(Recording, real_spectra_show_their_surface) {
  constexpr int volumes = sanitized ? 1 : 5;
  OCTASCOPE_REQUIRE_TEST_DATA(spectra_file);
  const ScratchFolder folder;
  const std::string snapshot = folder / "t.png";
  const std::string report_file = folder / "t.json";
  std::vector<std::string> arguments{"run", "--spectra", spectra(), "--shape", "100,100,1024"};
  arguments.insert(arguments.end(), {"--calibration", calibration(folder), "--display", "offscreen",
                                     "--size", "640x360", "--volumes", std::to_string(volumes),
                                     "--snapshot", snapshot, "--report", report_file});
  if (sanitized) // the full line rate is out of reach
    arguments.insert(arguments.end(),
                     {"--config", folder.write("slow.toml", "[scan]\nline_rate_hz = 2500\n")});
  run_well(arguments);
  const auto report = read_report(report_file);
  EXPECT_GE(report["volumes"]["displayed"], 1);
  EXPECT_EQ(report["volumes"]["published"], volumes);

  const pipeline::Image picture = read_snapshot(snapshot);
  ASSERT_EQ(picture.width, 640);
  ASSERT_EQ(picture.height, 360);
  // The middle of the view: tissue on black, neither empty nor full.
  ui::PictureAspects aspects; // those of the pictures only shift them within their frames
  aspects.has_scope = false;
  const ui::Layout layout = ui::lay_out(picture.width, picture.height, aspects);
  const ui::Rect middle{layout.view.x + layout.view.width / 4,
                        layout.view.y + layout.view.height / 4, layout.view.width / 2,
                        layout.view.height / 2};
  const double tissue = bright_share(picture, middle, 60);
  EXPECT_GT(tissue, 0.1);
  EXPECT_LT(tissue, 0.95);
  // B-scan and en face share the room of the microscope's picture, which there is not.
  EXPECT_GT(bright_share(picture, layout.b_scan.frame, 60), 0.05);
  EXPECT_GT(bright_share(picture, layout.en_face.frame, 60), 0.05);
}

TEST(Recording, the_calibration_of_the_measurements_fits_them) {
  OCTASCOPE_REQUIRE_TEST_DATA(spectra_file);
  const TissueCalibration calibration;
  const ScratchFolder folder;
  run_well({"reconstruct", "--spectra", test_data_folder() / spectra_file, "--shape",
            "100,100,1024", "--calibration", calibration.file(), "--out", folder / "v.nrrd"});
}

std::string unu() {
  for (const char* name : {"unu", "teem-unu"}) {
    if (program_exists(name))
      return name;
  }
  return {};
}

TEST(Recording, another_reader_opens_the_reconstructed_volume) {
  OCTASCOPE_REQUIRE_TEST_DATA(spectra_file);
  const std::string reader = unu();
  if (reader.empty())
    GTEST_SKIP() << "no unu or teem-unu here (Debian package teem-apps)";
  const ScratchFolder folder;
  const std::string volume = folder / "v.nrrd";
  const std::string png = folder / "b.png";
  run_well({"reconstruct", "--spectra", spectra(), "--shape", "100,100,1024", "--calibration",
            calibration(folder), "--out", volume, "--bscan", "50", "--png", png});
  const pipeline::Image b_scan = read_snapshot(png);
  EXPECT_EQ(b_scan.width, 100);
  EXPECT_EQ(b_scan.height, 512);

  const ProgramResult head = run_program({reader, "head", volume});
  ASSERT_EQ(head.exit_status, 0) << head.describe();
  EXPECT_THAT(head.out, HasSubstr("type: float"));
  EXPECT_THAT(head.out, HasSubstr("dimension: 3"));
  EXPECT_THAT(head.out, HasSubstr("sizes: 512 100 100"));
  EXPECT_THAT(head.out, HasSubstr("encoding: raw"));
  EXPECT_THAT(head.out, HasSubstr("endian: little"));
  // Its own arithmetic over our levels: finite, and tissue stands out.
  const ProgramResult levels = run_program({reader, "minmax", volume});
  ASSERT_EQ(levels.exit_status, 0) << levels.describe();
  float lowest = 0;
  float highest = 0;
  ASSERT_EQ(std::sscanf(levels.out.c_str(), "min: %f max: %f", &lowest, &highest), 2) << levels.out;
  EXPECT_TRUE(std::isfinite(lowest) && std::isfinite(highest));
  EXPECT_GT(highest - lowest, 20) << "dB";
  EXPECT_EQ(levels.out.find("non-finite"), std::string::npos) << levels.out;
}

} // namespace
} // namespace octascope::tests

#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/calibration/calibration.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/test_data.h"
#include "tests/support/files/tissue_calibration.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;

constexpr int samples = 64;

std::string curve(int count, double first = 0, double step = 1) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += fmt::format("{}\n", first + step * i);
  return text;
}

const std::string spectrometer = "[spectrometer]\nsamples = 64\n";
const std::string with_table = spectrometer + "[k_linear]\ntable = \"k.txt\"\n";
const std::string straight = spectrometer + "[k_linear]\npolynomial = [0.0, 63.0]\n";

class CalibrationFile : public testing::Test {
protected:
  hal::Result<Calibration> load(const std::string& toml) {
    return Calibration::load(folder.write("c.toml", toml), samples);
  }
  std::string refusal(const std::string& toml) {
    const auto calibration = load(toml);
    EXPECT_FALSE(calibration) << toml;
    return calibration ? "" : calibration.error().message;
  }
  // What is said about a k-linear table with this text.
  std::string table_refusal(const std::string& text) {
    folder.write("k.txt", text);
    return refusal(with_table);
  }

  tests::ScratchFolder folder;
};

TEST_F(CalibrationFile, loads_every_section) {
  folder.write("k.txt",
               "\xEF\xBB\xBF# positions\r\n-0.05\r\n" + curve(62, 1) + "\n63.2 # the last\n");
  std::vector<float> dark(samples, 12.5F);
  folder.write_values<float>("dark.raw", dark);
  const auto c = tests::must(
      load(with_table + "interpolation = \"cubic\"\n"
                        "[dispersion]\npolynomial = [1.0, 0.0, 2.0]\nsign = -1\n"
                        "[background]\nmode = \"file\"\nfile = \"dark.raw\"\n"
                        "[window]\nkind = \"flat\"\n"
                        "[depth]\nspacing_um = 4.5\na_spacing_um = 6\nb_spacing_um = 7\n"));
  EXPECT_EQ(c.positions.front(), 0); // clamped
  EXPECT_EQ(c.positions[1], 1);
  EXPECT_EQ(c.positions.back(), 63);
  EXPECT_EQ(c.interpolation, Interpolation::cubic);
  EXPECT_DOUBLE_EQ(c.dispersion_rad.front(), -1);
  EXPECT_DOUBLE_EQ(c.dispersion_rad.back(), -3);
  EXPECT_EQ(c.background_mode, BackgroundMode::file);
  EXPECT_EQ(c.background, dark);
  EXPECT_EQ(c.window, std::vector<double>(samples, 1.0));
  EXPECT_EQ(c.depth_spacing_um, 4.5);
  EXPECT_EQ(c.a_spacing_um, 6);
  EXPECT_EQ(c.b_spacing_um, 7);
}

TEST_F(CalibrationFile, may_name_its_camera) {
  const std::string named = "[spectrometer]\nsamples = 64\ncamera = \"Octoplus, serial 7\"\n"
                            "[k_linear]\npolynomial = [0.0, 63.0]\n";
  const auto c = tests::must(load(named));
  EXPECT_EQ(c.camera, "Octoplus, serial 7");
  EXPECT_EQ(calibration_camera(folder / "c.toml").value(), "Octoplus, serial 7");
  EXPECT_EQ(load(straight)->camera, "");
  EXPECT_EQ(calibration_camera(folder / "c.toml").value(), "");
  EXPECT_THAT(refusal("[spectrometer]\nsamples = 64\ncamera = 7\n"), HasSubstr("camera"));
}

TEST_F(CalibrationFile, may_say_the_medium_of_its_depths) {
  const auto c =
      tests::must(load(straight + "[depth]\nspacing_um = 2.5\nrefractive_index = 1.38\n"));
  EXPECT_EQ(c.refractive_index, 1.38);
  EXPECT_FALSE(load(straight + "[depth]\nspacing_um = 2.5\n")->refractive_index) << "nobody said";
  for (const char* wrong : {"0.99", "2.01", "nan", "\"air\""})
    EXPECT_THAT(refusal(straight + "[depth]\nspacing_um = 2.5\nrefractive_index = " + wrong + "\n"),
                HasSubstr("refractive_index"));
  EXPECT_THAT(refusal(straight + "[depth]\nrefractive_index = 1.38\n"),
              HasSubstr("no spacing_um that it belongs to"));
}

TEST_F(CalibrationFile, has_defaults) {
  const auto c = tests::must(load(straight));
  EXPECT_EQ(c.interpolation, Interpolation::sinc8);
  EXPECT_EQ(c.background_mode, BackgroundMode::running);
  EXPECT_TRUE(c.dispersion_rad.empty());
  EXPECT_EQ(c.positions, Calibration::identity(samples).positions);
  EXPECT_EQ(c.window, Calibration::identity(samples).window);
}

TEST_F(CalibrationFile, wavelengths_become_positions_uniform_in_k) {
  const double a0 = 800;
  const double a1 = 1.1;
  const double a2 = 0.002;
  const auto c = tests::must(
      load(spectrometer + "[k_linear]\nwavelength_polynomial_nm = [800.0, 1.1, 0.002]\n"));
  const auto k = [&](double p) { return 2 * std::numbers::pi / (a0 + a1 * p + a2 * p * p); };
  for (int m = 0; m < samples; ++m)
    EXPECT_NEAR(k(c.positions[static_cast<std::size_t>(m)]), k(0) + (k(63) - k(0)) * m / 63.0,
                1e-12);
}

// A spectrometer's wavenumbers by pixel, in rad/um, rad/m, or as an index of 0 to N−1, become the
// positions that its wavelengths give.
TEST_F(CalibrationFile, wavenumbers_become_positions) {
  for (const bool rising_wavelength : {true, false}) {
    const double a1 = rising_wavelength ? 1.1 : -1.1;
    const double a2 = 0.004;
    const auto k = [&](int p) { return 2000 * std::numbers::pi / (800 + a1 * p + a2 * p * p); };
    const auto expected = tests::must(load(fmt::format(
        "{}[k_linear]\nwavelength_polynomial_nm = [800.0, {}, {}]\n", spectrometer, a1, a2)));
    for (const auto& [scale, offset] :
         {std::pair{1.0, 0.0}, {1e6, 0.0}, {63 / (k(63) - k(0)), -63 * k(0) / (k(63) - k(0))}}) {
      std::string table;
      for (int p = 0; p < samples; ++p)
        table += fmt::format("{:.9g}\n", scale * k(p) + offset);
      folder.write("k.txt", table);
      const auto c = tests::must(load(with_table + "table_gives = \"wavenumber\"\n"));
      EXPECT_EQ(c.k_table, KTable::wavenumber);
      for (std::size_t m = 0; m < samples; ++m)
        ASSERT_NEAR(c.positions[m], expected.positions[m], 2e-3) << m;
      EXPECT_FALSE(doubt_about_k_table(c, "c.toml"));
    }
  }
}

// r(m) bends by 12 pixels: the other way round it would bend by as much to the other side.
TEST_F(CalibrationFile, a_table_says_which_way_round_it_is_meant) {
  std::string bent;
  for (int m = 0; m < samples; ++m)
    bent += fmt::format("{}\n", m + 48.0 * m / 63 * (63 - m) / 63);
  folder.write("k.txt", bent);
  const auto unsaid = tests::must(load(with_table));
  const auto told = tests::must(doubt_about_k_table(unsaid, "c.toml"));
  EXPECT_THAT(told, HasSubstr("c.toml: [k_linear] table is taken for pixels by wavenumber"));
  EXPECT_THAT(told, HasSubstr("table_gives"));
  EXPECT_NEAR(distance_the_other_way_round(unsaid.positions), 23.19, 0.01);
  const auto pixels = tests::must(load(with_table + "table_gives = \"pixel\"\n"));
  EXPECT_EQ(pixels.positions, unsaid.positions);
  EXPECT_FALSE(doubt_about_k_table(pixels, "c.toml"));
  const auto turned = tests::must(load(with_table + "table_gives = \"wavenumber\"\n"));
  for (std::size_t m = 1; m + 1 < samples; ++m)
    ASSERT_LT(turned.positions[m], static_cast<double>(m)) << "it bends to the other side";
  folder.write("k.txt", curve(samples));
  EXPECT_FALSE(doubt_about_k_table(tests::must(load(with_table)), "c.toml")) << "straight";

  EXPECT_THAT(refusal(with_table + "table_gives = \"nm\"\n"),
              HasSubstr("table_gives is 'nm', expected one of \"pixel\", \"wavenumber\""));
  EXPECT_THAT(refusal(straight + "table_gives = \"pixel\"\n"), HasSubstr("no table"));
  const std::string wavenumbers = with_table + "table_gives = \"wavenumber\"\n";
  folder.write("k.txt", curve(32, 7, 0.001) + curve(32, 7.02, 0.001));
  EXPECT_THAT(refusal(wavenumbers), HasSubstr("k.txt: wavenumbers are not monotone: pixel 31 has"));
  folder.write("k.txt", curve(32, 7, 0.001) + curve(32, 7.1, 0.001));
  EXPECT_THAT(refusal(wavenumbers), HasSubstr("positions jump: position 31"));
}

TEST_F(CalibrationFile, falling_positions_are_monotone_too) {
  folder.write("k.txt", curve(64, 63, -1));
  EXPECT_TRUE(load(with_table));
}

TEST_F(CalibrationFile, the_supplied_curves_pass) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/k_linear.txt");
  const auto c = tests::must(Calibration::load(tests::TissueCalibration{}.file(), 1024));
  EXPECT_EQ(c.positions.front(), 0);
  EXPECT_NEAR(c.positions.back(), 1022.93, 0.01);
  EXPECT_EQ(c.dispersion_rad.size(), 1024U);
}

TEST_F(CalibrationFile, refuses_curves_that_are_not_numbers) {
  EXPECT_EQ(table_refusal(curve(3) + "nan\n" + curve(60, 4)),
            (folder / "k.txt").string() +
                ":4: found \"nan\" as number 3 of 64, expected one finite "
                "number with a decimal point");
  EXPECT_THAT(table_refusal("inf\n" + curve(63)), HasSubstr("k.txt:1: found \"inf\""));
  EXPECT_THAT(table_refusal("-inf\n" + curve(63)), HasSubstr("k.txt:1: found \"-inf\""));
  EXPECT_THAT(table_refusal("1e999\n" + curve(63)), HasSubstr("k.txt:1: found \"1e999\""));
  EXPECT_THAT(table_refusal("0,5\n" + curve(63)), HasSubstr("k.txt:1: found \"0,5\""));
  EXPECT_THAT(table_refusal("0 1\n" + curve(63)), HasSubstr("k.txt:1: found \"0 1\""));
  EXPECT_THAT(table_refusal("+-1\n" + curve(63)), HasSubstr("k.txt:1: found \"+-1\""));
  EXPECT_THAT(table_refusal(std::string(3, '\0')), HasSubstr("k.txt:1: found"));
}

TEST_F(CalibrationFile, refuses_curves_of_the_wrong_length) {
  EXPECT_EQ(table_refusal(curve(63)),
            (folder / "k.txt").string() + ": found 63 numbers, expected 64");
  EXPECT_EQ(table_refusal(curve(64) + "\n64\n"),
            (folder / "k.txt").string() +
                ":66: found one number more (\"64\"), expected exactly 64");
  EXPECT_THAT(table_refusal(""), HasSubstr("k.txt: is empty, expected a text file of 64 numbers"));
  EXPECT_THAT(table_refusal("# nothing\n\n"), HasSubstr("k.txt: found 0 numbers, expected 64"));
  EXPECT_THAT(table_refusal(std::string(200'000, '\n')), HasSubstr("200000 bytes, far too many"));
}

TEST_F(CalibrationFile, refuses_files_that_are_none) {
  EXPECT_THAT(refusal(with_table), HasSubstr("k.txt: there is no such file"));
  std::filesystem::create_directory(folder / "k.txt");
  EXPECT_THAT(refusal(with_table), HasSubstr("k.txt: is a directory"));
  EXPECT_THAT(refusal(spectrometer + "[k_linear]\ntable = \"/dev/zero\"\n"),
              HasSubstr("/dev/zero: is not a regular file"));
  EXPECT_FALSE(Calibration::load(folder / "missing.toml", samples));
  EXPECT_FALSE(Calibration::load(folder.path(), samples));
}

TEST_F(CalibrationFile, refuses_curves_that_turn_back) {
  EXPECT_THAT(
      table_refusal(curve(31) + "29.5\n" + curve(32, 32)),
      HasSubstr("k.txt: positions are not monotone: position 30 is 30, position 31 is 29.5"));
  EXPECT_THAT(table_refusal(curve(31) + "30\n" + curve(32, 32)),
              HasSubstr("position 30 is 30, position 31 is 30"));
  EXPECT_THAT(refusal(spectrometer + "[k_linear]\npolynomial = [0.0, 190.0, -127.0]\n"),
              HasSubstr("[k_linear] polynomial: positions are not monotone"));
  EXPECT_THAT(
      refusal(spectrometer + "[k_linear]\nwavelength_polynomial_nm = [800.0, 1.0, -0.02]\n"),
      HasSubstr("wavelength is not monotone"));
  EXPECT_THAT(refusal(spectrometer + "[k_linear]\nwavelength_polynomial_nm = [-800.0, 1.0]\n"),
              HasSubstr("wavelength at pixel 0 is -800 nm"));
}

TEST_F(CalibrationFile, refuses_curves_that_jump) {
  EXPECT_EQ(
      table_refusal(curve(32, 0, 0.8) + curve(32, 33.84, 0.8)),
      (folder / "k.txt").string() +
          ": positions jump: position 31 is 24.8, position 32 is 33.84, a step of 9.040 where "
          "its neighbours' are about 0.800");
  EXPECT_THAT(table_refusal("-9\n" + curve(63, 1)), HasSubstr("position 0 is -9, position 1 is 1"));
  EXPECT_THAT(table_refusal(curve(63) + "70\n"), HasSubstr("position 62 is 62, position 63 is 70"));
}

TEST_F(CalibrationFile, refuses_positions_that_are_no_pixels) {
  EXPECT_THAT(table_refusal(curve(64, 800, 1)),
              HasSubstr("only 0 of 64 positions lie on the line"));
}

TEST_F(CalibrationFile, refuses_unclear_forms) {
  EXPECT_THAT(refusal(spectrometer), HasSubstr("[k_linear] has 0 of table, polynomial"));
  EXPECT_THAT(refusal(straight + "table = \"k.txt\"\n"), HasSubstr("[k_linear] has 2 of table"));
  EXPECT_THAT(refusal(straight + "[dispersion]\nsign = 1\n"),
              HasSubstr("[dispersion] has neither"));
  EXPECT_THAT(refusal(straight + "[dispersion]\npolynomial = [1.0]\ntable = \"d.txt\"\n"),
              HasSubstr("[dispersion] has both"));
  EXPECT_THAT(refusal(straight + "[dispersion]\npolynomial = [1.0]\nsign = 0\n"),
              HasSubstr("sign is 0"));
  EXPECT_THAT(refusal(straight + "[dispersion]\npolynomial = []\n"), HasSubstr("empty form"));
  EXPECT_THAT(refusal(straight + "[background]\nmode = \"file\"\n"), HasSubstr("there is no file"));
  EXPECT_THAT(refusal(straight + "[background]\nfile = \"d.raw\"\n"), HasSubstr("not \"file\""));
}

TEST_F(CalibrationFile, refuses_unknown_keys_and_values) {
  EXPECT_THAT(refusal(straight + "interpolate = \"cubic\"\n"), HasSubstr("unknown key"));
  EXPECT_THAT(refusal(straight + "[extra]\n"), HasSubstr("unknown key \"extra\""));
  EXPECT_THAT(refusal(straight + "[provenance]\nauthor = \"x\"\n"), HasSubstr("\"author\""));
  EXPECT_THAT(refusal(straight + "[provenance]\nmethod = 3\n"), HasSubstr("a text in quotes"));
  EXPECT_THAT(refusal(straight + "interpolation = \"best\"\n"), HasSubstr("\"linear\", \"cubic\""));
  EXPECT_THAT(refusal(straight + "[window]\nkind = \"triangle\"\n"), HasSubstr("kind"));
  EXPECT_THAT(refusal(straight + "[depth]\nspacing_um = 0\n"), HasSubstr("spacing_um"));
  EXPECT_THAT(refusal(straight + "[depth]\nspacing_um = nan\n"), HasSubstr("spacing_um"));
}

TEST_F(CalibrationFile, refuses_another_spectrometer) {
  EXPECT_THAT(refusal("[spectrometer]\nsamples = 65\n[k_linear]\npolynomial = [0.0, 64.0]\n"),
              HasSubstr("samples is 65, but the spectra have 64"));
  EXPECT_THAT(refusal("[k_linear]\npolynomial = [0.0, 63.0]\n"), HasSubstr("samples is missing"));
}

TEST_F(CalibrationFile, refuses_bad_backgrounds) {
  const std::string toml = straight + "[background]\nmode = \"file\"\nfile = \"dark.raw\"\n";
  folder.write("dark.raw", "123");
  EXPECT_THAT(refusal(toml), HasSubstr("dark.raw: found 3 bytes, expected 256 bytes"));
  std::vector<float> dark(samples, 1.0F);
  dark[9] = std::nanf("");
  folder.write_values<float>("dark.raw", dark);
  EXPECT_THAT(refusal(toml), HasSubstr("dark.raw: value 9 is nan"));
}

} // namespace
} // namespace octascope::pipeline

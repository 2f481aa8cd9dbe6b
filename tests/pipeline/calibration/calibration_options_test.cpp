// The reconstruction's options in a calibration file: read, refused, written back.
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/calibration/calibration.h"
#include "pipeline/calibration/calibration_writer.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;

constexpr int samples = 64;
const std::string straight = "[spectrometer]\nsamples = 64\n[k_linear]\npolynomial = [0.0, 63.0]\n";
const std::string shaped = straight + "[window]\nkind = \"shaped\"\nsource = \"s.raw\"\n";

class CalibrationOptions : public testing::Test {
protected:
  CalibrationOptions() {
    for (int p = 0; p < samples; ++p)
      source.push_back(static_cast<float>(10 + p % 7));
    folder.write_values<float>("s.raw", source);
  }
  hal::Result<Calibration> load(const std::string& toml) {
    return Calibration::load(folder.write("c.toml", toml), samples);
  }
  std::string refusal(const std::string& toml) {
    const auto calibration = load(toml);
    EXPECT_FALSE(calibration) << toml;
    return calibration ? "" : calibration.error().message;
  }

  tests::ScratchFolder folder;
  std::vector<float> source;
};

TEST_F(CalibrationOptions, have_defaults) {
  const auto c = tests::must(load(straight));
  EXPECT_EQ(c.zero_padding, 1);
  EXPECT_EQ(c.fixed_pattern.mode, FixedPatternMode::none);
  EXPECT_EQ(c.window_kind, SpectralWindow::hann);
  EXPECT_FALSE(c.shaping);
}

TEST_F(CalibrationOptions, are_read) {
  const auto c =
      tests::must(load(straight + "[transform]\nzero_padding = 2\n"
                                  "[fixed_pattern]\nmode = \"minimum_variance\"\nsegments = 5\n"
                                  "[window]\nkind = \"tukey\"\n"));
  EXPECT_EQ(c.zero_padding, 2);
  EXPECT_EQ(c.depths(), 64);
  EXPECT_EQ(c.fixed_pattern.mode, FixedPatternMode::minimum_variance);
  EXPECT_EQ(c.fixed_pattern.segments, 5);
  EXPECT_EQ(c.window_kind, SpectralWindow::tukey);
}

TEST_F(CalibrationOptions, shape_a_recorded_source) {
  folder.write_values<float>("dark.raw", std::vector<float>(samples, 4.0F));
  const auto c = tests::must(load(shaped + "dark = \"dark.raw\"\nfwhm = 0.5\nhighest_gain = 20\n"));
  ASSERT_TRUE(c.shaping);
  EXPECT_EQ(c.shaping->source[3], source[3] - 4);
  EXPECT_EQ(c.shaping->fwhm, 0.5);
  EXPECT_EQ(c.shaping->highest_gain, 20);
  const auto factors = tests::must(make_shaping_factors(*c.shaping, c.positions, c.interpolation));
  EXPECT_EQ(c.window, factors);
}

TEST_F(CalibrationOptions, take_a_source_as_text) {
  std::string text = "# counts by pixel\n";
  for (const float count : source)
    text += fmt::format("{}\n", count);
  folder.write("s.txt", text);
  const auto c = tests::must(load(straight + "[window]\nkind = \"shaped\"\nsource = \"s.txt\"\n"));
  EXPECT_EQ(c.shaping->source, source);
}

TEST_F(CalibrationOptions, are_refused_out_of_range) {
  EXPECT_THAT(
      refusal(straight + "[transform]\nzero_padding = 3\n"),
      testing::AllOf(HasSubstr("c.toml:6: [transform] zero_padding is 3"), HasSubstr("1 to 2")));
  EXPECT_THAT(refusal(straight + "[transform]\nzero_padding = 0\n"), HasSubstr("zero_padding"));
  EXPECT_THAT(refusal(straight + "[transform]\npadding = 2\n"), HasSubstr("unknown key"));
  EXPECT_THAT(refusal(straight + "[fixed_pattern]\nmode = \"median\"\n"),
              HasSubstr("\"minimum_variance\""));
  const std::string on = straight + "[fixed_pattern]\nmode = \"minimum_variance\"\n";
  EXPECT_THAT(refusal(on + "segments = 1\n"), HasSubstr("segments is 1"));
  EXPECT_THAT(refusal(on + "segments = 65\n"), HasSubstr("2 to 64"));
  EXPECT_THAT(refusal(straight + "[fixed_pattern]\nsegments = 4\n"),
              HasSubstr("segments is given, but mode is not \"minimum_variance\""));
  EXPECT_THAT(refusal(shaped + "fwhm = 0.01\n"), HasSubstr("fwhm is 0.01"));
  EXPECT_THAT(refusal(shaped + "highest_gain = 0.5\n"), HasSubstr("highest_gain is 0.5"));
}

TEST_F(CalibrationOptions, refuse_a_source_that_is_none) {
  EXPECT_THAT(refusal(straight + "[window]\nkind = \"shaped\"\n"),
              HasSubstr("there is no source = "));
  EXPECT_THAT(refusal(straight + "[window]\nkind = \"shaped\"\nsource = \"\"\n"),
              HasSubstr("there is no source = "));
  EXPECT_THAT(refusal(straight + "[window]\nkind = \"hann\"\nsource = \"s.raw\"\n"),
              HasSubstr("source is given, but kind is not \"shaped\""));
  EXPECT_THAT(refusal(straight + "[window]\nfwhm = 0.4\n"),
              HasSubstr("fwhm is given, but kind is not \"shaped\""));
  EXPECT_THAT(refusal(shaped + "dark = \"\"\n"), HasSubstr("dark is empty"));
  EXPECT_THAT(refusal(shaped + "dark = \"no.raw\"\n"), HasSubstr("no.raw: there is no such file"));
  folder.write("s.raw", "short");
  EXPECT_THAT(refusal(shaped), HasSubstr("s.raw: found 5 bytes, expected 256 bytes"));
  folder.write_values<float>("s.raw", std::vector<float>(samples, 0.0F));
  EXPECT_THAT(refusal(shaped), HasSubstr("s.raw: source has no light"));
}

TEST_F(CalibrationOptions, come_back_from_the_writer) {
  FoundCalibration found;
  found.calibration = Calibration::identity(samples);
  Calibration& c = found.calibration;
  c.background_mode = BackgroundMode::file;
  c.background.assign(samples, 12.25F);
  c.fixed_pattern = {FixedPatternMode::minimum_variance, 11};
  c.zero_padding = 2;
  c.refractive_index = 1.376;
  c.camera = "Octoplus, serial 7";
  c.shaping = SourceShaping{source, 0.35, 25};
  c.window = *make_shaping_factors(*c.shaping, c.positions, c.interpolation);
  ASSERT_TRUE(write_calibration(found, folder / "out.toml"));
  const auto read = tests::must(Calibration::load(folder / "out.toml", samples));
  EXPECT_EQ(read.background_mode, BackgroundMode::file);
  EXPECT_EQ(read.background, c.background);
  EXPECT_EQ(read.fixed_pattern.mode, c.fixed_pattern.mode);
  EXPECT_EQ(read.fixed_pattern.segments, 11);
  EXPECT_EQ(read.zero_padding, 2);
  EXPECT_EQ(read.refractive_index, 1.376);
  EXPECT_EQ(read.camera, "Octoplus, serial 7");
  ASSERT_TRUE(read.shaping);
  EXPECT_EQ(read.shaping->source, source);
  EXPECT_EQ(read.shaping->fwhm, 0.35);
  EXPECT_EQ(read.shaping->highest_gain, 25);
  EXPECT_EQ(read.window, c.window);
}

TEST_F(CalibrationOptions, every_window_and_background_comes_back) {
  for (const auto kind : {SpectralWindow::hann, SpectralWindow::hamming, SpectralWindow::blackman,
                          SpectralWindow::gaussian, SpectralWindow::tukey, SpectralWindow::flat}) {
    for (const auto mode : {BackgroundMode::mean, BackgroundMode::running, BackgroundMode::none}) {
      FoundCalibration found;
      found.calibration = Calibration::identity(samples);
      found.calibration.background_mode = mode;
      found.calibration.window_kind = kind;
      found.calibration.window = make_spectral_window(kind, samples);
      ASSERT_TRUE(write_calibration(found, folder / "out.toml"));
      const auto read = tests::must(Calibration::load(folder / "out.toml", samples));
      EXPECT_EQ(read.window, found.calibration.window);
      EXPECT_EQ(read.window_kind, kind);
      EXPECT_EQ(read.background_mode, mode);
    }
  }
}

} // namespace
} // namespace octascope::pipeline

// The command from end to end: measurements in files → a calibration that loads, or a refusal that
// says why and leaves nothing behind.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/calibrate/calibrate.h"
#include "firmware-host/commands/volume/reconstruct.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/calibration_finder/tissue_sharpness.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/files/png_image.h"
#include "sim/spectra/volume_loop.h"
#include "sim/spectrometer/spectrometer.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/test_data.h"
#include "tests/support/files/tissue_calibration.h"
#include "tests/support/must.h"
#include "tests/support/pictures/tissue_surface.h"

namespace octascope::firmware_host {
namespace {

using testing::HasSubstr;

struct Outcome {
  int status = 0;
  std::string out;
  std::string messages;
};

Outcome run_octascope(std::vector<std::string> arguments) {
  Outcome outcome;
  CLI::App app;
  app.require_subcommand(1);
  add_calibrate_command(app, outcome.status);
  std::ranges::reverse(arguments);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    outcome.status = error.get_exit_code() == 0 ? 0 : 2;
  }
  outcome.out = testing::internal::GetCapturedStdout();
  outcome.messages = testing::internal::GetCapturedStderr();
  return outcome;
}

class CalibrateCommand : public testing::Test {
protected:
  CalibrateCommand() {
    near = write_mirror("near.raw", 60, 3);
    far = write_mirror("far.raw", 190, 3);
    const auto light = spectrometer.mean_counts({});
    dark = folder.write_values<std::uint16_t>("dark.raw", counts(light, 1)).string();
    files = folder.count();
  }
  std::vector<std::uint16_t> counts(const std::vector<double>& mean, int lines) {
    std::vector<std::uint16_t> values;
    for (int a = 0; a < lines; ++a) {
      for (const double value : mean)
        values.push_back(static_cast<std::uint16_t>(std::lround(value + 5 * normal(generator))));
    }
    return values;
  }
  std::string write_mirror(std::string_view name, double bin, int lines) {
    const sim::Reflector mirror{bin, 500, 0};
    return folder
        .write_values<std::uint16_t>(name, counts(spectrometer.mean_counts({&mirror, 1}), lines))
        .string();
  }
  Outcome calibrate(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"calibrate", "--samples", "1024", "--out", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_octascope(std::move(arguments));
  }
  // Refused with `status` and words, and nothing written.
  void expect_refusal(std::vector<std::string> more, int status, const std::string& words) const {
    const auto before = folder.count();
    const Outcome outcome = calibrate(std::move(more));
    EXPECT_EQ(outcome.status, status) << outcome.messages;
    EXPECT_THAT(outcome.messages, HasSubstr(words));
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(folder.count(), before);
  }

  tests::ScratchFolder folder;
  std::mt19937_64 generator{17};
  std::normal_distribution<double> normal;
  sim::Spectrometer spectrometer = *sim::Spectrometer::make({});
  std::string near;
  std::string far;
  std::string dark;
  std::string out = (folder / "found.toml").string();
  std::ptrdiff_t files = 0;
};

TEST_F(CalibrateCommand, writes_what_loads_and_says_how_good_it_is) {
  const std::string png = (folder / "verdict.png").string();
  const auto outcome =
      calibrate({"--mirror", far, "--mirror", near, "--dark", dark, "--distance-um", "455",
                 "--camera", "Octoplus, \"7\"", "--picture", png, "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_EQ(folder.count(), files + 4); // TOML, two curves, picture

  const auto loaded = tests::must(pipeline::Calibration::load(out, 1024));
  for (std::size_t m = 100; m < 924; ++m) {
    EXPECT_NEAR(loaded.positions[m], spectrometer.true_k_positions()[m], 0.3); // k up to its ends
    EXPECT_NEAR(loaded.dispersion_rad[m], spectrometer.true_dispersion_rad()[m], 0.3);
  }
  EXPECT_NEAR(loaded.depth_spacing_um, 3.5, 0.01); // 455 µm over 130 bins
  EXPECT_EQ(loaded.refractive_index, 1.0) << "mirrors are moved in air";
  EXPECT_EQ(loaded.camera, "Octoplus, \"7\"");

  const auto verdict = nlohmann::json::parse(outcome.out);
  EXPECT_NEAR(verdict["mirrors"][0]["depth_bins"].get<double>(), 190, 0.3);
  EXPECT_NEAR(verdict["mirrors"][1]["depth_bins"].get<double>(), 60, 0.3);
  for (const auto& mirror : verdict["mirrors"]) {
    EXPECT_GT(mirror["fwhm_before_bins"].get<double>(),
              5 * mirror["fwhm_after_bins"].get<double>());
    EXPECT_LT(mirror["fwhm_after_bins"].get<double>(), 3.2);
  }
  const double true_roll_off_db =
      20 * std::log10(spectrometer.roll_off(60) / spectrometer.roll_off(190));
  EXPECT_NEAR(verdict["roll_off_db_per_mm"].get<double>(), true_roll_off_db / 0.455, 0.5);
  EXPECT_LT(verdict["residual_phase_rad"].get<double>(), 0.05);
  EXPECT_LT(verdict["depth_error_bins"].get<double>(), 0.05);
  EXPECT_TRUE(verdict["monotone"].get<bool>());

  const auto picture = tests::must(pipeline::read_png(png));
  EXPECT_EQ(picture.channels, 3);
  const auto dark_dots =
      std::ranges::count_if(picture.pixels, [](std::uint8_t value) { return value < 128; });
  EXPECT_GT(dark_dots, 20000); // curves are on it
}

TEST_F(CalibrateCommand, works_without_darks_and_in_words) {
  const auto outcome = calibrate({"--mirror", near, "--mirror", far});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_THAT(outcome.out, HasSubstr("FWHM"));
  EXPECT_THAT(outcome.out, HasSubstr("assumed; --tissue or --sample-side can tell"));
  EXPECT_TRUE(pipeline::Calibration::load(out, 1024));
}

TEST_F(CalibrateCommand, an_earlier_calibration_is_replaced_or_left_alone) {
  ASSERT_EQ(calibrate({"--mirror", near, "--mirror", far}).status, 0);
  const auto first = pipeline::Calibration::load(out, 1024);
  expect_refusal({"--mirror", near, "--mirror", near}, 1, "too close");
  EXPECT_EQ(pipeline::Calibration::load(out, 1024)->positions, first->positions);
  ASSERT_EQ(calibrate({"--mirror", far, "--mirror", near, "--dark", dark}).status, 0);
  EXPECT_NE(pipeline::Calibration::load(out, 1024)->positions, first->positions);
}

TEST_F(CalibrateCommand, lamp_becomes_a_wavelength_polynomial) {
  std::vector<double> mean(1024, 100.0);
  std::string lines;
  for (const double pixel : {80.3, 260.0, 430.6, 700.2, 930.9}) {
    for (std::size_t p = 0; p < mean.size(); ++p)
      mean[p] += 2000 * std::exp(-std::pow(static_cast<double>(p) - pixel, 2) / 5);
    lines += fmt::format("{}{:.6f}", lines.empty() ? "" : ",",
                         800 + 0.08 * pixel + 4e-6 * pixel * pixel);
  }
  const auto lamp = folder.write_values<std::uint16_t>("lamp.raw", counts(mean, 2)).string();
  const auto outcome = calibrate({"--lamp", lamp, "--lines", lines, "--spacing-um", "2.5"});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  const auto loaded = tests::must(pipeline::Calibration::load(out, 1024));
  const std::vector<double> truth{800, 0.08, 4e-6};
  const auto positions = pipeline::positions_from_wavelength(truth, 1024);
  for (std::size_t m = 0; m < 1024; ++m)
    EXPECT_NEAR(loaded.positions[m], (*positions)[m], 0.2);
  EXPECT_NEAR(loaded.depth_spacing_um, 2.5, 1e-12);
  expect_refusal({"--lamp", lamp, "--lines", "800,x"}, 2, "--lines is");
  expect_refusal({"--lamp", lamp, "--lines", "800,801,802,803,804"}, 1, "do not fit");
}

TEST_F(CalibrateCommand, depths_are_told_in_the_medium_that_is_asked_for) {
  const auto outcome = calibrate({"--mirror", far, "--mirror", near, "--dark", dark,
                                  "--distance-um", "455", "--refractive-index", "1.38", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  const auto loaded = tests::must(pipeline::Calibration::load(out, 1024));
  EXPECT_NEAR(loaded.depth_spacing_um, 3.5 / 1.38, 0.01) << "a delay in air is a shorter way there";
  EXPECT_EQ(loaded.refractive_index, 1.38);
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["refractive_index"], 1.38);
  expect_refusal({"--mirror", far, "--mirror", near, "--refractive-index", "1.38"}, 2,
                 "--refractive-index tells in what");
}

TEST_F(CalibrateCommand, a_spacing_that_is_given_holds_in_the_medium_that_is_given) {
  const std::vector<std::string> mirrors{"--mirror", far, "--mirror", near, "--spacing-um", "2.5"};
  ASSERT_EQ(calibrate(mirrors).status, 0);
  EXPECT_FALSE(pipeline::Calibration::load(out, 1024)->refractive_index) << "nobody said";
  auto said = mirrors;
  said.insert(said.end(), {"--refractive-index", "1.34"});
  ASSERT_EQ(calibrate(said).status, 0);
  EXPECT_EQ(pipeline::Calibration::load(out, 1024)->refractive_index, 1.34);
  EXPECT_EQ(pipeline::Calibration::load(out, 1024)->depth_spacing_um, 2.5);
}

TEST_F(CalibrateCommand, refuses_bad_measurements_and_leaves_nothing) {
  expect_refusal({"--mirror", near, "--mirror", near}, 1, "too close to each other");
  expect_refusal({"--mirror", near, "--mirror", dark}, 1, "no fringe");
  expect_refusal({"--mirror", near, "--mirror", (folder / "no.raw").string()}, 1,
                 "cannot be opened");
  expect_refusal({"--mirror", near, "--mirror", folder.path().string()}, 1, "directory");
  const auto empty = folder.write("empty.raw", "").string();
  expect_refusal({"--mirror", near, "--mirror", empty}, 1, "found 0 bytes");
  const auto ragged = folder.write("ragged.raw", std::string(3000, 'x')).string();
  expect_refusal({"--mirror", near, "--mirror", ragged}, 1, "found 3000 bytes");
  const auto other = folder.write("short.raw", std::string(1024, 'x')).string();
  expect_refusal({"--mirror", near, "--mirror", near, "--dark", other}, 1, "found 1024 bytes");
}

TEST_F(CalibrateCommand, refuses_numbers_that_cannot_be_with_their_index) {
  const sim::Reflector mirror{190, 500, 0};
  const auto mean = spectrometer.mean_counts({&mirror, 1});
  std::vector<float> floats(mean.begin(), mean.end());
  floats.insert(floats.end(), mean.begin(), mean.end());
  floats[1024 + 77] = std::numeric_limits<float>::quiet_NaN();
  const auto bad = folder.write_values<float>("bad_f32.raw", floats).string();
  expect_refusal({"--mirror", near, "--mirror", bad}, 1, "A-scan 1, sample 77 is nan");

  auto clipped = counts(mean, 1);
  for (auto& count : clipped)
    count = std::min<std::uint16_t>(count, 2000);
  const auto flat = folder.write_values<std::uint16_t>("flat.raw", clipped).string();
  expect_refusal({"--mirror", near, "--mirror", flat}, 1, "saturated");
  expect_refusal({"--mirror", near, "--mirror", far, "--bits", "11"}, 1, "expected less than 2047");
}

TEST_F(CalibrateCommand, wrong_use_is_2) {
  expect_refusal({}, 2, "expected one source");
  expect_refusal({"--mirror", near}, 2, "--mirror is given 1 times");
  expect_refusal({"--mirror", near, "--mirror", far, "--mirror", far}, 2, "given 3 times");
  expect_refusal({"--mirror", near, "--mirror", far, "--dark", dark, "--dark-none", dark}, 2,
                 "--dark does");
  expect_refusal({"--mirror", near, "--mirror", far, "--picture", out}, 2, "two files");
  EXPECT_EQ(calibrate({"--mirror", near, "--mirror", far, "--dtype", "i8"}).status, 2);
  EXPECT_EQ(calibrate({"--mirror", near, "--mirror", far, "--tissue", near}).status, 2);
  expect_refusal({"--mirror", near, "--mirror", far, "--tissue", near, "--shape", "1,3"}, 2,
                 "shape");
  out = (folder / "no/such/found.toml").string();
  expect_refusal({"--mirror", near, "--mirror", far}, 1, "no");
}

// The simulated spectrometer's curve both ways, with and without a word on which it is.
TEST_F(CalibrateCommand, tissue_tells_which_way_round_a_table_is_meant) {
  auto config = tests::must(sim::suggested_loop("nail_fold"));
  config.volumes = 1;
  config.plan.a_scans = 100;
  config.plan.b_scans = 4;
  const auto loop = tests::must(sim::VolumeLoop::make(config));
  const pipeline::ScanPlan& plan = loop->plan();
  std::string tissue;
  for (int b = 0; b < plan.b_scans; ++b) {
    const auto frame = loop->frame(0, b);
    tissue.append(reinterpret_cast<const char*>(frame.data()), frame.size());
  }
  folder.write("tissue.raw", tissue);
  const auto write_table = [&](std::string_view name, const std::vector<double>& curve) {
    folder.write(name, fmt::format("{}\n", fmt::join(curve, "\n")));
  };
  const sim::Spectrometer& model = loop->spectrometer();
  write_table("pixel.txt", model.true_k_positions());
  write_table("wavenumber.txt", model.k_of_pixel());
  for (const std::string is : {"pixel", "wavenumber"}) {
    for (const std::string said : {"", "pixel", "wavenumber"}) {
      SCOPED_TRACE(is + ", said " + said);
      const auto file = folder.write(
          "given.toml",
          fmt::format("[spectrometer]\nsamples = 1024\n[k_linear]\ntable = \"{}.txt\"\n{}", is,
                      said.empty() ? "" : fmt::format("table_gives = \"{}\"\n", said)));
      const auto outcome =
          calibrate({"--calibration", file.string(), "--tissue", (folder / "tissue.raw").string(),
                     "--shape", fmt::format("4,{},1024", plan.lines_per_frame()), "--json"});
      ASSERT_EQ(outcome.status, 0) << outcome.messages;
      const auto table = nlohmann::json::parse(outcome.out).at("table");
      const bool wrong = !said.empty() && said != is;
      fmt::print("  {} said \"{}\": {}\n", is, said, table.dump());
      EXPECT_EQ(table.at("gives"), said.empty() ? is : said);
      EXPECT_EQ(table.at("source"),
                said.empty() ? "by the tissue's sharpness" : "as the file says");
      EXPECT_EQ(table.at("warning") != "", wrong);
      const auto found = tests::must(pipeline::Calibration::load(out, 1024));
      EXPECT_EQ(found.k_table, pipeline::KTable::pixel);
      double farthest = 0;
      for (std::size_t m = 0; m < found.positions.size(); ++m)
        farthest = std::max(farthest, std::abs(found.positions[m] - model.true_k_positions()[m]));
      EXPECT_EQ(farthest > 1, wrong) << farthest;
    }
  }
}

double tissue_sharpness(const pipeline::Calibration& calibration) {
  const auto spectra = pipeline::SpectraFile::open(tests::test_data_folder() /
                                                       "sd-oct-tissue/spectra_u16_100x100x1024.raw",
                                                   {100, 100, 1024}, hal::SampleType::u16);
  pipeline::TissueSharpness sharpness{calibration};
  for (int b = 5; b < 100; b += 10) {
    const auto bytes = spectra->b_scan(b);
    const std::span raw{reinterpret_cast<const std::uint16_t*>(bytes.data()), bytes.size() / 2};
    sharpness.add_b_scan(std::vector<double>(raw.begin(), raw.end()));
  }
  return sharpness.measure(calibration.dispersion_rad);
}

TEST_F(CalibrateCommand, real_mirrors_and_tissue) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/spectra_u16_100x100x1024.raw");
  const auto data = tests::test_data_folder() / "sd-oct-tissue";
  const auto file = [&](const std::string& name) {
    return (data / (name + "_f32_1024.raw")).string();
  };
  const auto outcome = calibrate(
      {"--mirror", file("mirror1"), "--mirror", file("mirror2"), "--dark-none", file("dark_not"),
       "--dark-reference", file("dark_ref"), "--dark-sample", file("dark_sample1"), "--dark-sample",
       file("dark_sample2"), "--tissue", (data / "spectra_u16_100x100x1024.raw").string(),
       "--shape", "100,100,1024", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  const auto verdict = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(verdict["sample_side"], "the second mirror"); // as its source says
  for (const auto& mirror : verdict["mirrors"])
    EXPECT_LE(mirror["fwhm_after_bins"].get<double>(), 2.5);
  const auto found = pipeline::Calibration::load(out, 1024);
  const auto supplied = pipeline::Calibration::load(tests::TissueCalibration{}.file(), 1024);
  ASSERT_TRUE(found && supplied);
  const double share = tissue_sharpness(*found) / tissue_sharpness(*supplied);
  fmt::print("  tissue: {:.1f} % of the sharpness with the supplied curves\n", 100 * share);
  EXPECT_GE(share, 0.95);

  ReconstructOptions reconstruction;
  reconstruction.spectra = data / "spectra_u16_100x100x1024.raw";
  reconstruction.shape = {100, 100, 1024};
  reconstruction.calibration = out;
  reconstruction.volume = folder / "volume.nrrd";
  const auto done = reconstruct_volume(reconstruction);
  ASSERT_TRUE(done) << done.error().message;
  const auto volume = tests::must(pipeline::read_nrrd(reconstruction.volume));
  const auto& levels = std::get<std::vector<float>>(volume.levels);
  EXPECT_NEAR(tests::tissue_surface(levels, 50, 0), 50, 10);
  EXPECT_NEAR(tests::tissue_surface(levels, 50, 90), 25, 8);
}

} // namespace
} // namespace octascope::firmware_host

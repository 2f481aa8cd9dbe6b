// The command from end to end: spectra in a file → NRRD and PNG.
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/commands/volume/reconstruct.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/files/png_image.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/test_data.h"
#include "tests/support/files/tissue_calibration.h"
#include "tests/support/must.h"
#include "tests/support/pictures/tissue_surface.h"

namespace octascope::firmware_host {
namespace {

using testing::HasSubstr;

// Runs a command line; the exit status that main() would give.
int run_octascope(std::vector<std::string> arguments) {
  int exit_status = 0;
  CLI::App app;
  app.require_subcommand(1);
  add_reconstruct_command(app, exit_status);
  std::ranges::reverse(arguments);
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? 0 : 2;
  }
  return exit_status;
}

class ReconstructCommand : public testing::Test {
protected:
  ReconstructCommand() {
    std::mt19937 generator{11};
    for (auto& count : counts)
      count = static_cast<std::uint16_t>(generator() % 4096);
    spectra = folder.write_values<std::uint16_t>("s.raw", counts).string();
    out = (folder / "v.nrrd").string();
    png = (folder / "b.png").string();
  }
  int reconstruct(std::vector<std::string> more, const std::string& shape = "5,4,32") {
    std::vector<std::string> arguments{"reconstruct", "--spectra", spectra, "--shape",
                                       shape,         "--out",     out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_octascope(std::move(arguments));
  }

  tests::ScratchFolder folder;
  std::vector<std::uint16_t> counts = std::vector<std::uint16_t>(5 * 4 * 32);
  std::string spectra;
  std::string out;
  std::string png;
};

TEST_F(ReconstructCommand, writes_a_volume_and_a_picture) {
  ASSERT_EQ(reconstruct({"--bscan", "4", "--png", png}), 0);
  const auto volume = tests::must(pipeline::read_nrrd(out));
  EXPECT_EQ(volume.geometry.depths, 16);
  EXPECT_EQ(volume.geometry.a_scans, 4);
  EXPECT_EQ(volume.geometry.b_scans, 5);
  const auto picture = tests::must(pipeline::read_png(png));
  EXPECT_EQ(picture.width, 4);
  EXPECT_EQ(picture.height, 16);
  EXPECT_EQ(picture.channels, 1);
  EXPECT_EQ(folder.count(), 3); // the spectra and these two: nothing half-written
}

TEST_F(ReconstructCommand, counts_are_the_quantised_decibels) {
  ASSERT_EQ(reconstruct({}), 0);
  const auto db = pipeline::read_nrrd(out);
  ASSERT_EQ(reconstruct({"--u8"}), 0);
  const auto display = pipeline::read_nrrd(out);
  ASSERT_TRUE(db && display);
  const auto& levels = std::get<std::vector<float>>(db->levels);
  const auto& quantised = std::get<std::vector<std::uint8_t>>(display->levels);
  ASSERT_EQ(levels.size(), quantised.size());
  for (std::size_t i = 0; i < levels.size(); ++i)
    EXPECT_NEAR(2 * (levels[i] + 40), quantised[i], 0.51F);
}

TEST_F(ReconstructCommand, takes_every_type) {
  ASSERT_EQ(reconstruct({"--dtype", "u12"}), 0); // drawn below 4096
  const auto expected = std::get<std::vector<float>>(pipeline::read_nrrd(out)->levels);
  const auto expect_the_same = [&](std::vector<std::string> options) {
    ASSERT_EQ(reconstruct(std::move(options)), 0);
    const auto volume = tests::must(pipeline::read_nrrd(out));
    const auto& levels = std::get<std::vector<float>>(volume.levels);
    ASSERT_EQ(levels.size(), expected.size());
    for (std::size_t i = 0; i < levels.size(); ++i)
      if (expected[i] > 0) {
        ASSERT_NEAR(levels[i], expected[i], 0.01F) << i;
      }
  };
  expect_the_same({"--dtype", "u16"});
  expect_the_same({"--dtype", "u14"});
  std::vector<std::uint16_t> shifted(counts);
  for (auto& count : shifted)
    count = static_cast<std::uint16_t>(count << 4 | 5);
  spectra = folder.write_values<std::uint16_t>("shifted.raw", shifted).string();
  expect_the_same({"--dtype", "u12", "--shift", "4"});
  expect_the_same({"--shift", "4"});
  const std::vector<float> floats{counts.begin(), counts.end()};
  spectra = folder.write_values<float>("floats.raw", floats).string();
  expect_the_same({"--dtype", "f32"});
}

TEST_F(ReconstructCommand, refuses_what_does_not_fit_the_type) {
  EXPECT_EQ(reconstruct({"--dtype", "u10"}), 1); // some have 12 bits
  EXPECT_EQ(reconstruct({"--dtype", "u12", "--shift", "5"}), 1);
  EXPECT_EQ(reconstruct({"--dtype", "u16", "--shift", "-1"}), 2);
  EXPECT_EQ(reconstruct({"--dtype", "u16", "--shift", "16"}), 2);
  EXPECT_EQ(reconstruct({"--dtype", "u12", "--shift", "x"}), 2);
  EXPECT_FALSE(std::filesystem::exists(out));
  ReconstructOptions options;
  options.spectra = spectra;
  options.shape = {5, 4, 32};
  options.significant_bits = 10;
  options.volume = out;
  EXPECT_THAT(reconstruct_volume(options), tests::FailsSaying("expected at most 1023: 10 bits"));
}

TEST_F(ReconstructCommand, a_running_background_is_the_same_for_any_number_of_threads) {
  folder.write("c.toml", "[spectrometer]\nsamples = 32\n[k_linear]\npolynomial = [0.0, 31.0]\n"
                         "[background]\nmode = \"running\"\n");
  ReconstructOptions options;
  options.spectra = spectra;
  options.shape = {5, 4, 32};
  options.calibration = folder / "c.toml";
  options.volume = out;
  options.threads = 1;
  ASSERT_TRUE(reconstruct_volume(options));
  const auto alone = pipeline::read_nrrd(out);
  options.threads = 4;
  ASSERT_TRUE(reconstruct_volume(options));
  const auto together = pipeline::read_nrrd(out);
  ASSERT_TRUE(alone && together);
  EXPECT_EQ(alone->levels, together->levels);
}

TEST_F(ReconstructCommand, zero_padding_halves_the_spacing) {
  folder.write("c.toml", "[spectrometer]\nsamples = 32\n[k_linear]\npolynomial = [0.0, 31.0]\n"
                         "[transform]\nzero_padding = 2\n[depth]\nspacing_um = 3.0\n");
  ASSERT_EQ(reconstruct({"--calibration", (folder / "c.toml").string()}), 0);
  const auto volume = tests::must(pipeline::read_nrrd(out));
  EXPECT_EQ(volume.geometry.depths, 32);
  EXPECT_NEAR(volume.geometry.depth_spacing_um, 1.5, 1e-9);
}

// In the file, for whoever reads it, and on the terminal.
TEST_F(ReconstructCommand, says_which_spacings_are_assumed) {
  const auto remarks = [&](const std::string& depth) -> std::vector<std::string> {
    const std::string calibration = folder.write(
        "c.toml", "[spectrometer]\nsamples = 32\n[k_linear]\npolynomial = [0.0, 31.0]\n"
                  "[depth]\n" +
                      depth);
    testing::internal::CaptureStderr();
    EXPECT_EQ(depth.empty() ? reconstruct({}) : reconstruct({"--calibration", calibration}), 0);
    const std::string terminal = testing::internal::GetCapturedStderr();
    const auto volume = tests::must(pipeline::read_nrrd(out));
    EXPECT_EQ(terminal.empty(), volume.remarks.empty()) << terminal;
    EXPECT_THAT(terminal, HasSubstr(volume.geometry.assumed.words()));
    return volume.remarks;
  };
  using testing::ElementsAre;
  EXPECT_THAT(remarks(""), ElementsAre(HasSubstr("not measured: depth, A-scan, B-scan")));
  EXPECT_THAT(remarks("spacing_um = 3.0\n"),
              ElementsAre(HasSubstr("not measured: A-scan, B-scan")));
  EXPECT_THAT(remarks("spacing_um = 3\na_spacing_um = 9\nb_spacing_um = 9\n"), testing::IsEmpty());
}

TEST_F(ReconstructCommand, wrong_use_is_2) {
  EXPECT_EQ(run_octascope({"reconstruct"}), 2);
  EXPECT_EQ(reconstruct({}, "5,4"), 2);
  EXPECT_EQ(reconstruct({}, "0,4,32"), 2);
  EXPECT_EQ(reconstruct({}, "5,4,-32"), 2);
  EXPECT_EQ(reconstruct({"--dtype", "i64"}), 2);
  EXPECT_EQ(reconstruct({"--bscan", "1"}), 2);
  EXPECT_EQ(reconstruct({"--png", png}), 2);
  EXPECT_EQ(reconstruct({"--bscan", "5", "--png", png}), 2);
  EXPECT_EQ(reconstruct({"--bscan", "-1", "--png", png}), 2);
  EXPECT_EQ(reconstruct({"--unknown"}), 2);
  EXPECT_EQ(folder.count(), 1);
}

TEST_F(ReconstructCommand, failure_is_1_and_leaves_nothing) {
  EXPECT_EQ(reconstruct({}, "5,4,33"), 1);
  EXPECT_EQ(reconstruct({"--calibration", "missing.toml"}), 1);
  EXPECT_EQ(reconstruct({"--dtype", "f32"}), 1);
  out = (folder / "no/such/folder.nrrd").string();
  EXPECT_EQ(reconstruct({}), 1);
  EXPECT_EQ(folder.count(), 1);
}

TEST_F(ReconstructCommand, floats_must_be_finite) {
  std::vector<float> values(5 * 4 * 32, 100.0F);
  values[200] = std::numeric_limits<float>::infinity();
  ReconstructOptions options;
  options.spectra = folder.write_values<float>("f.raw", values);
  options.shape = {5, 4, 32};
  options.type = hal::SampleType::f32;
  options.volume = out;
  EXPECT_THAT(reconstruct_volume(options),
              tests::FailsSaying("B-scan 1, A-scan 2, sample 8 is inf"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

// Less their own mean such lines are silence: another background is taken, and told.
TEST_F(ReconstructCommand, lines_that_their_own_mean_would_silence_are_there) {
  const auto calibration =
      folder.write("mean.toml", "[spectrometer]\nsamples = 32\n[k_linear]\npolynomial = [0, 31]\n"
                                "[background]\nmode = \"mean\"\n");
  struct Case {
    std::string shape;
    std::size_t lines;
    std::vector<std::string> more;
    std::string warning;
  };
  for (const Case& c :
       {Case{"1,1,32", 1, {}, "a single line"}, Case{"20,1,32", 20, {}, ""},
        Case{"20,1,32", 20, {"--calibration", calibration.string()}, "B-scans of one A-scan"}}) {
    spectra = folder
                  .write_values<std::uint16_t>(
                      "few.raw", std::span<const std::uint16_t>{counts}.first(32 * c.lines))
                  .string();
    testing::internal::CaptureStderr();
    ASSERT_EQ(reconstruct(c.more, c.shape), 0);
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr(c.warning));
    const auto volume = tests::must(pipeline::read_nrrd(out));
    const auto& levels = std::get<std::vector<float>>(volume.levels);
    ASSERT_EQ(levels.size(), 16 * c.lines);
    for (std::size_t line = 0; line < c.lines; ++line)
      EXPECT_GT(std::ranges::max(std::span{levels}.subspan(16 * line, 16)), 20);
  }
}

TEST_F(ReconstructCommand, real_tissue_has_its_sloping_surface) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/spectra_u16_100x100x1024.raw");
  const tests::TissueCalibration file;
  const std::string calibration = file.file().string();
  spectra = (tests::test_data_folder() / "sd-oct-tissue/spectra_u16_100x100x1024.raw").string();
  ASSERT_EQ(reconstruct({"--calibration", calibration}, "100,100,1024"), 0);
  const auto volume = tests::must(pipeline::read_nrrd(out));
  EXPECT_NEAR(volume.geometry.depth_spacing_um, 3.5, 1e-9);
  const auto& levels = std::get<std::vector<float>>(volume.levels);
  const int left = tests::tissue_surface(levels, 50, 0);
  const int right = tests::tissue_surface(levels, 50, 90);
  fmt::print("  surface of B-scan 50: bin {} at the left, {} at the right\n", left, right);
  EXPECT_NEAR(left, 50, 10);
  EXPECT_NEAR(right, 25, 8);
  EXPECT_NEAR(left - right, 25, 8);

  if (std::system("command -v teem-unu > /dev/null") == 0) {
    EXPECT_EQ(std::system(fmt::format("teem-unu minmax {} > /dev/null", out).c_str()), 0);
  }
}

} // namespace
} // namespace octascope::firmware_host

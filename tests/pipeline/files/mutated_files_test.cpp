// Whatever is in a file, its reader gives a value that keeps its promises or a message that names
// the file: it never crashes, hangs or takes memory that the file does not account for. New random
// files in every run; the sanitizers watch.
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/calibration/calibration.h"
#include "pipeline/files/config_document.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/files/png_image.h"
#include "pipeline/files/text_curve.h"
#include "pipeline/reconstruction/spectra_file.h"
#include "pipeline/vessels/point_registration.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::pipeline {
namespace {

namespace fs = std::filesystem;

class MutatedFiles : public testing::Test {
protected:
  // `read` takes the file, checks what it got, and gives the message when it got nothing.
  using Read = std::function<std::string(const fs::path&)>;

  void try_all(const std::string& good, const std::string& name, const Read& read) {
    ASSERT_EQ(read(folder.write(name, good)), "") << "the good file";
    std::mt19937_64 generator{tests::fresh_seed()};
    int refused = 0;
    constexpr int rounds = 1500;
    for (int round = 0; round < rounds; ++round) {
      const std::string bad = tests::mutate(good, generator);
      fs::remove(folder / name); // writing over it would wait for the disc
      const std::string message = read(folder.write(name, bad));
      if (!message.empty()) {
        ++refused;
        ASSERT_NE(message.find(name), std::string::npos) << "round " << round << ": " << message;
        ASSERT_LT(message.size(), 1000U) << "round " << round << ": " << message;
      }
      if (HasFatalFailure())
        return;
    }
    fmt::print("  {} of {} refused\n", refused, rounds);
    EXPECT_GT(refused, rounds / 20); // else nothing was tried
  }

  tests::ScratchFolder folder;
};

TEST_F(MutatedFiles, point_pairs) {
  std::string good = "# tree x, y, z, volume x, y, z\n";
  for (int i = 0; i < 12; ++i)
    good += fmt::format("{}, {};\t{} {:.3f},{},{}{}\n", i, i % 3, i * i % 7, i + 0.125, i % 3 - 4,
                        i * i % 7 + 2e-1, i % 5 == 0 ? " # here\r" : "");
  try_all(good, "pairs.csv", [](const fs::path& file) -> std::string {
    const auto rows = read_text_rows(file, 20, {6});
    if (!rows)
      return rows.error().message;
    std::vector<PointPair> pairs;
    for (const auto& [line, n] : *rows) {
      EXPECT_EQ(n.size(), 6U);
      pairs.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
    }
    const auto found = register_points(pairs);
    if (!found)
      return file.string() + found.error().message;
    EXPECT_TRUE(std::isfinite(found->rms_mm));
    for (const auto& row : found->volume_from_tree.rotation)
      EXPECT_NEAR(row[0] * row[0] + row[1] * row[1] + row[2] * row[2], 1, 1e-9);
    return {};
  });
}

TEST_F(MutatedFiles, text_curves) {
  std::string good = "# pixels\n";
  for (int i = 0; i < 40; ++i)
    good += fmt::format("{:.6f}{}", i * 1.0123, i % 7 == 0 ? "  # here\r\n" : "\n");
  try_all(good, "curve.txt", [](const fs::path& file) -> std::string {
    const auto curve = read_text_curve(file, 40);
    if (!curve)
      return curve.error().message;
    EXPECT_EQ(curve->size(), 40U);
    for (const double value : *curve)
      EXPECT_TRUE(std::isfinite(value));
    return {};
  });
}

TEST_F(MutatedFiles, calibrations) {
  std::string curve;
  for (int i = 0; i < 64; ++i)
    curve += fmt::format("{:.4f}\n", i == 63 ? 63.0 : i * 1.0 + 0.1 * std::sin(0.1 * i));
  folder.write("k.txt", curve);
  folder.write("theta.txt", curve);
  const std::string good = "[spectrometer]\nsamples = 64\n\n[k_linear]\ntable = \"k.txt\"\n"
                           "interpolation = \"cubic\"\n\n[dispersion]\ntable = \"theta.txt\"\n"
                           "sign = -1\n\n[background]\nmode = \"mean\"\n\n[window]\n"
                           "kind = \"tukey\"\n\n[depth]\nspacing_um = 3.5\na_spacing_um = 10\n"
                           "b_spacing_um = 37.5\n";
  try_all(good, "calibration.toml", [](const fs::path& file) -> std::string {
    const auto calibration = Calibration::load(file, 64);
    if (!calibration) // or it speaks of the curve that is named in it
      return calibration.error().message + " calibration.toml";
    EXPECT_TRUE(calibration->validate());
    EXPECT_EQ(calibration->positions.size(), 64U);
    return {};
  });
}

TEST_F(MutatedFiles, polynomials_of_calibrations) {
  const std::string good = "[spectrometer]\nsamples = 64\n[k_linear]\n"
                           "polynomial = [0.0, 66.0, -3.0]\n[dispersion]\n"
                           "polynomial = [0.0, 1.0, -3.5, 2.25]\n[depth]\nspacing_um = 3\n";
  try_all(good, "calibration.toml", [](const fs::path& file) -> std::string {
    const auto calibration = Calibration::load(file, 64);
    if (!calibration)
      return calibration.error().message + " calibration.toml";
    EXPECT_TRUE(calibration->validate());
    return {};
  });
}

TEST_F(MutatedFiles, volumes) {
  NrrdVolume volume;
  volume.geometry = VolumeGeometry{4, 3, 2, 3.5, 10, 37.5};
  volume.levels = std::vector<float>(24, -12.5F);
  ASSERT_TRUE(write_nrrd(folder / "good.nrrd", volume));
  try_all(tests::whole_file(folder / "good.nrrd"), "volume.nrrd",
          [](const fs::path& file) -> std::string {
            const auto read = read_nrrd(file);
            if (!read)
              return read.error().message;
            const std::size_t size =
                std::visit([](const auto& levels) { return levels.size(); }, read->levels);
            EXPECT_EQ(size, read->geometry.voxels());
            EXPECT_LE(size, 4096U); // the file has no more bytes than that
            return {};
          });
}

TEST_F(MutatedFiles, pictures) {
  Image image{7, 5, 3};
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<std::uint8_t>(i * 37);
  ASSERT_TRUE(write_png(folder / "good.png", image));
  try_all(tests::whole_file(folder / "good.png"), "picture.png",
          [](const fs::path& file) -> std::string {
            const auto read = read_png(file);
            if (!read)
              return read.error().message;
            EXPECT_EQ(read->pixels.size(), static_cast<std::size_t>(read->width) *
                                               static_cast<std::size_t>(read->height) *
                                               static_cast<std::size_t>(read->channels));
            return {};
          });
  try_all(tests::whole_file(folder / "good.png"), "numbers.png",
          [](const fs::path& file) -> std::string {
            const auto read = read_png_numbers(file, 4096);
            if (!read)
              return read.error().message;
            EXPECT_EQ(read->values.size(), static_cast<std::size_t>(read->width) *
                                               static_cast<std::size_t>(read->height) *
                                               static_cast<std::size_t>(read->channels));
            return {};
          });
}

TEST_F(MutatedFiles, spectra) {
  const std::string good(2 * 3 * 16 * 4, '\x3f'); // finite floats
  try_all(good, "spectra.raw", [](const fs::path& file) -> std::string {
    const auto spectra = SpectraFile::open(file, {2, 3, 16}, hal::SampleType::f32);
    if (!spectra)
      return spectra.error().message;
    for (const int b : {0, 1}) {
      EXPECT_EQ(spectra->b_scan(b).size(), 3U * 16 * 4);
      if (const auto fault = spectra->find_non_finite(b))
        return *fault;
    }
    return {};
  });
}

TEST(MutatedShapes, are_read_or_refused) {
  std::mt19937_64 generator{tests::fresh_seed()};
  for (int round = 0; round < 20000; ++round) {
    const auto shape = SpectraShape::parse(tests::mutate("100,300,1024", generator));
    if (shape) {
      ASSERT_GE(shape->b_scans, 1);
      ASSERT_GE(shape->a_scans, 1);
      ASSERT_GE(shape->samples, 1);
    }
  }
}

} // namespace
} // namespace octascope::pipeline

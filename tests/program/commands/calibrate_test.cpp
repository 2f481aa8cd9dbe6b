// octascope calibrate as a user runs it: on the real mirrors and tissue, and on what it must
// refuse, with the reason, the place and nothing written.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/calibration/calibration.h"
#include "pipeline/files/text_curve.h"
#include "tests/program/program_support.h"
#include "tests/support/files/test_data.h"
#include "tests/support/files/tissue_calibration.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;

std::string real(const std::string& name) {
  return (test_data_folder() / "sd-oct-tissue" / name).string();
}

json calibrate(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "calibrate");
  arguments.push_back("--json");
  const ProgramResult result = run_well(std::move(arguments), 120s);
  return result.exit_status == 0 ? json::parse(result.out) : json{};
}

pipeline::Calibration loaded(const std::string& file) {
  const auto calibration = pipeline::Calibration::load(file, 1024);
  EXPECT_TRUE(calibration) << (calibration ? "" : calibration.error().message);
  return calibration.value_or(pipeline::Calibration::identity(1024));
}

TEST(Calibrate, sharpens_the_real_mirrors_by_itself_in_either_order_and_from_text) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/mirror1_f32_1024.raw");
  const ScratchFolder folder;
  std::vector<std::string> files{real("mirror1_f32_1024.raw"), real("mirror2_f32_1024.raw")};
  const auto expect_sharp = [&](const std::string& out) {
    const json verdict =
        calibrate({"--mirror", files[0], "--mirror", files[1], "--out", folder / out});
    ASSERT_EQ(verdict.value("mirrors", json::array()).size(), 2U);
    for (const json& mirror : verdict["mirrors"]) {
      EXPECT_GT(mirror["fwhm_before_bins"].get<double>(), 7) << mirror;
      EXPECT_LE(mirror["fwhm_after_bins"].get<double>(), 2.5) << mirror;
    }
  };
  expect_sharp("first.toml");
  std::swap(files[0], files[1]);
  expect_sharp("swapped.toml");
  for (std::string& file : files) {
    const auto values = pipeline::read_float_curve(file, 1024);
    ASSERT_TRUE(values);
    std::string text = "# counts of each pixel\n";
    for (const float value : *values)
      text += fmt::format("{}\n", value);
    file = folder.write(std::filesystem::path{file}.stem().string() + ".txt", text).string();
  }
  expect_sharp("text.toml");

  const auto first = loaded(folder / "first.toml");
  for (const char* other : {"swapped.toml", "text.toml"}) {
    const auto calibration = loaded(folder / other);
    for (std::size_t m = 0; m < 1024; ++m) {
      ASSERT_NEAR(calibration.positions[m], first.positions[m], 1e-4) << other << ", " << m;
      ASSERT_NEAR(calibration.dispersion_rad[m], first.dispersion_rad[m], 1e-4) << other;
    }
  }
}

TEST(Calibrate, finds_the_sign_of_dispersion_on_the_real_tissue_alone) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/spectra_u16_100x100x1024.raw");
  const ScratchFolder folder;
  const TissueCalibration calibration;
  const std::string supplied = calibration.file().string();
  const json verdict =
      calibrate({"--calibration", supplied, "--tissue", real("spectra_u16_100x100x1024.raw"),
                 "--shape", "100,100,1024", "--out", folder / "found.toml"});
  ASSERT_TRUE(verdict.contains("tissue")) << verdict;
  EXPECT_GT(verdict["tissue"]["sharpness_after"].get<double>(),
            1.01 * verdict["tissue"]["sharpness_before"].get<double>());
  const auto found = loaded(folder / "found.toml");
  const auto given = loaded(supplied);
  EXPECT_EQ(found.positions, given.positions);
  double along = 0;
  for (std::size_t m = 100; m < 900; ++m)
    along += found.dispersion_rad[m] * given.dispersion_rad[m];
  EXPECT_GT(along, 0);
}

// --- refusals

constexpr std::size_t samples = 512;

// A fringe of so many periods under a bell, as 16-bit counts.
std::vector<std::uint16_t> fringe(double periods, double brightness = 10000) {
  std::vector<std::uint16_t> counts;
  for (std::size_t p = 0; p < samples; ++p) {
    const double t = static_cast<double>(p) / (samples - 1);
    const double bell = std::exp(-std::pow((t - 0.5) / 0.25, 2) / 2);
    counts.push_back(static_cast<std::uint16_t>(std::clamp(
        std::round(brightness * bell * (2 + std::cos(2 * std::numbers::pi * periods * t))), 0.0,
        65535.0)));
  }
  return counts;
}

// Positions 0 … 2047 whose neighbours 1194 and 1195 are those of a real spectrometer's curve.
std::string jumping_curve(double after) {
  std::string text;
  for (int m = 0; m < 2048; ++m) {
    const double position =
        m <= 1194 ? 1201.42 * m / 1194 : after + (2047 - after) * (m - 1195) / (2047 - 1195);
    text += fmt::format("{:.5f}\n", position);
  }
  return text;
}

void lay_out(const ScratchFolder& folder) {
  const auto put = [&](std::string_view name, const std::vector<std::uint16_t>& counts) {
    folder.write_values<std::uint16_t>(name, counts);
  };
  put("good.raw", fringe(40));
  put("far.raw", fringe(120));
  put("same.raw", fringe(40.4));
  put("few.raw", fringe(2));
  put("flat.raw", std::vector<std::uint16_t>(samples, 900));
  put("saturated.raw", fringe(120, 40000));
  put("line.raw", std::vector<std::uint16_t>(2048 * 4 * 3, 700));
  auto shorter = fringe(120);
  shorter.pop_back();
  put("shorter.raw", shorter);
  std::vector<float> floats(samples);
  std::transform(floats.begin(), floats.end(), floats.begin(), [](float) { return 1.0F; });
  floats[77] = std::numeric_limits<float>::quiet_NaN();
  folder.write_values<float>("nan_f32.raw", floats);
  folder.write("words.txt", "1\n2\nthree\n4\n");
  for (const auto& [name, after] : {std::pair{"jump", 1210.44}, std::pair{"fall", 1200.9}}) {
    folder.write(fmt::format("{}.txt", name), jumping_curve(after));
    folder.write(
        fmt::format("{}.toml", name),
        fmt::format("[spectrometer]\nsamples = 2048\n[k_linear]\ntable = \"{}.txt\"\n", name));
  }
}

struct Refusal {
  std::string name;
  std::vector<std::string> arguments; // "@x" is the file x of the folder
  std::vector<std::string> told;
  friend void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.name; }
};

std::vector<Refusal> refusals() {
  const auto pair = [](const char* other) {
    return std::vector<std::string>{"--mirror", "@good.raw", "--mirror", other};
  };
  const auto tissue = [](const char* base) {
    return std::vector<std::string>{"--calibration", base,      "--tissue",
                                    "@line.raw",     "--shape", "4,3,2048"};
  };
  return {
      {"jumping_curve", tissue("@jump.toml"), {"jump", "1194 is 1201.42", "1195 is 1210.44"}},
      {"falling_curve", tissue("@fall.toml"), {"monotone", "1195", "1200.9"}},
      {"unequal_lengths", pair("@shorter.raw"), {"shorter.raw", "511 samples", "512"}},
      {"too_few_fringes", pair("@few.raw"), {"few.raw", "fringe"}},
      {"no_fringe", pair("@flat.raw"), {"flat.raw", "no fringe: all samples are 900"}},
      {"same_depth", pair("@same.raw"), {"too close", "expected at least 8"}},
      {"saturated", pair("@saturated.raw"), {"saturated.raw", "saturated: sample 119 is 65535"}},
      {"not_a_number", pair("@nan_f32.raw"), {"nan_f32.raw", "sample 77 is nan"}},
      {"text_with_words", pair("@words.txt"), {"words.txt:3", "\"three\""}},
  };
}

class CalibrateRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(CalibrateRefusal, says_why_and_where_and_writes_nothing) {
  const ScratchFolder folder;
  lay_out(folder);
  std::vector<std::string> arguments{"calibrate"};
  for (const std::string& argument : GetParam().arguments)
    arguments.push_back(argument.starts_with('@') ? (folder / argument.substr(1)).string()
                                                  : argument);
  arguments.insert(arguments.end(), {"--out", folder / "x.toml", "--picture", folder / "x.png"});
  const std::string said = run_refused(folder, std::move(arguments));
  for (const std::string& words : GetParam().told)
    EXPECT_THAT(said, HasSubstr(words));
}

INSTANTIATE_TEST_SUITE_P(All, CalibrateRefusal, testing::ValuesIn(refusals()),
                         [](const auto& test) { return test.param.name; });

} // namespace
} // namespace octascope::tests

// octascope vessels render and vessels bench as a user runs them.
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/files/png_image.h"
#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr int segments = 3000;

class VesselPictures : public ::testing::Test {
protected:
  void SetUp() override {
    run_well({"vessels", "generate", "--segments", std::to_string(segments), "--seed", "1", "--out",
              tree_});
  }

  ProgramResult render(std::vector<std::string> options) const {
    options.insert(options.begin(),
                   {"vessels", "render", tree_, "--size", "320x180", "--out", picture_});
    return run_octascope(options);
  }

  // Its pixels that are neither of the background nor of the scale bar.
  std::size_t pixels_of_vessels() const {
    const auto image = pipeline::read_png(picture_);
    EXPECT_TRUE(image) << image.error().message;
    std::size_t count = 0;
    for (std::size_t i = 0; image && i < image->pixels.size(); i += 3) {
      const auto& p = image->pixels;
      const int spread =
          std::max({p[i], p[i + 1], p[i + 2]}) - std::min({p[i], p[i + 1], p[i + 2]});
      count += spread > 30;
    }
    return count;
  }

  ScratchFolder folder_;
  std::string tree_ = folder_ / "heart.vessels";
  std::string picture_ = folder_ / "heart.png";
};

TEST_F(VesselPictures, are_drawn_by_each_method_and_accounted_for) {
  std::vector<std::size_t> shown;
  for (const char* method :
       {"tubes-gpu", "tubes-cpu", "quads-gpu", "quads-cpu", "balanced", "hybrid"}) {
    const ProgramResult drawn = render({"--method", method});
    ASSERT_EQ(drawn.exit_status, 0) << drawn.describe();
    EXPECT_THAT(drawn.err, HasSubstr(std::string{method} + ": "));
    EXPECT_THAT(drawn.err, HasSubstr("= 3000 segments"));
    EXPECT_THAT(drawn.err, HasSubstr("mm a pixel, yaw 35, tilt 15 degrees"));
    shown.push_back(pixels_of_vessels());
  }
  EXPECT_GT(shown.front(), 2000U);
  for (const std::size_t pixels : shown)
    EXPECT_NEAR(static_cast<double>(pixels), static_cast<double>(shown.back()),
                0.1 * static_cast<double>(shown.back()));
}

TEST_F(VesselPictures, show_a_branch_alone_and_what_is_looked_at) {
  const ProgramResult lcx = render({"--branch", "lcx", "--colour", "order", "--yaw", "200"});
  ASSERT_EQ(lcx.exit_status, 0) << lcx.describe();
  EXPECT_THAT(lcx.err, HasSubstr("yaw 200"));
  EXPECT_THAT(lcx.err, ::testing::Not(HasSubstr("= 3000 segments")));
  EXPECT_GT(pixels_of_vessels(), 500U);
  const ProgramResult away =
      render({"--target", "500,0,0", "--mm-per-pixel", "0.02", "--zoom", "2"});
  ASSERT_EQ(away.exit_status, 0) << away.describe();
  EXPECT_THAT(away.err, HasSubstr("3000 culled = 3000 segments"));
  EXPECT_THAT(away.err, HasSubstr("target 500.000,0.000,0.000 mm, 0.01 mm a pixel"));
  EXPECT_EQ(pixels_of_vessels(), 0U);
}

TEST_F(VesselPictures, say_what_cannot_be_drawn) {
  for (const auto& [option, value, words] : {std::array{"--method", "lines", "lines"},
                                             {"--sectors", "5", "even number"},
                                             {"--branch", "aorta", "aorta"},
                                             {"--target", "1,2", "--target"},
                                             {"--zoom", "0", "--zoom"}}) {
    const ProgramResult refused = render({option, value});
    EXPECT_EQ(refused.exit_status, 2) << refused.describe();
    EXPECT_THAT(refused.err, HasSubstr(words));
  }
  const ProgramResult missing =
      run_octascope({"vessels", "render", folder_ / "none.vessels", "--out", picture_});
  EXPECT_EQ(missing.exit_status, 1);
  EXPECT_THAT(missing.err, HasSubstr("octascope vessels render: "));
  EXPECT_THAT(missing.err, HasSubstr("none.vessels"));
  EXPECT_FALSE(std::filesystem::exists(picture_));
}

TEST_F(VesselPictures, are_measured) {
  const std::string dump = folder_ / "pictures";
  const ProgramResult measured = run_well({"vessels", "bench", tree_, "--json", "--size", "160x90",
                                           "--seconds", "0.01", "--supersampled", "--dump", dump});
  const json report = json::parse(measured.out);
  EXPECT_EQ(report["segments"], segments);
  EXPECT_EQ(report["size"], "160x90");
  EXPECT_GT(report["load_ms"], 0);
  EXPECT_GT(report["build_ms"], 0);
  EXPECT_GT(report["memory"]["bytes_per_segment"], 8);
  for (const char* view : {"whole", "middle", "close"}) {
    EXPECT_GT(report["view_definitions"][view]["mm_per_pixel"], 0);
    EXPECT_GT(report["hybrid_gain_over_brute_force"][view], 0);
    for (const char* method : {"tubes-gpu", "tubes-cpu", "quads-gpu", "quads-cpu", "balanced",
                               "hybrid", "quads-brute-force"}) {
      SCOPED_TRACE(std::string{view} + ' ' + method);
      const json& found = report["views"][view][method];
      const std::uint64_t accounted =
          found["drawn"].get<std::uint64_t>() + found["splatted"].get<std::uint64_t>() +
          found["merged"].get<std::uint64_t>() + found["culled"].get<std::uint64_t>();
      EXPECT_EQ(accounted, segments);
      EXPECT_GE(found["frames"], 3);
      EXPECT_GT(found["segments_per_s"], 0);
      EXPECT_GE(found["frame_ms_p95"], found["frame_ms_p50"]);
      const bool smoothed = std::string{method} == "hybrid"; // outlines, which quads' are not
      EXPECT_LE(found["mean_abs_diff_to_quads"], std::string{method}.starts_with("tubes") ? 20
                                                 : smoothed                               ? 8
                                                                                          : 2);
      EXPECT_GE(found["mean_abs_diff_to_supersampled"], 0);
      // In the other views of so small a tree, lines of the least width decide.
      if (smoothed && std::string{view} == "whole") {
        EXPECT_LT(found["mean_abs_diff_to_supersampled"],
                  report["views"][view]["quads-cpu"]["mean_abs_diff_to_supersampled"]);
      }
      EXPECT_TRUE(std::filesystem::exists(dump + '/' + view + '_' + method + ".png"));
    }
    EXPECT_EQ(report["views"][view]["quads-brute-force"]["drawn"], segments);
    EXPECT_EQ(report["views"][view]["quads-brute-force"]["mean_abs_diff_to_quads"], 0);
  }
}

TEST_F(VesselPictures, are_compared_along_a_flight) {
  const ProgramResult flown = run_well({"vessels", "bench", tree_, "--json", "--size", "160x90",
                                        "--seconds", "0.01", "--no-build", "--views", "close",
                                        "--methods", "hybrid", "--fly-through", "--places", "9"});
  const json flight = json::parse(flown.out)["fly_through"];
  EXPECT_EQ(flight["places"], 9);
  EXPECT_GT(flight["length_mm"], 80);
  EXPECT_GT(flight["frame_ms_p50"], 0);
  EXPECT_GE(flight["frame_ms_p95"], flight["frame_ms_p50"]);
  EXPECT_LE(flight["mean_abs_diff_to_quads_max"], 10) << "smooth outlines beside stairs";
  EXPECT_LT(flight["frame_to_frame_max"], flight["quads_frame_to_frame_max"]) << "calmer";
  EXPECT_GT(flight["frame_to_frame_max"], 0.1);
  EXPECT_GT(flight["quads_frame_to_frame_max"], 0.1);
  EXPECT_LE(flight["frame_to_frame_beyond_quads_max"], 0.5);
  EXPECT_THAT(flown.err, HasSubstr("flight 9 of 9: target"));
  EXPECT_THAT(flown.err, HasSubstr("mm, 0.0040"));
  const ProgramResult still =
      run_well({"vessels", "bench", tree_, "--json", "--size", "160x90", "--seconds", "0.01",
                "--no-build", "--views", "close", "--methods", "hybrid"});
  EXPECT_FALSE(json::parse(still.out).contains("fly_through"));
  const ProgramResult help = run_octascope({"vessels", "bench", "--help"});
  EXPECT_THAT(help.out, HasSubstr("--fly-through"));
}

TEST(BenchVessels, grows_its_own_tree) {
  const ProgramResult measured =
      run_well({"bench", "vessels", "--segments", "2000", "--json", "--size", "160x90", "--seconds",
                "0.01", "--views", "whole", "--methods", "hybrid,quads-cpu"});
  const json report = json::parse(measured.out);
  EXPECT_EQ(report["segments"], 2000);
  EXPECT_TRUE(report["load_ms"].is_null());
  EXPECT_GT(report["build_ms"], 0);
  EXPECT_EQ(report["views"].size(), 1U);
  EXPECT_EQ(report["views"]["whole"].size(), 2U);
  EXPECT_THAT(measured.err, HasSubstr("whole  hybrid"));
}

} // namespace
} // namespace octascope::tests

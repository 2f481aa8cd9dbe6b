// octascope render as a user runs it: each option changes the picture as it says.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/files/nrrd.h"
#include "tests/program/program_support.h"
#include "tests/support/files/mutation.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// A bright ball in the middle and a dimmer slab under it, in a box that no two edges share.
pipeline::NrrdVolume ball_over_slab() {
  const pipeline::VolumeGeometry geometry{48, 40, 32, 30, 40, 50};
  std::vector<float> levels;
  for (int b = 0; b < geometry.b_scans; ++b)
    for (int a = 0; a < geometry.a_scans; ++a)
      for (int z = 0; z < geometry.depths; ++z) {
        const int square = (b - 16) * (b - 16) + (a - 20) * (a - 20) + (z - 20) * (z - 20);
        levels.push_back(square < 64 ? 50.0F : z > 40 ? 30.0F : 0.0F);
      }
  return {geometry, levels};
}

class Render : public testing::Test {
protected:
  void SetUp() override {
    ASSERT_TRUE(pipeline::write_nrrd(folder_ / "volume.nrrd", ball_over_slab()));
  }

  pipeline::Image render(std::vector<std::string> more) {
    std::vector<std::string> words{"render", "--volume", folder_ / "volume.nrrd", "--out",
                                   folder_ / "out.png"};
    if (std::ranges::find(more, "--size") == more.end())
      words.insert(words.end(), {"--size", "200x120"});
    if (std::ranges::find(more, "--window") == more.end())
      words.insert(words.end(), {"--window", "10,40"});
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = run_well(words, 60s);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "");
    return read_snapshot(folder_ / "out.png");
  }

  // Pixels of the picture's upper part, where there is no scale bar, that are not background.
  static int drawn(const pipeline::Image& picture) {
    const ui::Rect upper{0, 0, picture.width, picture.height * 3 / 4};
    return upper.width * upper.height - count_colour(picture, upper, ui::palette::background, 6);
  }

  static int different(const pipeline::Image& a, const pipeline::Image& b) {
    return count_different(a, b, {0, 0, a.width, a.height}, 12);
  }

  ScratchFolder folder_;
};

TEST_F(Render, draws_every_technique_in_the_middle) {
  for (const ui::Technique technique : ui::all_techniques) {
    const pipeline::Image picture = render({"--technique", std::string{to_string(technique)}});
    ASSERT_EQ(picture.width, 200);
    ASSERT_EQ(picture.height, 120);
    const auto middle = picture.pixel(100, 60);
    EXPECT_GT(int{middle[0]}, 40) << to_string(technique);
    EXPECT_EQ(count_colour(picture, {190, 0, 10, 120}, ui::palette::background, 2), 1200)
        << to_string(technique);
  }
}

TEST_F(Render, looks_from_where_it_is_told) {
  const pipeline::Image first = render({});
  EXPECT_GT(different(first, render({"--yaw", "-50"})), 200);
  EXPECT_GT(different(first, render({"--tilt", "-20"})), 200);
  EXPECT_GT(drawn(render({"--distance", "2"})), drawn(first) * 3 / 2);
}

// The slab is at 30 dB: gone where the window begins above it.
TEST_F(Render, takes_the_window_that_it_is_told) {
  const int with_slab = drawn(render({"--window", "10,40"}));
  const int without = drawn(render({"--window", "35,10"}));
  EXPECT_LT(without, with_slab);
  EXPECT_GT(without, 100);
}

TEST_F(Render, draws_the_scale_always_and_the_box_on_request) {
  const pipeline::Image plain = render({});
  const pipeline::Image boxed = render({"--box"});
  EXPECT_GT(count_colour(plain, {0, 90, 60, 30}, ui::palette::text, 40), 10);
  const ui::Rect all{0, 0, plain.width, plain.height};
  EXPECT_GT(count_colour(boxed, all, ui::palette::box, 25),
            count_colour(plain, all, ui::palette::box, 25) + 50);
}

TEST_F(Render, colours_and_transfer_functions_by_name) {
  const pipeline::Image grey = render({});
  const pipeline::Image amber = render({"--colours", "amber"});
  const auto middle = amber.pixel(100, 60);
  EXPECT_GT(int{middle[0]}, int{middle[2]} + 30);
  EXPECT_GT(different(grey, render({"--transfer", "surface"})), 30);
  EXPECT_GT(different(grey, render({"--opacity", "0.02"})), 100);
}

TEST_F(Render, takes_the_look_of_a_configuration_and_the_command_line_over_it) {
  const std::string file = folder_.write("look.toml", R"([display]
technique = "maximum"
colours = "amber"
transfer = "mine"
[[transfer]]
name = "mine"
kind = "piecewise"
points = [[0, 0], [0.5, 0], [1, 1]]
)");
  EXPECT_EQ(render({"--config", file}), render({"--config", file, "--technique", "maximum",
                                                "--transfer", "mine", "--colours", "amber"}));
  EXPECT_GT(different(render({"--config", file}),
                      render({"--config", file, "--technique", "rays", "--colours", "grey"})),
            100);
}

TEST_F(Render, gives_each_eye_its_own_half) {
  const pipeline::Image two =
      render({"--stereo", "side-by-side", "--size", "400x120", "--parallax", "8"});
  pipeline::Image left{200, 120, 3};
  pipeline::Image right{200, 120, 3};
  for (int y = 0; y < 120; ++y) {
    const auto row = two.pixels.begin() + y * 1200;
    std::copy_n(row, 600, left.pixels.begin() + y * 600);
    std::copy_n(row + 600, 600, right.pixels.begin() + y * 600);
  }
  EXPECT_GT(drawn(left), 200);
  EXPECT_NEAR(drawn(left), drawn(right), drawn(left) / 5);
  EXPECT_GT(different(left, right), 50);
}

TEST_F(Render, casts_rays_with_the_processor_or_with_gl_as_told) {
  const pipeline::Image by_processor = render({"--drawn-by", "processor"});
  const pipeline::Image by_gl = render({"--drawn-by", "gl"});
  EXPECT_LT(different(by_processor, by_gl), 200 * 120 / 100);
}

TEST_F(Render, samples_as_finely_as_told) {
  EXPECT_GT(different(render({"--steps", "8"}), render({"--steps", "512"})), 200);
}

// The volume as another program would write it, with these fields instead of ours.
std::string with_fields(const std::string& volume, const std::string& fields) {
  const std::size_t begin = volume.find("space:");
  return volume.substr(0, begin) + fields + volume.substr(volume.find("kinds:"));
}

TEST_F(Render, draws_the_same_of_any_header_that_says_the_same) {
  const std::string ours = whole_file(folder_ / "volume.nrrd");
  const pipeline::Image expected = render({"--box"});
  const std::string again = folder_ / "again.nrrd";
  for (const char* fields : {"spacings: 0.03 0.04 0.05\nunits: \"mm\" \"mm\" \"mm\"\n",
                             "spacings: 30 40 50\nunits: \"um\" \"um\" \"um\"\n",
                             "space: RAS\nspace units: \"m\" \"m\" \"m\"\n"
                             "space directions: (-3e-5,0,0) (0,-4e-5,0) (0,0,5e-5)\n"}) {
    folder_.write("again.nrrd", with_fields(ours, fields));
    const ProgramResult result =
        run_well({"render", "--volume", again, "--out", folder_ / "again.png", "--size", "200x120",
                  "--window", "10,40", "--box"});
    EXPECT_EQ(result.err, "") << fields;
    EXPECT_EQ(read_snapshot(folder_ / "again.png"), expected) << fields;
  }
  folder_.write("again.nrrd", with_fields(ours, ""));
  EXPECT_THAT(run_well({"render", "--volume", again, "--out", folder_ / "again.png"}).err,
              HasSubstr("1 mm is assumed for all three axes"));
}

TEST_F(Render, says_when_values_are_no_decibels) {
  pipeline::NrrdVolume bright{{4, 3, 2, 30, 40, 50}, std::vector<float>(24, 30000)};
  std::get<std::vector<float>>(bright.levels)[5] = std::nanf("");
  ASSERT_TRUE(pipeline::write_nrrd(folder_ / "bright.nrrd", bright));
  const ProgramResult result =
      run_well({"render", "--volume", folder_ / "bright.nrrd", "--out", folder_ / "out.png"});
  EXPECT_THAT(result.err, HasSubstr("1 of its 24 values are NaN"));
  EXPECT_THAT(result.err, HasSubstr("23 of its 24 values are not within -40 to 87.5 dB"));
}

// Counts of 10 bits are the same in 16, shifted or not; those of 8 in bytes.
TEST_F(Render, takes_spectra_of_every_integer_type) {
  std::vector<std::uint16_t> counts;
  std::vector<std::uint16_t> shifted;
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 8 * 9 * 64; ++i) {
    const int count = 100 + (i * i / 7 + 13 * i) % 150;
    counts.push_back(static_cast<std::uint16_t>(count));
    shifted.push_back(static_cast<std::uint16_t>(count << 6));
    bytes.push_back(static_cast<std::uint8_t>(count));
  }
  folder_.write_values<std::uint16_t>("16.raw", counts);
  folder_.write_values<std::uint16_t>("left.raw", shifted);
  folder_.write_values<std::uint8_t>("8.raw", bytes);
  const auto draw = [&](const char* spectra, std::vector<std::string> more) {
    std::vector<std::string> words{
        "render", "--spectra", folder_ / spectra, "--shape", "8,9,64", "--out", folder_ / "out.png",
        "--size", "160x90",    "--window",        "-10,40"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_THAT(run_well(words).err, HasSubstr("spacings are assumed, not measured: depth"));
    return read_snapshot(folder_ / "out.png");
  };
  const pipeline::Image expected = draw("16.raw", {});
  EXPECT_EQ(draw("16.raw", {"--dtype", "u10"}), expected);
  EXPECT_EQ(draw("16.raw", {"--dtype", "u14"}), expected);
  EXPECT_EQ(draw("left.raw", {"--dtype", "u10", "--shift", "6"}), expected);
  EXPECT_EQ(draw("left.raw", {"--shift", "6"}), expected);
  EXPECT_EQ(draw("8.raw", {"--dtype", "u8"}), expected);
}

TEST_F(Render, draws_the_smallest_picture) {
  EXPECT_EQ(render({"--size", "1x1"}).pixels.size(), 3U);
}

} // namespace
} // namespace octascope::tests

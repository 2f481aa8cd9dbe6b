// octascope render as a user runs it: each option changes the picture as it says.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/files/nrrd.h"
#include "tests/program/program_support.h"

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

TEST_F(Render, draws_the_smallest_picture) {
  EXPECT_EQ(render({"--size", "1x1"}).pixels.size(), 3U);
}

} // namespace
} // namespace octascope::tests

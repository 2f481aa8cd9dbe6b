// Every command that draws, in pictures of every size.
#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

class Sizes : public testing::TestWithParam<std::array<int, 2>> {
protected:
  std::string size() const {
    return std::to_string(GetParam()[0]) + 'x' + std::to_string(GetParam()[1]);
  }
  void expect_picture() const {
    const pipeline::Image picture = read_snapshot(folder_ / "picture.png");
    EXPECT_EQ((std::array{picture.width, picture.height}), GetParam());
  }
  void draw(std::vector<std::string> words, const std::string& output) {
    words.insert(words.end(), {"--size", size(), output, folder_ / "picture.png"});
    run_well(std::move(words));
    expect_picture();
    std::filesystem::remove(folder_ / "picture.png");
  }

  ScratchFolder folder_;
};

TEST_P(Sizes, are_drawn_by_every_command) {
  const std::string recording = folder_ / "a.h5";
  const std::string configuration = write_small_configuration(folder_);
  draw({"record", "--sim", "--config", configuration, "--display", "offscreen", "--volumes", "1",
        "--out", recording},
       "--snapshot");
  draw({"run", "--sim", "--config", configuration, "--display", "offscreen", "--volumes", "1"},
       "--snapshot");
  draw({"replay", recording, "--display", "offscreen", "--once"}, "--snapshot");
  draw({"render", "--volume", recording, "--steps", "16"}, "--out");
  draw({"render", "--volume", recording, "--steps", "16", "--technique", "surface", "--stereo",
        "side-by-side"},
       "--out");
  const std::string tree = folder_.write("t.swc", "1 2 0 0 0 1 -1\n2 2 5 1 0 0.5 1\n");
  draw({"vessels", "render", tree}, "--out");
}

INSTANTIATE_TEST_SUITE_P(All, Sizes,
                         testing::Values(std::array{1, 1}, std::array{320, 1000},
                                         std::array{320, 180}, std::array{17, 31},
                                         std::array{3000, 1}, std::array{1, 3000}),
                         [](const auto& test) {
                           return std::to_string(test.param[0]) + 'x' +
                                  std::to_string(test.param[1]);
                         });

} // namespace
} // namespace octascope::tests

// Every technique's picture of every phantom and of real tissue, against pictures kept in
// tests/golden/techniques; and the same rays cast by the processor and by a shader.
#include <array>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "firmware-host/commands/volume/render.h"
#include "firmware-host/run/volume_source.h"
#include "tests/support/files/test_data.h"
#include "tests/support/files/tissue_calibration.h"
#include "tests/ui/support/golden.h"
#include "tests/ui/support/picture_file.h"
#include "tests/ui/support/structural_similarity.h"

namespace octascope::tests {
namespace {

using firmware_host::RenderOptions;

constexpr const char* tissue_spectra = "sd-oct-tissue/spectra_u16_100x100x1024.raw";

firmware_host::VolumeRequest request_for(const std::string& scene,
                                         const TissueCalibration& calibration) {
  firmware_host::VolumeRequest request;
  if (scene != "tissue") {
    request.phantom = scene;
    return request;
  }
  request.recording = {test_data_folder() / tissue_spectra, {100, 100, 1024}};
  request.calibration = calibration.file();
  return request;
}

// Nearly what the automatic windows are; those move by a step when a few voxels differ by a count,
// as they do between processors, and an iso-surface with them.
ui::DisplayWindow window_for(const std::string& scene) {
  if (scene == "anterior_eye")
    return {-10, 23};
  if (scene == "nail_fold")
    return {-10, 38};
  if (scene == "cap")
    return {-11, 29};
  return {-17.5F, 31};
}

// The scale's letters are the display's own, of which there are several versions.
pipeline::Image without_scale(pipeline::Image picture) {
  for (int y = picture.height * 5 / 6; y < picture.height; ++y)
    for (int x = 0; x < picture.width / 2; ++x)
      for (int channel = 0; channel < 3; ++channel)
        picture.pixels[static_cast<std::size_t>((y * picture.width + x) * 3 + channel)] = 0;
  return picture;
}

class TechniquePictures : public testing::TestWithParam<std::string> {
protected:
  void SetUp() override {
    if (GetParam() == "tissue")
      OCTASCOPE_REQUIRE_TEST_DATA(tissue_spectra);
    auto loaded = firmware_host::load_volume(request_for(GetParam(), TissueCalibration{}));
    ASSERT_TRUE(loaded) << loaded.error().message;
    volume_ = std::move(loaded->volume);
  }

  pipeline::Image render(const RenderOptions& options) const {
    auto picture = firmware_host::render_volume(volume_, options);
    EXPECT_TRUE(picture) << picture.error().message;
    return picture ? std::move(*picture) : pipeline::Image{};
  }

  static RenderOptions options_for(ui::Technique technique, int width, int height) {
    RenderOptions options;
    options.view.technique = technique;
    options.view.box_visible = false;
    options.window = window_for(GetParam());
    options.width = width;
    options.height = height;
    return options;
  }

private:
  pipeline::Volume volume_;
};

TEST_P(TechniquePictures, are_as_kept) {
  for (const auto& [width, height] : {std::array{320, 180}, std::array{160, 120}}) {
    for (const ui::Technique technique : ui::all_techniques) {
      const std::string name =
          fmt::format("techniques/{}_{}_{}x{}", GetParam(), to_string(technique), width, height);
      SCOPED_TRACE(name);
      expect_golden(without_scale(render(options_for(technique, width, height))), name,
                    golden_similarity);
    }
  }
}

TEST_P(TechniquePictures, are_the_same_cast_by_the_processor_and_by_a_shader) {
  for (const ui::Technique technique :
       {ui::Technique::rays, ui::Technique::shaded, ui::Technique::maximum}) {
    RenderOptions options = options_for(technique, 320, 180);
    options.quality.rays = ui::RayBackend::processor;
    const pipeline::Image by_processor = render(options);
    options.quality.rays = ui::RayBackend::shader;
    const pipeline::Image by_shader = render(options);
    ASSERT_FALSE(by_processor.pixels.empty());
    EXPECT_LE(compare(by_processor, by_shader).mean, 1) << to_string(technique);
    EXPECT_GE(structural_similarity(by_processor, by_shader), golden_similarity)
        << to_string(technique);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, TechniquePictures,
                         testing::Values("anterior_eye", "nail_fold", "cap", "tissue"),
                         [](const auto& test) { return test.param; });

} // namespace
} // namespace octascope::tests

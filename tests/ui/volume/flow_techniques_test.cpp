// Flow by every way of drawing the volume, against the others; shown and hidden by the painter.
#include <optional>
#include <string>

#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/golden.h"
#include "tests/ui/support/renderer_stage.h"
#include "tests/ui/support/view_places.h"
#include "tests/ui/support/volume_stage.h"
#include "ui/view/plane_box.h"

namespace octascope::tests {
namespace {

using ui::Technique;

pipeline::Volume with_tubes(const pipeline::VolumeGeometry& geometry) {
  pipeline::Volume volume = tissue_volume(geometry);
  add_tubes(volume);
  return volume;
}

class FlowTechniques : public GlTest {
protected:
  void SetUp() override {
    GlTest::SetUp();
    if (!IsSkipped())
      stage_.emplace();
  }
  void TearDown() override { stage_.reset(); }

  static StageSettings steps(const pipeline::VolumeGeometry& geometry, float count) {
    StageSettings settings;
    settings.step_mm = static_cast<float>(geometry.a_mm()) / count;
    settings.flow = true;
    return settings;
  }

  static ui::ViewState view_of(Technique technique, const Place& place) {
    ui::ViewState view = view_from(place, 0.05F);
    view.technique = technique;
    return view;
  }

  std::optional<VolumeStage> stage_;
};

double redness(const StagePicture& picture) {
  double sum = 0;
  for (const auto& pixel : picture.pixels)
    sum += static_cast<double>(pixel.red - pixel.blue);
  return 255 * sum / static_cast<double>(picture.pixels.size());
}

TEST_F(FlowTechniques, processor_and_shader_cast_the_same_rays) {
  stage_->show(with_tubes(small_geometry));
  const StageSettings settings = steps(small_geometry, 400);
  const auto mode_of = [](Technique technique) {
    return technique == Technique::shaded    ? ui::RayMode::shaded
           : technique == Technique::maximum ? ui::RayMode::maximum
                                             : ui::RayMode::composite;
  };
  for (const Technique technique : {Technique::rays, Technique::shaded, Technique::maximum})
    for (const Place& place : places) {
      const ui::ViewState view = view_of(technique, place);
      const StagePicture processor = stage_->cast(view, mode_of(technique), settings);
      EXPECT_GT(redness(processor), 1) << ui::to_string(technique) << ' ' << place.name;
      EXPECT_LE(mean_difference(stage_->draw(view, settings), processor), 1)
          << ui::to_string(technique) << ' ' << place.name;
    }
}

TEST_F(FlowTechniques, planes_show_what_rays_do) {
  stage_->show(with_tubes(small_geometry));
  const StageSettings settings = steps(small_geometry, 1000);
  for (const Place& place : places)
    EXPECT_LE(mean_difference(stage_->draw(view_of(Technique::planes, place), settings),
                              stage_->draw(view_of(Technique::rays, place), settings)),
              2)
        << place.name;
}

TEST_F(FlowTechniques, slices_show_what_rays_do_in_a_fine_volume) {
  const pipeline::VolumeGeometry fine{90, 150, 150, 20, 20, 20};
  stage_->show(with_tubes(fine));
  const StageSettings settings = steps(fine, 300);
  for (const Place& place : places)
    EXPECT_LE(mean_difference(stage_->draw(view_of(Technique::slices, place), settings),
                              stage_->draw(view_of(Technique::rays, place), settings)),
              4)
        << place.name;
}

class ShownFlow : public RendererTest {
protected:
  struct Drawn {
    pipeline::Image image;
    int coloured = 0;
  };

  // By a renderer that knows nothing of what was there before, or by that one.
  Drawn alone(const pipeline::Volume& volume, const ui::ViewState& view, const ui::DrawQuality& how,
              ui::Renderer* by = nullptr) {
    std::unique_ptr<ui::Renderer> made;
    if (by == nullptr) {
      made = std::move(*ui::Renderer::create());
      by = made.get();
      EXPECT_TRUE(by->show_volume(volume));
    }
    EXPECT_TRUE(by->prepare(volume, view, how));
    const auto drawn = by->draw_volume_alone(view, width_, height_, how);
    EXPECT_TRUE(drawn) << drawn.error().message;
    Drawn result{by->read_back(width_, height_)};
    const auto& pixels = result.image.pixels;
    const auto channels = static_cast<std::size_t>(result.image.channels);
    for (std::size_t i = 0; i + 2 < pixels.size(); i += channels)
      result.coloured += pixels[i] > pixels[i + 2] + 40 ? 1 : 0;
    return result;
  }
};

constexpr ui::DrawQuality by_processor{0.5F, 192, ui::RayBackend::processor};
constexpr ui::DrawQuality by_shader{0.5F, 96, ui::RayBackend::shader};

TEST_F(ShownFlow, is_there_or_not_by_every_technique_as_the_view_says) {
  const pipeline::Volume volume = with_tubes(small_geometry);
  const pipeline::Volume plain = tissue_volume(small_geometry);
  for (const Technique technique : ui::all_techniques)
    for (const ui::DrawQuality& how : {by_processor, by_shader})
      for (const ui::CutShape cut : {ui::CutShape::none, ui::CutShape::b_scan}) {
        ui::ViewState view;
        view.technique = technique;
        view.cut = cut;
        view.b_scan = 18;
        const std::string what = std::string{ui::to_string(technique)} +
                                 (how == by_processor ? " processor" : " shader") +
                                 (cut == ui::CutShape::none ? "" : " cut");
        view.vessels = ui::VesselsShown::flow;
        auto renderer = std::move(*ui::Renderer::create());
        ASSERT_TRUE(renderer->show_volume(volume));
        EXPECT_GT(alone(volume, view, how, renderer.get()).coloured, 100) << what;
        view.vessels = ui::VesselsShown::tree;
        const Drawn hidden = alone(volume, view, how, renderer.get());
        const Drawn never = alone(plain, view, how);
        EXPECT_EQ(changed(hidden.image, never.image, {0, 0, width_, height_}), 0) << what;
        view.vessels = ui::VesselsShown::both; // of a volume without, the same
        EXPECT_EQ(changed(alone(plain, view, how).image, never.image, {0, 0, width_, height_}), 0)
            << what;
        EXPECT_GT(alone(volume, view, how, renderer.get()).coloured, 100) << what << ", again";
      }
}

class GoldenFlow : public ShownFlow {};

TEST_F(GoldenFlow, pictures_are_as_kept) {
  const pipeline::Volume volume = with_tubes(full_geometry);
  ui::ViewState view;
  for (const Technique technique : {Technique::rays, Technique::maximum, Technique::surface}) {
    view.technique = technique;
    expect_golden(alone(volume, view, {1, 512, ui::RayBackend::processor}).image,
                  "flow_" + std::string{ui::to_string(technique)} + "_640x360");
  }
}

// Parts of the volume are completed from frame to frame, as the render loop does.
TEST_F(ShownFlow, is_completed_for_what_the_view_comes_to_need) {
  const pipeline::Volume volume = with_tubes(small_geometry);
  ASSERT_TRUE(renderer_->show_volume(volume));
  ui::ViewState view;
  view.zoom_to_tissue = false;
  const auto completed = [&](const ui::DrawQuality& how) {
    EXPECT_TRUE(renderer_->complete(volume, view, how));
    const auto drawn = renderer_->draw(view, live_status(), width_, height_, how);
    EXPECT_TRUE(drawn) << drawn.error().message;
    return renderer_->read_back(width_, height_);
  };
  const auto fresh = [&](const ui::DrawQuality& how) {
    auto other = std::move(*ui::Renderer::create());
    other->expect(view);
    EXPECT_TRUE(other->show_volume(volume));
    EXPECT_TRUE(other->draw(view, live_status(), width_, height_, how));
    return other->read_back(width_, height_);
  };
  const auto expect_the_same = [&](const ui::DrawQuality& how, int step) {
    EXPECT_EQ(changed(completed(how), fresh(how), {0, 0, width_, height_}), 0) << step;
  };
  view.vessels = ui::VesselsShown::off;
  expect_the_same(by_processor, 0);
  view.vessels = ui::VesselsShown::flow;
  expect_the_same(by_processor, 1);
  view.cut = ui::CutShape::b_scan;
  view.b_scan = 9;
  expect_the_same(by_processor, 2);
  view.b_scan = 25;
  expect_the_same(by_processor, 3);
  view.technique = Technique::planes;
  expect_the_same(by_processor, 4);
  view.technique = Technique::rays;
  view.cut = ui::CutShape::none;
  expect_the_same(by_shader, 5);
}

} // namespace
} // namespace octascope::tests

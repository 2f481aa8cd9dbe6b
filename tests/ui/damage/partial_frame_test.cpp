// What is drawn over in part is, pixel by pixel, what is drawn as a whole.
#include <array>
#include <string_view>
#include <vector>

#include <GLES3/gl3.h>

#include "tests/support/allocation_counter.h"
#include "tests/ui/support/mixed_volume.h"
#include "tests/ui/support/renderer_stage.h"
#include "tests/ui/support/vessels/vessel_along.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_texture.h"

namespace octascope::tests {
namespace {

using pipeline::BScanRange;
using pipeline::BScanState;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ui::Technique;

// Two renderers are given the same. One draws into the buffers of a display in turn, each of which
// holds an older image; the other draws all of every image.
class PartialFrame : public RendererTest {
protected:
  static constexpr std::size_t most_buffers = 3;

  void SetUp() override {
    open_renderer(1000, 562); // whole tiles neither way
    if (IsSkipped())
      return;
    auto made = ui::Renderer::create();
    ASSERT_TRUE(made);
    whole_ = std::move(*made);
    make_buffers(1000, 562);
    view_.zoom_to_tissue = false; // which remembers what was there
    view_.b_scan = 11;
  }
  void TearDown() override {
    whole_.reset();
    RendererTest::TearDown();
  }

  template <class Do> void for_both(const Do& act) {
    act(*renderer_);
    act(*whole_);
  }

  void show_all() {
    for_both([&](ui::Renderer& renderer) {
      renderer.expect(view_);
      ASSERT_TRUE(renderer.show_volume(mixed_.volume()));
      ASSERT_TRUE(
          renderer.prepare(mixed_.volume(), view_, quality_)); // on a GPU, for the processor's rays
      renderer.show_levels(level_shares(mixed_.volume()));
      ASSERT_TRUE(renderer.show_scope_picture(scope_.frame(status_.now), scope_.field()));
    });
  }

  // B-scans of the newer volume, and the seam behind them.
  void renew(int from, int to, BScanState state = BScanState::good) {
    const std::array changed{mixed_.renew(from, to, state)};
    for_both([&](ui::Renderer& renderer) {
      ASSERT_TRUE(renderer.renew_volume(mixed_.volume(), changed));
    });
  }

  // Of a volume of which it is given no more than is drawn.
  pipeline::Image draw_in_part(const hal::BackBuffer& buffer) {
    EXPECT_TRUE(renderer_->complete(mixed_.volume(), view_, quality_));
    const auto drawn = renderer_->draw(view_, status_, width_, height_, quality_, buffer);
    EXPECT_TRUE(drawn) << drawn.error().message;
    return renderer_->read_back(width_, height_);
  }

  // The next image, both ways.
  void compare(std::string_view what, bool handed_over = true) {
    const std::size_t at = image_ % buffers_;
    bind(at);
    const pipeline::Image in_part = draw_in_part({image_, held_[at]});
    bind(most_buffers);
    EXPECT_TRUE(whole_->prepare(mixed_.volume(), view_, quality_));
    const auto drawn = whole_->draw(view_, status_, width_, height_, quality_);
    ASSERT_TRUE(drawn) << drawn.error().message;
    const pipeline::Image all = whole_->read_back(width_, height_);
    EXPECT_EQ(changed(in_part, all, {0, 0, width_, height_}), 0)
        << what << ", " << buffers_ << " buffers";
    if (!handed_over)
      return;
    held_[at] = image_;
    ++image_;
  }

  // The share of the next image that is drawn; what was in the buffer is lost.
  double drawn_share() {
    constexpr ui::Colour never{255, 0, 255, 255};
    glClearColor(1, 0, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const pipeline::Image image = draw_in_part({image_, image_ - 1});
    ++image_;
    const ui::Rect all{0, 0, width_, height_};
    return 1 - static_cast<double>(count_colour(image, all, never)) / (width_ * height_);
  }

  // The last is for images drawn as a whole.
  void bind(std::size_t buffer) { glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[buffer].name()); }
  void make_buffers(int width, int height) {
    for (std::size_t i = 0; i <= most_buffers; ++i) {
      framebuffers_[i] = ui::gl::Framebuffer::make();
      colours_[i] = ui::gl::make_picture_texture(GL_RGBA8, width, height);
      bind(i);
      glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                             colours_[i].name(), 0);
    }
    held_ = {};
    width_ = width;
    height_ = height;
  }

  ui::ViewState view_;
  ui::Status status_ = live_status();
  ui::DrawQuality quality_{0.6F, 96, ui::RayBackend::processor}; // softened, and magnified
  const ScopePicture scope_{320, 240};
  std::unique_ptr<ui::Renderer> whole_;
  const pipeline::ClusterArrays along_ =
      vessel_along({{0.1F, 0.4F, 0.5F}, {0.9F, 0.4F, 0.6F}}, 0.05F);
  const pipeline::ClusterArrays across_ =
      vessel_along({{0.4F, 0.1F, 0.5F}, {0.5F, 0.9F, 0.7F}}, 0.04F);
  std::size_t buffers_ = 1;
  std::uint64_t image_ = 1;
  std::array<std::uint64_t, most_buffers> held_{};
  MixedVolume mixed_;

private:
  std::array<ui::gl::Framebuffer, most_buffers + 1> framebuffers_;
  std::array<ui::gl::Texture, most_buffers + 1> colours_;
};

class EveryChange : public PartialFrame, public testing::WithParamInterface<std::size_t> {};

TEST_P(EveryChange, gives_the_picture_of_a_full_drawing) {
  buffers_ = GetParam();
  compare("nothing to show");
  show_all();
  compare("a volume");
  compare("nothing");
  // One thing at a time, then all of them once more, so that each meets other buffers.
  for (int round = 0; round < 2; ++round) {
    for (const auto& [from, to] : {BScanRange{0, 3}, {3, 4}, {4, 17}, {17, 30}}) {
      renew(from, to);
      status_.now += milliseconds{30};
      compare("B-scans");
    }
    renew(0, 5);
    renew(5, 8);
    compare("B-scans twice before a drawing");
    for (const ui::Liveness liveness :
         {ui::Liveness::stale, ui::Liveness::veiled, ui::Liveness::frozen, ui::Liveness::live}) {
      status_.freshness = {liveness, seconds{3}, seconds{2}};
      compare("liveness");
      status_.freshness.age += seconds{1};
      compare("an age");
    }
    status_.time_of_day = round == 0 ? "09:59" : "10:00";
    compare("the time of day");
    status_.simulated = !status_.simulated;
    compare("a badge");
    status_.notice = round == 0 ? "A microscope camera is gone" : "";
    compare("a notice");
    for (const ui::Action action : {ui::Action::tilt, ui::Action::window_size}) {
      view_.echo = {action, true, {}, status_.now + seconds{1}};
      view_.selected = action;
      compare("what the knob turns");
      view_.window_size_db += 2;
      view_.tilt_deg -= 3;
      compare("the knob");
    }
    view_.echo = {};
    compare("the knob at rest");
    view_.yaw_deg += 15;
    compare("a turn");
    view_.legend_visible = true;
    compare("the legend");
    view_.legend_visible = false;
    view_.figures = ui::FiguresShown::strip;
    compare("the engineer's strip");
    status_.frames_per_s += 3;
    compare("a figure");
    view_.figures = ui::FiguresShown::none;
    view_.b_scan += 4;
    compare("another B-scan");
    view_.a_scan += 9;
    compare("another A-scan");
    view_.box_visible = !view_.box_visible;
    compare("the box");
    view_.calliper = !view_.calliper;
    compare("the calliper");
    for (const ui::LayoutKind layout : {ui::LayoutKind::quad, ui::LayoutKind::b_scan,
                                        ui::LayoutKind::microscope, ui::LayoutKind::volume}) {
      view_.layout = layout;
      compare("a layout");
      renew(2, 9);
      compare("B-scans in it");
    }
    for (const Technique technique : {Technique::maximum, Technique::planes, Technique::shaded,
                                      Technique::slices, Technique::rays}) {
      view_.technique = technique;
      show_all();
      compare("a technique");
      renew(1, 6);
      compare("B-scans of it");
    }
    quality_.resolution = round == 0 ? 1.0F : 0.6F;
    compare("a quality");
    for (const ui::CutShape cut : {ui::CutShape::b_scan, ui::CutShape::corner}) {
      view_.cut = cut;
      compare("a cut");
      renew(9, 14);
      compare("B-scans in a cut");
      view_.a_scan += 3;
      compare("an A-scan in a cut");
    }
    view_.cut = ui::CutShape::none;
    compare("no cut");
    for (const BScanState state : {BScanState::missing, BScanState::saturated, BScanState::good}) {
      renew(6, 12, state);
      compare("B-scans that are missing");
    }
    view_.window_offset_db += 3;
    compare("a window");
    view_.opacity += 0.1F;
    compare("an opacity");
    view_.see_through_db = 4;
    compare("a cover");
    status_.now += seconds{20};
    compare("an old microscope picture");
    quality_.rays = round == 0 ? ui::RayBackend::shader : ui::RayBackend::processor;
    compare("another ray caster");
    renew(3, 8);
    compare("B-scans of it");
    for_both([&](ui::Renderer& renderer) { renderer.forget_scope_picture(); });
    compare("no microscope picture");
    view_.stereo = ui::StereoMode::side_by_side;
    compare("stereo");
    view_.stereo = ui::StereoMode::off;
    show_all();
    compare("all of it");
    mixed_.become(round == 0 ? mixed_.newer() : mixed_.older());
    show_all();
    compare("a whole volume");
  }
}

TEST_P(EveryChange, with_flow_gives_the_picture_of_a_full_drawing) {
  buffers_ = GetParam();
  mixed_ = MixedVolume{true};
  show_all();
  compare("a volume with flow");
  for (int round = 0; round < 2; ++round) {
    for (const ui::VesselsShown shown : {ui::VesselsShown::off, ui::VesselsShown::flow}) {
      view_.vessels = shown;
      compare("flow, or none");
      for (const auto& [from, to] : {BScanRange{0, 3}, {3, 7}, {7, 17}, {17, 30}}) {
        renew(from, to);
        compare("B-scans");
      }
      view_.b_scan = 5; // could not be told
      compare("another B-scan");
      view_.a_scan += 9;
      compare("another A-scan");
      for (const ui::Liveness liveness : {ui::Liveness::stale, ui::Liveness::live}) {
        status_.freshness.liveness = liveness;
        compare("liveness");
      }
      for (const ui::LayoutKind layout :
           {ui::LayoutKind::b_scan, ui::LayoutKind::microscope, ui::LayoutKind::volume}) {
        view_.layout = layout;
        compare("a layout");
        renew(2, 9);
        compare("B-scans in it");
      }
      renew(4, 12, BScanState::missing);
      compare("B-scans that are missing");
      status_.now += seconds{20};
      compare("an old microscope picture");
      show_all();
      compare("all of it");
      view_.b_scan = 11;
    }
    mixed_.become(round == 0 ? mixed_.newer() : mixed_.older());
    show_all();
    compare("a whole volume");
  }
  mixed_ = MixedVolume{};
  show_all();
  compare("a volume without flow");
}

TEST_P(EveryChange, with_vessels_gives_the_picture_of_a_full_drawing) {
  buffers_ = GetParam();
  mixed_ = MixedVolume{true};
  view_.layout = ui::LayoutKind::quad;
  show_all();
  compare("no vessels");
  const auto show_tree = [&](const pipeline::ClusterArrays& tree, bool registered) {
    const auto at = registered ? std::optional{pipeline::RigidTransform{}} : std::nullopt;
    for_both([&](ui::Renderer& renderer) {
      ASSERT_TRUE(renderer.show_vessels({tree.view(), {0.5, 0.5, 0.5}, at}, clock_));
    });
  };
  for (int round = 0; round < 2; ++round) {
    for (const ui::VesselsShown shown :
         {ui::VesselsShown::tree, ui::VesselsShown::off, ui::VesselsShown::both}) {
      view_.vessels = shown;
      show_tree(across_, true);
      compare("a tree");
      compare("nothing");
      for (const auto& [from, to] : {BScanRange{0, 3}, {3, 12}, {12, 30}}) {
        renew(from, to);
        compare("B-scans");
      }
      show_tree(along_, true);
      compare("another tree");
      view_.b_scan += 1;
      compare("another B-scan");
      view_.a_scan += 9;
      compare("another A-scan");
      view_.vessel_opacity = round == 0 ? 0.4F : 1.0F;
      compare("an opacity");
      view_.yaw_deg += 15;
      compare("a turn");
      for (const ui::Liveness liveness : {ui::Liveness::stale, ui::Liveness::live}) {
        status_.freshness.liveness = liveness;
        compare("liveness");
      }
      for (const ui::LayoutKind layout : {ui::LayoutKind::b_scan, ui::LayoutKind::microscope,
                                          ui::LayoutKind::volume, ui::LayoutKind::quad}) {
        view_.layout = layout;
        compare("a layout");
        renew(2, 9);
        compare("B-scans in it");
      }
      for (const Technique technique : {Technique::maximum, Technique::planes, Technique::rays}) {
        view_.technique = technique;
        compare("a technique");
        show_tree(across_, true);
        compare("a tree in it");
      }
      view_.stereo = ui::StereoMode::side_by_side;
      compare("stereo");
      view_.stereo = ui::StereoMode::off;
      renew(4, 14, BScanState::missing);
      compare("B-scans that are missing");
      status_.now += seconds{20};
      compare("an old microscope picture");
      show_tree(across_, false);
      compare("a tree without a registration");
      show_tree({}, true);
      compare("no tree");
      show_all();
      compare("all of it");
      view_.b_scan = 11;
    }
  }
}

TEST_P(EveryChange, is_shown_whatever_became_of_images) {
  buffers_ = GetParam();
  show_all();
  for (int i = 0; i < 5; ++i)
    compare("the first images");
  status_.freshness.liveness = ui::Liveness::stale;
  compare("drawn, but not handed over", false);
  status_.simulated = true;
  compare("drawn once more", false);
  status_.freshness.liveness = ui::Liveness::live;
  for (std::size_t i = 0; i <= buffers_; ++i)
    compare("handed over");
  view_.yaw_deg += 5;
  bind(image_ % buffers_);
  draw_in_part({}); // as for a picture to be kept
  for (std::size_t i = 0; i <= buffers_; ++i)
    compare("after an image without a number");
  held_.fill(0);
  view_.yaw_deg += 5;
  for (std::size_t i = 0; i <= buffers_; ++i)
    compare("after the buffers' content was lost");
  ASSERT_TRUE(renderer_->draw_volume_alone(view_, 300, 200));
  status_.simulated = false;
  for (std::size_t i = 0; i <= buffers_; ++i)
    compare("after another kind of picture");
  make_buffers(640, 360);
  for (std::size_t i = 0; i <= buffers_; ++i)
    compare("another size");
}

INSTANTIATE_TEST_SUITE_P(Buffers, EveryChange, testing::Values(1, 2, 3));

TEST_F(PartialFrame, draws_only_what_is_different) {
  show_all();
  bind(0);
  EXPECT_EQ(drawn_share(), 1) << "nothing is known of the first";
  EXPECT_EQ(drawn_share(), 0);
  status_.time_of_day = "23:58";
  EXPECT_GT(drawn_share(), 0);
  status_.time_of_day = "23:59";
  EXPECT_LT(drawn_share(), 0.05);
  renew(20, 21);
  EXPECT_GT(drawn_share(), 0.02);
  renew(21, 22);
  EXPECT_LT(drawn_share(), 0.5);
  ASSERT_TRUE(renderer_->show_vessels({across_.view(), {0.5, 0.5, 0.5}, pipeline::RigidTransform{}},
                                      clock_));
  EXPECT_GT(drawn_share(), 0.02);
  status_.time_of_day = "23:58";
  EXPECT_LT(drawn_share(), 0.05) << "with vessels, too";
}

TEST_F(PartialFrame, allocates_nothing_once_it_runs) {
  mixed_ = MixedVolume{true};
  show_all();
  bind(0);
  std::uint64_t before = 0;
  for (int i = 0; i < 20; ++i) {
    if (i == 8)
      before = allocations_of_this_thread();
    status_.simulated = i % 2 == 0;
    view_.yaw_deg = static_cast<float>(10 * i);
    view_.b_scan = i;
    view_.a_scan = 2 * i;
    view_.vessels = i % 3 == 0 ? ui::VesselsShown::off : ui::VesselsShown::both;
    ASSERT_TRUE(renderer_->complete(mixed_.volume(), view_, quality_));
    ASSERT_TRUE(renderer_->draw(view_, status_, width_, height_, quality_, {image_, image_ - 1}));
    ++image_;
  }
  EXPECT_EQ(allocations_of_this_thread(), before);
}

} // namespace
} // namespace octascope::tests

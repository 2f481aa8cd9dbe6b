// What was brought of a volume before it was whole gives the picture that the whole volume does.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

#include "pipeline/threads/work_team.h"
#include "tests/support/allocation_counter.h"
#include "tests/ui/support/drawing_way.h"
#include "tests/ui/support/mixed_volume.h"
#include "tests/ui/support/renderer_stage.h"
#include "ui/scene/coming_volume.h"

namespace octascope::tests {
namespace {

using ui::Technique;

// A volume of the pipeline while it is made: B-scans that are not finished may hold anything.
class VolumeInTheMaking {
public:
  VolumeInTheMaking(const pipeline::Volume& content, std::uint64_t number)
      : content_{&content}, volume_{content} {
    if (content.has_flow())
      volume_.flow_marks = pipeline::FlowMarks{content.geometry, pipeline::blank_depth_bins};
    begin_again(content, number);
  }

  void finish(int b_scans) {
    for (int b = finished_; b < b_scans; ++b) {
      std::ranges::copy(content_->b_scan(b), volume_.b_scan(b).begin());
      if (content_->has_flow())
        std::ranges::copy(content_->b_scan_flow(b), volume_.b_scan_flow(b).begin());
      update(b);
    }
    finished_ = std::max(finished_, b_scans);
  }
  void finish() { finish(content_->geometry.b_scans); }

  // Its memory is used for another one.
  void begin_again(const pipeline::Volume& content, std::uint64_t number) {
    content_ = &content;
    volume_.metadata.index = number;
    finished_ = 0;
    for (int b = 0; b < content.geometry.b_scans; ++b)
      leave_rubbish(b);
  }

  const pipeline::Volume& volume() const { return volume_; }
  std::uint64_t number() const { return volume_.metadata.index; }
  int finished() const { return finished_; }

private:
  void leave_rubbish(int b) {
    std::ranges::fill(volume_.b_scan(b), static_cast<std::uint8_t>(90 + b * 5));
    if (volume_.has_flow())
      std::ranges::fill(volume_.b_scan_flow(b), std::uint8_t{200});
    update(b);
  }
  void update(int b) {
    volume_.occupancy.update(b, volume_.b_scan(b));
    if (volume_.has_flow())
      volume_.flow_marks.update(b, volume_.b_scan_flow(b));
  }

  const pipeline::Volume* content_;
  pipeline::Volume volume_;
  int finished_ = 0;
};

class BroughtAhead : public RendererTest, public testing::WithParamInterface<DrawingWay> {
protected:
  void SetUp() override {
    RendererTest::SetUp();
    if (GetParam().flow)
      volumes_.add_flow();
    view_.technique = GetParam().technique;
    view_.see_through_db = GetParam().see_through_db;
    view_.zoom_to_tissue = false; // which remembers what was there
  }

  void show(ui::Renderer& renderer, const pipeline::Volume& volume) const {
    renderer.expect(view_);
    ASSERT_TRUE(renderer.show_volume(volume));
    ASSERT_TRUE(
        renderer.prepare(volume, view_, GetParam().quality)); // the processor's rays on a GPU
  }
  void bring(const VolumeInTheMaking& making) {
    renderer_->bring_ahead(making.volume(), making.number(), making.finished(), volumes_.older());
  }
  // While the older one is shown, of one with that content. The first call makes room.
  VolumeInTheMaking& bring_parts(const pipeline::Volume& content, int last = 20) {
    show(*renderer_, volumes_.older());
    VolumeInTheMaking& making = making_.emplace(content, 9);
    for (const int finished : {0, 1, 6, 7, last}) {
      making.finish(finished);
      bring(making);
    }
    return making;
  }

  pipeline::Image picture(ui::Renderer& renderer, const pipeline::Volume& volume) const {
    EXPECT_TRUE(renderer.complete(volume, view_, GetParam().quality));
    const auto drawn = renderer.draw(view_, live_status(), width_, height_, GetParam().quality);
    EXPECT_TRUE(drawn) << drawn.error().message;
    return renderer.read_back(width_, height_);
  }
  void expect_same_as_fresh(const pipeline::Volume& volume) const {
    show(*renderer_, volume);
    const pipeline::Image drawn = picture(*renderer_, volume);
    auto fresh = ui::Renderer::create();
    ASSERT_TRUE(fresh);
    show(**fresh, volume);
    EXPECT_EQ(changed(drawn, picture(**fresh, volume), {0, 0, width_, height_}), 0);
  }

  MixedVolume volumes_;
  std::optional<VolumeInTheMaking> making_;
  ui::ViewState view_;
};

TEST_P(BroughtAhead, is_drawn_as_if_it_had_come_at_once) {
  VolumeInTheMaking& making = bring_parts(volumes_.newer());
  picture(*renderer_, volumes_.older());
  making.finish();
  expect_same_as_fresh(making.volume());
}

TEST_P(BroughtAhead, is_forgotten_when_its_memory_is_used_for_another_volume) {
  for (const bool told : {true, false}) {
    VolumeInTheMaking& making = bring_parts(volumes_.older());
    making.begin_again(volumes_.newer(), 10);
    if (told) {
      bring(making);
      making.finish(3);
      bring(making);
    }
    making.finish();
    expect_same_as_fresh(making.volume());
  }
}

TEST_P(BroughtAhead, is_not_taken_for_another_volume_of_that_number) {
  bring_parts(volumes_.newer());
  pipeline::Volume mixture = volumes_.older();
  mixture.metadata.index = 9;
  expect_same_as_fresh(mixture);
}

// Be it whole.
TEST_P(BroughtAhead, fits_a_view_that_shows_flow_or_none_meanwhile) {
  const int all = volumes_.newer().geometry.b_scans;
  for (const int last : {20, all})
    for (const auto shown : {ui::VesselsShown::off, ui::VesselsShown::flow}) {
      view_.vessels =
          shown == ui::VesselsShown::off ? ui::VesselsShown::flow : ui::VesselsShown::off;
      VolumeInTheMaking& making = bring_parts(volumes_.newer(), last);
      making.finish();
      view_.vessels = shown;
      expect_same_as_fresh(making.volume());
    }
}

constexpr auto processor = ui::RayBackend::processor;
INSTANTIATE_TEST_SUITE_P(
    Ways, BroughtAhead,
    testing::Values(DrawingWay{Technique::rays, {0.6F, 192, processor}, 0},
                    DrawingWay{Technique::rays, {1, 256, processor}, 12},
                    DrawingWay{Technique::shaded, {1, 256, processor}, 0},
                    DrawingWay{Technique::planes, {0.5F, 96}, 0},
                    DrawingWay{Technique::rays, {0.6F, 192, processor}, 0, true},
                    DrawingWay{Technique::rays, {1, 256, processor}, 12, true},
                    DrawingWay{Technique::maximum, {1, 256, processor}, 0, true}));

class ComingVolumeTest : public testing::Test {
protected:
  void SetUp() override {
    volumes_.add_flow();
    older_ = volumes_.older();
    older_.flow_marks = pipeline::FlowMarks{older_.geometry, pipeline::blank_depth_bins};
  }
  bool bring(const VolumeInTheMaking& making, bool with_flow) {
    return coming_.bring(making.volume(), making.number(), making.finished(), with_flow);
  }
  void make_room(bool with_flow) {
    const ui::FlowVoxels flow{older_.flow, &older_.flow_marks};
    coming_.make_room(older_, older_.occupancy, with_flow ? &flow : nullptr, team_);
  }

  MixedVolume volumes_;
  pipeline::Volume older_;
  std::shared_ptr<ui::WorkTeam> team_ = std::make_shared<ui::WorkTeam>(1, pipeline::ThreadSetup{});
  ui::ComingVolume coming_;
};

TEST_F(ComingVolumeTest, has_what_was_finished) {
  VolumeInTheMaking making{volumes_.newer(), 9};
  EXPECT_FALSE(bring(making, false)) << "there is no room";
  make_room(false);
  ASSERT_TRUE(bring(making, false));
  EXPECT_EQ(coming_.has_of(making.volume(), false), 0);
  making.finish(7);
  EXPECT_TRUE(bring(making, false));
  EXPECT_EQ(coming_.has_of(making.volume(), false), 7);
  EXPECT_EQ(coming_.has_of(older_, false), 0);
  EXPECT_FALSE(bring(making, true)) << "the room is for volumes without flow";
  making.begin_again(volumes_.newer(), 10);
  EXPECT_EQ(coming_.has_of(making.volume(), false), 0);
  EXPECT_TRUE(bring(making, false));
  EXPECT_EQ(coming_.has_of(making.volume(), false), 0);
}

TEST_F(ComingVolumeTest, leaves_the_last_flow_to_its_neighbour) {
  VolumeInTheMaking making{volumes_.newer(), 9};
  make_room(true);
  making.finish(7);
  EXPECT_TRUE(bring(making, true));
  EXPECT_EQ(coming_.has_of(making.volume(), true), 6);
  EXPECT_EQ(coming_.has_of(making.volume(), false), 0);
  making.finish();
  EXPECT_TRUE(bring(making, true));
  EXPECT_EQ(coming_.has_of(making.volume(), true), making.volume().geometry.b_scans);
}

TEST_F(ComingVolumeTest, is_given_once) {
  VolumeInTheMaking making{volumes_.newer(), 9};
  make_room(false);
  making.finish(7);
  ASSERT_TRUE(bring(making, false));
  auto caster = ui::RayCaster::create(team_);
  ASSERT_TRUE(caster);
  coming_.give(*caster);
  EXPECT_FALSE(caster->empty());
  EXPECT_EQ(coming_.has_of(making.volume(), false), 0);
}

TEST_F(ComingVolumeTest, allocates_nothing_once_there_is_room) {
  VolumeInTheMaking making{volumes_.newer(), 9};
  make_room(true);
  making.finish(5);
  bring(making, true);
  making.finish(12);
  const auto before = allocations_of_this_thread();
  bring(making, true);
  EXPECT_EQ(allocations_of_this_thread(), before);
}

} // namespace
} // namespace octascope::tests

// What a surgeon relies on, frame by frame on a time axis that stands still between them.
#include <string>

#include <fmt/format.h>

#include "tests/firmware-host/run/loop_stage.h"
#include "tests/support/pictures/picture_counts.h"
#include "ui/layout/stereo.h"
#include "ui/transfer/auto_window.h"
#include "ui/transfer/histogram.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using ui::Liveness;
using ui::Technique;

// The middle of the volume's picture, which nothing covers (ui/layout/layout.h).
ui::Rect middle_of(const ui::Rect& view) {
  return {view.x + view.width / 4, view.y + view.height / 4, view.width / 2, view.height / 2};
}

// ---- The window's knob while the picture is frozen.

class FrozenWindow : public LoopStage, public testing::WithParamInterface<Technique> {
protected:
  // By a renderer that has shown nothing before.
  pipeline::Image fresh_picture(const pipeline::Volume& volume) const {
    auto renderer = ui::Renderer::create();
    EXPECT_TRUE(renderer);
    (*renderer)->expect(view());
    EXPECT_TRUE((*renderer)->show_volume(volume));
    EXPECT_TRUE((*renderer)->show_scope_picture(scope_picture_.frame(clock_.now()), std::nullopt));
    (*renderer)->show_levels(ui::make_level_histogram(volume).shares());
    EXPECT_TRUE((*renderer)->draw(view(), loop_->status(), display_.width(), display_.height(),
                                  loop_->quality()));
    return (*renderer)->read_back(display_.width(), display_.height());
  }
};

TEST_P(FrozenWindow, shows_in_the_very_next_frame) {
  ui::ViewState initial;
  initial.technique = GetParam();
  start(initial);
  send_scope_picture();
  send_volume(Tissue::usual);
  turn();
  press_freeze();
  turn();
  ASSERT_TRUE(view().frozen);
  send_volume(Tissue::reversed); // which a frozen picture does not take
  rest();
  const pipeline::Image before = display_.picture;
  const auto volumes_shown = loop_->statistics().volumes_displayed;
  const float window = view().window_offset_db;
  const ui::Rect middle = middle_of(layout().view);

  for (const int detents : {4, -7}) {
    const int frames = display_.frames;
    const pipeline::Image last = display_.picture;
    turn_knob(0, detents);
    turn();
    EXPECT_EQ(display_.frames, frames + 1);
    EXPECT_GT(count_different(last, display_.picture, middle, 8), 200) << "after " << detents;
    EXPECT_EQ(count_different(fresh_picture(tissues_[0]), display_.picture, middle, 2), 0);
  }
  EXPECT_NE(view().window_offset_db, window);
  EXPECT_EQ(loop_->statistics().volumes_displayed, volumes_shown);
  EXPECT_GT(count_different(fresh_picture(tissues_[1]), display_.picture, middle, 8), 200)
      << "the picture could not tell the volumes apart";
}

// The surface's mesh is made beside the loop, and comes when it is ready.
INSTANTIATE_TEST_SUITE_P(Techniques, FrozenWindow,
                         testing::Values(Technique::slices, Technique::planes, Technique::rays,
                                         Technique::shaded, Technique::maximum),
                         [](const auto& test) { return std::string{ui::to_string(test.param)}; });

// However slow the frame was in which both came.
TEST_F(LoopStage, what_is_asked_for_is_done_before_what_comes_after_it) {
  start({});
  send_volume(Tissue::usual);
  turn();
  const auto found = ui::suggest_window(tissues_[0]);
  ASSERT_TRUE(found);
  const hal::TimePoint now = clock_.now();
  send_controls({{now, hal::ControlKind::pedal_switch, 1, 1},
                 {now, hal::ControlKind::pedal_switch, 1, 0},
                 {now, hal::ControlKind::knob, 0, 4}});
  turn();
  EXPECT_GT(view().window_offset_db, found->offset_db);
  EXPECT_EQ(view().window_size_db, found->size_db);
}

// As above: a picture shows what was set when it was asked for.
TEST_F(LoopStage, a_kept_picture_is_of_the_view_in_which_it_was_asked_for) {
  start({});
  send_volume(Tissue::usual);
  turn();
  const float offset = view().window_offset_db;
  const hal::TimePoint now = clock_.now();
  send_controls({{now, hal::ControlKind::pedal_switch, 2, 1},
                 {now, hal::ControlKind::pedal_switch, 2, 0},
                 {now, hal::ControlKind::knob, 0, 4}});
  turn();
  EXPECT_EQ(kept_pictures_, 1);
  EXPECT_EQ(view().window_offset_db, offset);
  turn();
  EXPECT_EQ(kept_pictures_, 1);
  EXPECT_GT(view().window_offset_db, offset);
}

// ---- A display that goes and comes back.

struct Loss {
  Technique technique;
  ui::StereoMode stereo;
};

class LostDisplay : public LoopStage, public testing::WithParamInterface<Loss> {
protected:
  void SetUp() override {
    LoopStage::SetUp();
    if (IsSkipped() || HasFatalFailure())
      return;
    ui::ViewState initial;
    initial.technique = GetParam().technique;
    initial.stereo = GetParam().stereo;
    start(initial);
    send_scope_picture();
    send_volume(Tissue::usual);
    turn();
  }

  // Where nothing is written, for each eye.
  std::vector<ui::Rect> pictures() const {
    const ui::Layout places = layout();
    std::vector<ui::Rect> all;
    for (const ui::StereoEye eye : ui::eyes_of(view().stereo)) {
      const ui::EyeFrame frame =
          ui::eye_frame(view().stereo, eye, display_.width(), display_.height());
      for (const ui::Rect& rect : {middle_of(places.view), places.b_scan.picture,
                                   places.en_face.picture, places.scope.picture})
        all.push_back(frame.place(rect));
    }
    return all;
  }

  bool shows_tissue() const {
    const pipeline::Image& p = display_.picture;
    const ui::Rect middle = pictures().at(0);
    int lit = 0;
    for (int y = middle.y; y < middle.bottom(); ++y)
      for (int x = middle.x; x < middle.right(); ++x)
        lit += p.pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) +
                             static_cast<std::size_t>(x))] > 60;
    return lit > 100;
  }

  // Surfaces come when they are ready.
  void rest_with_tissue() {
    rest();
    for (int i = 0; i < 4000 && !shows_tissue(); ++i) {
      real_clock_.sleep_for(1ms);
      turn();
    }
    ASSERT_TRUE(shows_tissue());
    rest();
    if (GetParam().technique == Technique::surface)
      await_the_last_mesh();
  }

  // The window that is found in the first volume asks for another mesh, which comes in its own
  // time.
  void await_the_last_mesh() {
    // Turns, ten milliseconds and more each: the mesh's thread gives way to all others.
    constexpr int still = 100;
    pipeline::Image last = display_.picture;
    for (int turns = 0; turns < still; ++turns) {
      real_clock_.sleep_for(10ms);
      turn();
      if (count_different(last, display_.picture, pictures()[0], 2) > 0)
        turns = 0;
      last = display_.picture;
    }
  }

  void lose_for(hal::Duration duration) {
    const int frames = display_.frames;
    display_.cable().lose();
    turn_knob(1, 1); // or there would be nothing to draw
    turn_knob(1, -1);
    const hal::TimePoint lost = clock_.now();
    turn_until(lost + duration);
    EXPECT_EQ(display_.frames, frames);
    EXPECT_EQ(display_.state(), hal::DeviceState::absent);
    display_.cable().restore();
    for (int i = 0; i < 300 && display_.frames == frames; ++i) // until it is tried again
      turn();
    EXPECT_EQ(display_.frames, frames + 1);
  }
};

TEST_P(LostDisplay, shows_the_same_frozen_picture_when_it_is_back) {
  press_freeze();
  turn();
  ASSERT_TRUE(view().frozen);
  rest_with_tissue();
  const pipeline::Image before = display_.picture;

  lose_for(700ms);
  std::vector<ui::Rect> all = pictures();
  if (GetParam().technique != Technique::surface) {
    for (const ui::Rect& rect : all) {
      EXPECT_EQ(count_different(before, display_.picture, rect, 2), 0) << "in the first frame";
    }
  }
  rest_with_tissue();
  for (const ui::Rect& rect : all)
    EXPECT_EQ(count_different(before, display_.picture, rect, 2), 0)
        << rect.width << "x" << rect.height << " at " << rect.x << ", " << rect.y;
  EXPECT_EQ(loop_->status().freshness.liveness, Liveness::frozen);
}

TEST_P(LostDisplay, is_live_again_with_the_next_volume) {
  rest_with_tissue();
  const pipeline::Image before = display_.picture;
  lose_for(20ms);
  rest_with_tissue();
  resume_sweeps();
  send_volume(Tissue::reversed);
  turn();
  EXPECT_EQ(loop_->status().freshness.liveness, Liveness::live);
  const std::vector<ui::Rect> all = pictures(); // of an eye: volume, B-scan, en face, microscope
  EXPECT_GT(count_different(before, display_.picture, all[2], 8), 50);
  EXPECT_EQ(count_different(before, display_.picture, all[3], 2), 0);
  if (GetParam().technique != Technique::surface) {
    EXPECT_GT(count_different(before, display_.picture, all[0], 8), 100);
  }
}

std::vector<Loss> all_losses() {
  std::vector<Loss> all;
  for (const Technique technique : ui::all_techniques)
    for (const ui::StereoMode stereo : {ui::StereoMode::off, ui::StereoMode::side_by_side})
      all.push_back({technique, stereo});
  return all;
}

// ---- What became of a volume.

class VolumeBooks : public LoopStage {};

TEST_F(VolumeBooks, a_volume_counts_as_displayed_when_a_frame_with_it_reached_the_glass) {
  start({});
  send_volume(Tissue::usual);
  const int frames = display_.frames; // without a volume
  display_.cable().lose();            // the loop takes the volume, draws it, and cannot show it
  turn();
  EXPECT_EQ(loop_->statistics().volumes_taken, 1U);
  EXPECT_EQ(loop_->statistics().volumes_displayed, 0U);
  EXPECT_EQ(display_.frames, frames);
  display_.cable().restore();
  for (int i = 0; i < 300 && display_.frames == frames; ++i)
    turn();
  EXPECT_EQ(loop_->statistics().volumes_displayed, 1U);
  turn();
  EXPECT_EQ(loop_->statistics().volumes_displayed, 1U) << "once";
}

// ---- When a frame begins.

class Pacing : public LoopStage {};

TEST_F(Pacing, frames_for_a_monitor_begin_late_and_miss_no_refresh) {
  constexpr hal::Duration cost = 3ms;
  hal::TimePoint begun;
  display_.cost = [&] {
    begun = clock_.now();
    return cost;
  };
  start({});
  send_volume(Tissue::usual);
  const hal::Duration period = display_.refresh_period();
  for (const bool refreshes : {false, true}) {
    display_.refreshes = refreshes;
    for (int i = 0; i < 20; ++i) {
      const hal::TimePoint last = display_.completed;
      const int frames = display_.frames;
      turn_knob(1, 1);
      turn();
      ASSERT_EQ(display_.frames, frames + 1);
      if (i < 2)
        continue; // nothing is known yet of what a frame takes
      if (refreshes) {
        EXPECT_EQ(display_.completed - last, period) << "no refresh is missed";
        EXPECT_LT(display_.completed - begun, cost + period / 10 + 1us);
      } else {
        EXPECT_EQ(display_.completed - begun, cost) << "shown at once: nothing to wait for";
      }
    }
  }
}

// For the microscope's picture, so long before the next volume is due.
class FrameBeforeVolume : public LoopStage, public testing::WithParamInterface<hal::Duration> {
protected:
  static constexpr hal::Duration cost = 8ms;
};

TEST_P(FrameBeforeVolume, lets_that_go_first_unless_it_is_done_by_then) {
  display_.cost = [] { return cost; };
  start({});
  send_volume(Tissue::usual);
  const hal::TimePoint due = clock_.now() + plan().tick_period(); // to be published
  turn();
  turn_knob(1, 1); // what a frame costs without a volume's picture is known, too
  turn();
  const int frames = display_.frames;
  clock_.sleep_until(due - GetParam());
  send_scope_picture();
  turn();
  EXPECT_EQ(display_.frames, GetParam() > cost + display_.refresh_period() ? frames + 1 : frames);
  turn();
  EXPECT_EQ(display_.frames, frames + 1) << "the volume is late";
}

INSTANTIATE_TEST_SUITE_P(Times, FrameBeforeVolume, testing::Values(25ms, 4ms, -1ms),
                         [](const auto& test) { return fmt::format("case_{}", test.index); });

INSTANTIATE_TEST_SUITE_P(Techniques, LostDisplay, testing::ValuesIn(all_losses()),
                         [](const auto& test) {
                           return std::string{ui::to_string(test.param.technique)} +
                                  (test.param.stereo == ui::StereoMode::off ? "" : "_in_stereo");
                         });

} // namespace
} // namespace octascope::tests

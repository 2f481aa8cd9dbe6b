#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/configuration/kept/settings.h"
#include "firmware-host/configuration/kept/settings_store.h"
#include "sim/clock/virtual_clock.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::firmware_host {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

// Everything that is a setting, set otherwise than configured.
ui::ViewState another_view(const ConfiguredView& configured) {
  ui::ViewState v = configured.view;
  v.window_offset_db = 13;
  v.window_size_db = 21.5F;
  v.technique = ui::Technique::shaded;
  v.transfer = 1;
  v.colour_map = 2;
  v.layout = ui::LayoutKind::quad;
  v.stereo = ui::StereoMode::top_bottom;
  v.parallax_deg = -2.5F;
  v.box_visible = !v.box_visible;
  v.vessels = ui::VesselsShown::tree;
  v.vessel_opacity = 0.4F;
  v.vessel_colouring = ui::VesselColouring::order;
  return v;
}

// What is not: it would surprise whoever comes next.
void move_camera(ui::ViewState& v) {
  v.yaw_deg = -100;
  v.tilt_deg = 70;
  v.distance = 2;
  v.frozen = true;
  v.b_scan = 3;
  v.legend_visible = true;
  v.vessel_nudge.shift_mm[0] = 1;
}

class Settings : public testing::Test {
protected:
  fs::path file() const { return folder_ / "settings.toml"; }
  void write(const ui::ViewState& state) const {
    folder_.write("settings.toml", settings_text(configured_, state));
  }
  hal::Result<RestoredView> read() const { return read_settings(file(), configured_); }
  std::string written() const { return tests::whole_file(file()); }

  tests::ScratchFolder folder_;
  ConfiguredView configured_;
};

TEST_F(Settings, come_back_as_they_were_and_nothing_else_does) {
  const ui::ViewState set = another_view(configured_);
  ui::ViewState moved = set;
  move_camera(moved);
  write(moved);
  const auto read = tests::must(this->read());
  EXPECT_EQ(read.view, set);
  EXPECT_TRUE(read.window);
}

TEST_F(Settings, of_before_there_was_flow_say_whether_vessels_are_shown) {
  folder_.write("settings.toml", "[settings]\nvessels = false\n[configured]\nvessels = true\n");
  EXPECT_EQ(tests::must(read()).view.vessels, ui::VesselsShown::off);
  configured_.view.vessels = ui::VesselsShown::off;
  folder_.write("settings.toml", "[settings]\nvessels = true\n[configured]\nvessels = false\n");
  EXPECT_EQ(tests::must(read()).view.vessels, ui::VesselsShown::both);
}

TEST_F(Settings, that_nobody_changed_are_not_in_the_file) {
  ui::ViewState state = configured_.view;
  state.layout = ui::LayoutKind::b_scan;
  const std::string text = settings_text(configured_, state);
  EXPECT_THAT(text, HasSubstr("layout = \"b_scan\""));
  EXPECT_THAT(text, HasSubstr("layout = \"volume\"")) << "what was configured";
  EXPECT_THAT(text, Not(HasSubstr("technique")));
}

TEST_F(Settings, give_way_to_a_configuration_that_was_edited) {
  ui::ViewState state = configured_.view;
  state.technique = ui::Technique::shaded;
  state.layout = ui::LayoutKind::quad;
  write(state);
  configured_.view.technique = ui::Technique::maximum;
  const auto read = tests::must(this->read());
  EXPECT_EQ(read.view.technique, ui::Technique::maximum);
  EXPECT_EQ(read.view.layout, ui::LayoutKind::quad);
}

// The window that suits a volume differs from volume to volume; the surgeon's own counts.
TEST_F(Settings, of_the_window_count_over_an_automatic_one) {
  configured_.automatic_window = true;
  ui::ViewState state = configured_.view;
  state.window_offset_db = 20;
  write(state);
  configured_.view.window_offset_db = 3; // of another volume
  configured_.view.window_size_db = 50;
  const auto read = tests::must(this->read());
  EXPECT_TRUE(read.window);
  EXPECT_EQ(read.view.window_offset_db, 20);
  EXPECT_EQ(read.view.window_size_db, ui::ViewState{}.window_size_db) << "half a window is none";
  configured_.automatic_window = false;
  EXPECT_FALSE(this->read()->window) << "somebody configured one meanwhile";
}

TEST_F(Settings, that_are_broken_are_refused) {
  for (const char* text :
       {"[settings", "[settings]\ntechnique = \"raze\"\n", "[settings]\nwindow_size_db = -1\n",
        "[settings]\nfrozen = true\n", "[settings]\nbox = 1\n"}) {
    folder_.write("settings.toml", text);
    EXPECT_FALSE(read()) << text;
  }
}

TEST_F(Settings, survive_a_transfer_function_that_is_gone) {
  folder_.write("settings.toml", "[settings]\ntransfer = \"veins\"\n"
                                 "[configured]\ntransfer = \"window\"\n");
  const auto read = tests::must(this->read());
  EXPECT_EQ(read.view, configured_.view);
}

class SettingsFile : public Settings {
protected:
  // As the render loop does, for so long on the virtual axis.
  void pass(SettingsStore& keeper, hal::Duration time, const ui::ViewState& state) {
    for (hal::Duration gone{}; gone < time; gone += 100ms) {
      clock_.advance(100ms);
      keeper.note(configured_, state);
    }
  }
  sim::VirtualClock clock_;
  pipeline::FaultLog faults_;
};

TEST_F(SettingsFile, is_written_soon_after_a_change_and_at_the_end) {
  ui::ViewState state = configured_.view;
  {
    SettingsStore keeper{file(), clock_, faults_};
    EXPECT_FALSE(keeper.restore(configured_));
    pass(keeper, 10s, state);
    EXPECT_FALSE(fs::exists(file())) << "nothing was changed";
    state.layout = ui::LayoutKind::quad;
    pass(keeper, 2500ms, state);
  }
  EXPECT_THAT(written(), HasSubstr("layout = \"quad\""));
  {
    SettingsStore keeper{file(), clock_, faults_};
    const auto restored = tests::must(keeper.restore(configured_));
    EXPECT_EQ(restored.view.layout, ui::LayoutKind::quad);
    state.stereo = ui::StereoMode::side_by_side;
    keeper.finish(configured_, state);
  }
  EXPECT_THAT(written(), HasSubstr("stereo = \"side_by_side\""));
  EXPECT_TRUE(faults_.records().empty());
}

TEST_F(SettingsFile, that_is_broken_is_set_aside) {
  folder_.write("settings.toml", "rubbish");
  SettingsStore keeper{file(), clock_, faults_};
  EXPECT_FALSE(keeper.restore(configured_));
  EXPECT_TRUE(keeper.was_broken());
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_TRUE(fs::exists(folder_ / "settings.toml.broken"));
  ASSERT_EQ(faults_.records().size(), 1U);
  EXPECT_EQ(faults_.records()[0].kind, pipeline::Fault::settings_broken);
}

TEST_F(SettingsFile, that_cannot_be_written_is_a_fault_and_no_more) {
  SettingsStore keeper{folder_ / "nowhere/settings.toml", clock_, faults_};
  ui::ViewState state = configured_.view;
  EXPECT_FALSE(keeper.restore(configured_));
  state.layout = ui::LayoutKind::quad;
  keeper.finish(configured_, state);
  ASSERT_EQ(faults_.records().size(), 1U);
  EXPECT_EQ(faults_.records()[0].kind, pipeline::Fault::settings_not_kept);
}

} // namespace
} // namespace octascope::firmware_host

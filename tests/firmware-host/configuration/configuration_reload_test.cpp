// A configuration that is written while the appliance runs.
#include <csignal>
#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "firmware-host/configuration/kept/configuration_changes.h"
#include "firmware-host/configuration/kept/configuration_reload.h"
#include "firmware-host/configuration/kept/configuration_watch.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::firmware_host {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

class Reload : public testing::Test {
protected:
  Configuration read(const std::string& text) const {
    const auto read = load_configuration(folder_.write("octascope.toml", text));
    EXPECT_TRUE(read) << read.error().message;
    return read ? *read : Configuration{};
  }
  tests::ScratchFolder folder_;
};

TEST_F(Reload, tells_what_has_to_wait_for_a_restart) {
  const Configuration used = read("");
  const auto waits = [&](const std::string& text) {
    return changes_for_a_restart(used, read(text));
  };
  EXPECT_THAT(waits(""), IsEmpty());
  EXPECT_THAT(waits("[display]\ntechnique = \"maximum\"\nopacity = 0.2\nveil_after_s = 3\n"
                    "window_offset_db = 3\nwindow_size_db = 30\n[controls]\nprofile = "
                    "\"keyboard\"\n[[transfer]]\nname = \"mine\"\npoints = [[0, 0], [1, 1]]\n"),
              IsEmpty())
      << "all of that can be changed in a running appliance";
  EXPECT_THAT(waits("[scan]\nb_scans = 7\n"), ElementsAre("[scan]"));
  EXPECT_THAT(waits("[calibration]\nfile = \"c.toml\"\n"), ElementsAre("[calibration]"));
  EXPECT_THAT(waits("[pipeline]\nneighbour_weights = [0, 1, 0]\n"), ElementsAre("[pipeline]"));
  EXPECT_THAT(waits("[devices]\nmode = \"1920x1080@60\"\n"), ElementsAre("[devices]"));
  EXPECT_THAT(waits("[display]\nwidth = 640\n"), ElementsAre("[display] size"));
  EXPECT_THAT(waits("[sim]\nphantom = \"cap\"\n[scan]\n"), ElementsAre("[scan]", "[sim]"));
}

TEST_F(Reload, of_another_scale_waits_and_of_a_lens_in_the_cupboard_does_not) {
  const std::string chosen = "[microscope]\nobjective = \"a\"\n[[objective]]\nname = \"a\"\n";
  const Configuration used = read(chosen);
  EXPECT_THAT(changes_for_a_restart(used, read(chosen + "a_mm = 3\n")),
              ElementsAre("[microscope]"));
  EXPECT_THAT(changes_for_a_restart(used, read(chosen + "[[objective]]\nname = \"b\"\na_mm = 2\n")),
              IsEmpty());
  EXPECT_THAT(
      changes_for_a_restart(used, read(chosen + "window_offset_db = 3\nwindow_size_db = 30\n")),
      IsEmpty());
}

TEST_F(Reload, changes_what_was_edited_and_leaves_what_the_pedal_has_set) {
  const Configuration used = read("[display]\nopacity = 0.5\n");
  const Configuration next = read("[display]\nopacity = 0.25\nwindow_offset_db = 3\n"
                                  "window_size_db = 30\n");
  ui::ViewState view;
  view.technique = ui::Technique::slices; // by pedal
  view.yaw_deg = -12;
  const ui::ViewState changed = with_changes(view, used, next);
  EXPECT_EQ(changed.opacity, 0.25F);
  EXPECT_EQ(changed.window_offset_db, 3);
  EXPECT_EQ(changed.window_size_db, 30);
  EXPECT_EQ(changed.technique, ui::Technique::slices);
  EXPECT_EQ(changed.yaw_deg, -12);
}

// Their places in the list change when one is added before them or taken out.
TEST_F(Reload, follows_transfer_functions_by_their_names) {
  const std::string curve = "\npoints = [[0, 0], [1, 1]]\n";
  const Configuration used =
      read("[[transfer]]\nname = \"first\"" + curve + "[[transfer]]\nname = \"second\"" + curve);
  const Configuration next = read("[[transfer]]\nname = \"second\"" + curve);
  ui::ViewState view;
  view.transfer = *used.look.transfers.function_named("second");
  EXPECT_EQ(with_changes(view, used, next).transfer, next.look.transfers.function_named("second"));
  view.transfer = *used.look.transfers.function_named("first");
  EXPECT_EQ(with_changes(view, used, next).transfer, 0) << "it is gone: the configured one";
}

TEST_F(Reload, knows_whether_transfer_functions_differ) {
  const auto set = [&](const std::string& points, const std::string& more = "") {
    return read("[[transfer]]\nname = \"t\"\npoints = " + points + "\n" + more).look.transfers;
  };
  EXPECT_TRUE(same_transfers(set("[[0, 0], [1, 1]]"), set("[[0, 0], [1, 1]]")));
  EXPECT_FALSE(same_transfers(set("[[0, 0], [1, 1]]"), set("[[0, 0], [1, 0.9]]")));
  EXPECT_FALSE(
      same_transfers(set("[[0, 0], [1, 1]]"), set("[[0, 0], [1, 1]]", "colours = \"amber\"\n")));
  EXPECT_FALSE(same_transfers(set("[[0, 0], [1, 1]]"), read("").look.transfers));
}

TEST_F(Reload, reads_once_a_file_has_settled) {
  read("[display]\nopacity = 0.3\n");
  ConfigurationReload reload{folder_ / "octascope.toml", {}};
  const hal::TimePoint now{std::chrono::seconds{100}};
  EXPECT_FALSE(reload.take(now)) << "nobody asked";
  reload.ask(now);
  EXPECT_FALSE(reload.take(now + std::chrono::milliseconds{100}));
  std::optional<hal::Result<ReadConfiguration>> outcome;
  for (int i = 0; i < 1000 && !outcome; ++i) {
    outcome = reload.take(now + std::chrono::seconds{1});
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
  ASSERT_TRUE(outcome);
  ASSERT_TRUE(*outcome) << outcome->error().message;
  EXPECT_EQ((*outcome)->configuration.look.opacity, 0.3F);
  EXPECT_FALSE(reload.take(now + std::chrono::seconds{2})) << "once each time";
}

TEST_F(Reload, is_asked_for_by_writing_or_replacing_the_file) {
  const fs::path file = folder_.write("octascope.toml", "");
  ConfigurationWatch watch{file, ReloadSignal::ignored};
  EXPECT_FALSE(watch.changed());
  folder_.write("neighbour.toml", "");
  EXPECT_FALSE(watch.changed()) << "it is none of ours";
  folder_.write("octascope.toml", "# more\n");
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed()) << "once";
  fs::rename(folder_ / "neighbour.toml", file);
  EXPECT_TRUE(watch.changed());
  watch.watch_too(folder_ / "pedal.toml");
  folder_.write("pedal.toml", "");
  EXPECT_TRUE(watch.changed());
}

TEST_F(Reload, is_asked_for_by_a_signal) {
  ConfigurationWatch watch{{}, ReloadSignal::heeded};
  EXPECT_FALSE(watch.changed());
  ::kill(::getpid(), SIGHUP);
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed());
}

} // namespace
} // namespace octascope::firmware_host

// What notices that something hangs, and tells it: each part on a time axis of the test's own.
#include <algorithm>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/devices/status_text.h"
#include "firmware-host/crash/run_marker.h"
#include "firmware-host/supervision/appliance_status.h"
#include "firmware-host/supervision/fault_journal.h"
#include "firmware-host/supervision/thread_watch.h"
#include "firmware-host/supervision/watchdog.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using tests::ScratchFolder;

constexpr hal::TimePoint t0{1000s};

// ---- The watchdog.

TEST(Watchdog, is_kicked_by_nothing_but_news_of_the_picture) {
  Watchdog watchdog{4s};
  EXPECT_FALSE(watchdog.due(0, t0)) << "nothing was shown yet";
  EXPECT_TRUE(watchdog.due(1, t0 + 1s));
  for (int i = 2; i < 100; ++i)
    EXPECT_FALSE(watchdog.due(1, t0 + i * 1s)) << "the picture stands";
  EXPECT_TRUE(watchdog.due(2, t0 + 100s));
}

TEST(Watchdog, is_kicked_four_times_an_interval_at_most) {
  Watchdog watchdog{4s};
  int kicks = 0;
  for (std::uint64_t i = 0; i < 600; ++i) // ten seconds at sixty frames a second
    kicks += watchdog.due(i + 1, t0 + i * 16667us) ? 1 : 0;
  EXPECT_EQ(kicks, 10);
}

TEST(Watchdog, is_never_kicked_where_none_watches) {
  Watchdog watchdog{std::nullopt};
  EXPECT_FALSE(watchdog.due(1, t0));
}

TEST(Watchdog, is_patient_until_volumes_have_been_shown_without_a_pause) {
  Watchdog watchdog{4s};
  EXPECT_FALSE(watchdog.settles(0, t0 + 100s)) << "no volume has come";
  std::uint64_t frames = 0;
  const auto settles_after = [&](hal::TimePoint from, hal::Duration apart) {
    hal::TimePoint now = from;
    while (!watchdog.settles(++frames, now) && now < from + 60s)
      now += apart;
    return now - from;
  };
  EXPECT_FALSE(watchdog.settles(++frames, t0 + 100s)) << "its first picture";
  EXPECT_GE(settles_after(t0 + 112s, 3s), 60s) << "compiling holds it up again and again";
  EXPECT_EQ(settles_after(t0 + 200s, 500ms), 4s);
  EXPECT_FALSE(watchdog.settles(++frames, t0 + 300s)) << "once";
}

TEST(Watchdog, has_no_patience_to_lose_where_none_watches) {
  Watchdog watchdog{std::nullopt};
  for (std::uint64_t i = 0; i < 100; ++i)
    EXPECT_FALSE(watchdog.settles(i, t0 + i * 100ms));
}

// ---- Threads.

class Threads : public testing::Test {
protected:
  std::vector<std::string> stuck(hal::TimePoint now) const {
    std::vector<std::string> names;
    for (const ThreadState& state : watch_.states(now))
      if (state.stuck)
        names.push_back(state.name);
    return names;
  }

  // Of a thread of that role that does this and ends.
  template <class Steps> void run(const pipeline::ThreadRole& role, Steps steps) {
    std::thread{[&] {
      watch_.enlist(role, t0);
      steps();
    }}.join();
  }

  ThreadWatch watch_;
  pipeline::FaultLog faults_;
};

TEST_F(Threads, are_stuck_when_no_step_comes_within_their_limit) {
  run({"camera"}, [] { pipeline::Heartbeat::beat_here(t0); });
  run({"volumes"}, [] { pipeline::Heartbeat::beat_here(t0); });
  EXPECT_THAT(stuck(t0 + 2900ms), IsEmpty());
  EXPECT_THAT(stuck(t0 + 3100ms), ElementsAre("volumes"));
  EXPECT_THAT(stuck(t0 + 5100ms), ElementsAre("camera", "volumes"));
}

TEST_F(Threads, are_stuck_when_their_first_step_never_comes) {
  run({"camera"}, [] {});
  EXPECT_THAT(stuck(t0 + 4900ms), IsEmpty());
  EXPECT_THAT(stuck(t0 + 5100ms), ElementsAre("camera"));
}

TEST_F(Threads, are_not_stuck_while_they_rest) {
  run({"worker", 1}, [] {
    pipeline::Heartbeat::beat_here(t0);
    pipeline::Heartbeat::rest_here();
  });
  EXPECT_THAT(stuck(t0 + 1h), IsEmpty());
}

TEST_F(Threads, are_told_apart_and_complained_about_under_what_they_serve) {
  run({"worker", 0}, [] { pipeline::Heartbeat::rest_here(); });
  run({"worker", 1}, [] { pipeline::Heartbeat::beat_here(t0); });
  run({"scope"}, [] { pipeline::Heartbeat::beat_here(t0); });
  watch_.complain(faults_, t0 + 4s);
  watch_.complain(faults_, t0 + 5s);
  const auto records = faults_.records();
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].kind, pipeline::Fault::pipeline_stuck_thread);
  EXPECT_EQ(records[0].count, 2U) << "for as long as it hangs";
  EXPECT_THAT(records[0].message, HasSubstr("worker 1"));
  watch_.complain(faults_, t0 + 11s);
  EXPECT_EQ(faults_.records().size(), 2U);
}

TEST_F(Threads, need_no_watch) {
  run({"rays"}, [] { pipeline::Heartbeat::beat_here(t0); });
  EXPECT_THAT(watch_.states(t0 + 1h), IsEmpty());
  pipeline::Heartbeat::beat_here(t0); // of a thread that nobody gave one
}

// ---- The journal.

class Journal : public testing::Test {
protected:
  std::vector<JournalEntry> told_;
  FaultJournal journal_{[this](const JournalEntry& entry) { told_.push_back(entry); }};
  pipeline::FaultLog faults_;
};

TEST_F(Journal, is_not_flooded) {
  for (int i = 0; i < 600; ++i) { // a minute of a fault that strikes ten times a second
    faults_.add(pipeline::Fault::dropped_frames, "lost", t0 + i * 100ms, 3);
    journal_.update(faults_.records(), t0 + i * 100ms);
  }
  ASSERT_EQ(told_.size(), 6U);
  EXPECT_EQ(told_[0].count, 3U) << "at once";
  for (std::size_t i = 1; i < told_.size(); ++i)
    EXPECT_EQ(told_[i].count, 300U) << "those that were left out are counted";
  EXPECT_THAT(told_[1].message, HasSubstr("×300"));
}

TEST_F(Journal, tells_each_kind_for_itself_and_none_twice) {
  faults_.add(pipeline::Fault::silent, "gone", t0);
  faults_.add(pipeline::Fault::disk_full, "full", t0);
  journal_.update(faults_.records(), t0);
  journal_.update(faults_.records(), t0 + 1h);
  ASSERT_EQ(told_.size(), 2U);
  EXPECT_THAT(to_fields(told_[1]),
              ElementsAre("PRIORITY=4", "MESSAGE=host disk_full: full", "OCTASCOPE_DEVICE=host",
                          "OCTASCOPE_FAULT=disk_full", "OCTASCOPE_COUNT=1"));
}

// ---- From one run to the next.

class Runs : public testing::Test {
protected:
  using LastRun = RunMarker::LastRun;
  ScratchFolder folder_;
  std::filesystem::path boot_ = folder_.write("boot_id", "first\n");

  // A run that does not come to its end leaves its file.
  void crash() {
    const RunMarker run{folder_.path(), boot_};
    std::filesystem::copy_file(folder_ / "running", folder_ / "kept");
  }
  void leave() { std::filesystem::rename(folder_ / "kept", folder_ / "running"); }
};

TEST_F(Runs, end_in_good_order) {
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(RunMarker(folder_.path(), boot_).last_run(), LastRun::orderly);
}

TEST_F(Runs, crash_and_are_remembered_once) {
  crash();
  leave();
  EXPECT_EQ(RunMarker(folder_.path(), boot_).last_run(), LastRun::crashed);
  EXPECT_EQ(RunMarker(folder_.path(), boot_).last_run(), LastRun::orderly);
}

TEST_F(Runs, end_with_the_machine) {
  crash();
  leave();
  folder_.write("boot_id", "second\n");
  EXPECT_EQ(RunMarker(folder_.path(), boot_).last_run(), LastRun::power_lost);
  folder_.write("running", "");
  EXPECT_EQ(RunMarker(folder_.path(), boot_).last_run(), LastRun::power_lost) << "half written";
}

// ---- The status.

ApplianceStatus a_status() {
  ApplianceStatus s;
  s.now = t0 + 100s;
  s.uptime_s = 100;
  s.configuration = "/etc/octascope/octascope.toml";
  s.picture.emplace();
  s.picture->told = t0 + 99s;
  s.picture->simulated = true;
  s.picture->source = "phantom \"eye\"";
  s.picture->devices = {{"camera", "sim", hal::DeviceState::streaming},
                        {"pedal", "sim", hal::DeviceState::absent}};
  s.picture->freshness.liveness = ui::Liveness::stale;
  s.picture->counters.volumes.lost_lines = 12;
  s.picture->counters.displayed = 700;
  s.picture->notice = "Pedal disconnected: reconnecting";
  s.threads = {{"camera", false, 10ms}, {"worker 0", true, 4s}};
  s.faults = {{pipeline::Fault::dropped_frames, "back\\slash \"and\"\nline", 7, t0, t0 + 40s}};
  s.resident_bytes = 256ULL << 20U;
  return s;
}

TEST(Status, is_one_line_of_json) {
  const std::string text = to_json(a_status());
  EXPECT_EQ(std::ranges::count(text, '\n'), 1);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json.at("uptime_s"), 100);
  EXPECT_EQ(json.at("told_s_ago"), 1);
  EXPECT_EQ(json.at("picture").at("liveness"), "stale");
  EXPECT_EQ(json.at("devices").at("camera").at("state"), "streaming");
  EXPECT_EQ(json.at("lost").at("lines"), 12);
  EXPECT_EQ(json.at("threads").at(1).at("stuck"), true);
  EXPECT_EQ(json.at("faults").at(0).at("last_s_ago"), 60);
  EXPECT_TRUE(json.at("temperature_c").is_null());
}

TEST(Status, speaks_to_people) {
  const auto words = status_words(to_json(a_status()));
  ASSERT_TRUE(words) << words.error().message;
  EXPECT_THAT(*words, HasSubstr("up 1 min 40 s"));
  EXPECT_THAT(*words, HasSubstr("stale, SIMULATED"));
  EXPECT_THAT(*words, HasSubstr("thread worker 0, for 4 s"));
  EXPECT_THAT(*words, HasSubstr("256 MiB"));
  EXPECT_THAT(*words, HasSubstr("Pedal disconnected"));
  ApplianceStatus refused = a_status();
  refused.configuration_state = ui::ConfigurationState::built_in;
  EXPECT_THAT(*status_words(to_json(refused)), HasSubstr("REFUSED: the defaults are used"));

  ApplianceStatus young = a_status();
  young.picture.reset();
  ASSERT_TRUE(status_words(to_json(young)));
  EXPECT_THAT(*status_words(to_json(young)), HasSubstr("none yet"));
}

TEST(Status, refuses_what_is_no_answer) {
  for (const char* answer : {"", "hello", "[]", "{}", "null"})
    EXPECT_FALSE(status_words(answer)) << answer;
}

TEST(Metrics, are_lines_of_the_text_format) {
  const std::string text = to_metrics(a_status());
  EXPECT_THAT(text, HasSubstr("octascope_volumes_total{fate=\"displayed\"} 700\n"));
  EXPECT_THAT(text, HasSubstr("octascope_picture_live 0\n"));
  EXPECT_THAT(text, HasSubstr("octascope_thread_stuck{thread=\"worker 0\"} 1\n"));
  EXPECT_THAT(
      text,
      HasSubstr("octascope_faults_total{device=\"line_camera\",kind=\"dropped_frames\"} 7\n"));
  EXPECT_THAT(text, Not(HasSubstr("temperature")));
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);)
    EXPECT_THAT(line, testing::ContainsRegex("^(# (HELP|TYPE) octascope_[a-z_]+ .+|"
                                             "octascope_[a-z_]+(\\{.*\\})? [-+0-9.e]+)$"));
}

} // namespace
} // namespace octascope::firmware_host

// octascope replay as a user runs it: what it shows, what it says of it, and how it ends.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/files/nrrd.h"
#include "pipeline/recordings/recording_writer.h"
#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr int replay_width = 1280;

pipeline::RecordingFacts ball_facts(bool simulated) {
  pipeline::RecordingFacts facts;
  facts.geometry = {48, 40, 32, 30, 40, 50};
  facts.volume_period_s = 0.2;
  facts.begun = "2026-11-22T12:10:03+01:00";
  facts.source = "a ball";
  facts.simulated = simulated;
  facts.subject = "4711";
  facts.eye = pipeline::Eye::left;
  return facts;
}

// A ball that is in another place in each volume; the third lacks a B-scan, the fourth never came.
pipeline::Volume ball_volume(int n) {
  pipeline::Volume volume{ball_facts(false).geometry};
  std::ranges::fill(volume.b_scan_states, pipeline::BScanState::good);
  const int centre = 10 + 6 * n;
  for (int b = 0; b < volume.geometry.b_scans; ++b)
    for (int a = 0; a < volume.geometry.a_scans; ++a)
      for (int z = 0; z < volume.geometry.depths; ++z) {
        const int square = (b - 16) * (b - 16) + (a - centre) * (a - centre) + (z - 20) * (z - 20);
        volume.b_scan(b)[static_cast<std::size_t>(a * volume.geometry.depths + z)] = square < 64
                                                                                         ? 180
                                                                                     : z > 40 ? 140
                                                                                              : 60;
      }
  if (n == 2) {
    volume.b_scan_states[5] = pipeline::BScanState::missing;
    std::ranges::fill(volume.b_scan(5), std::uint8_t{0});
  }
  return volume;
}

pipeline::RecordedVolume ball_entry(int n) {
  const std::int64_t begin = 50'000'000'000 + n * 200'000'000LL + (n > 2 ? 200'000'000 : 0);
  return {.index = static_cast<std::uint64_t>(n > 2 ? n + 2 : n + 1),
          .first_line_ns = begin,
          .last_line_ns = begin + 180'000'000,
          .published_ns = begin + 190'000'000,
          .wall_clock_ns = 1'795'345'803'000'000'000 + n * 200'000'000LL,
          .lost_b_scans = n == 2 ? 1 : 0,
          .lost_lines = n == 2 ? 40 : 0};
}

class ReplayProgram : public testing::Test {
protected:
  static constexpr int volumes = 4;

  void SetUp() override { record(false); }

  void record(bool simulated) {
    file_ = (folder_ / (simulated ? "simulated.h5" : "patient.h5")).string();
    auto writer = pipeline::RecordingWriter::create(file_, ball_facts(simulated));
    ASSERT_TRUE(writer) << writer.error().message;
    for (int n = 0; n < volumes; ++n)
      ASSERT_TRUE(writer->append(ball_volume(n), ball_entry(n)));
    ASSERT_TRUE(writer->finish({}));
  }
  std::vector<std::string> words(std::vector<std::string> more) const {
    std::vector<std::string> all{"replay",    file_,      "--display",
                                 "offscreen", "--config", folder_.write("look.toml", look),
                                 "--size",    "1280x720"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  // The picture and the report of a replay that ended well.
  pipeline::Image replay(std::vector<std::string> more) {
    more.insert(more.end(), {"--snapshot", folder_ / "s.png", "--report", folder_ / "r.json"});
    const ProgramResult result = run_well(words(more), 60s);
    EXPECT_EQ(result.err, "");
    report_ = read_report(folder_ / "r.json");
    pipeline::Image picture = read_snapshot(folder_ / "s.png");
    EXPECT_EQ(picture.width, replay_width);
    return picture;
  }
  pipeline::Image render(const ui::Rect& view, int at) {
    run_well({"render", "--volume", file_, "--at", std::to_string(at), "--size",
              std::to_string(view.width) + "x" + std::to_string(view.height), "--window", "20,60",
              "--technique", "maximum", "--box", "--out", folder_ / "v.png"},
             60s);
    return read_snapshot(folder_ / "v.png");
  }

  static constexpr const char* look = R"([display]
window_offset_db = 20
window_size_db = 60
technique = "maximum"
)";
  ScratchFolder folder_;
  std::string file_;
  nlohmann::json report_;
};

ui::Layout replay_layout(const pipeline::Image& picture) {
  const pipeline::VolumeGeometry g = ball_facts(false).geometry;
  return ui::lay_out(picture.width, picture.height,
                     {.b_scan = g.a_mm() / g.depth_mm(),
                      .en_face = g.a_mm() / g.b_mm(),
                      .has_scope = false,
                      .crossed = g.b_mm() / g.depth_mm()});
}

// As wide as its frame: that depends on what the flat pictures beside it are cut to.
ui::Rect framed_view(const pipeline::Image& picture) {
  ui::Rect view = replay_layout(picture).view;
  const auto framed = [&](int x) {
    return count_colour(picture, {x, view.y + view.height / 2, 1, 1}, ui::palette::replay, 2) == 1;
  };
  int right = view.x + view.width / 2;
  while (right < picture.width && !framed(right))
    ++right;
  while (right < picture.width && framed(right))
    ++right;
  view.width = right - view.x;
  return view;
}

// Pixels of the middle of the view, where nothing is written, that differ from the volume's own.
int different_from(const pipeline::Image& screen, const pipeline::Image& volume,
                   const ui::Rect& view) {
  int count = 0;
  for (int y = view.height / 4; y < view.height * 3 / 4; ++y)
    for (int x = view.width / 4; x < view.width * 3 / 4; ++x) {
      const auto a = screen.pixel(view.x + x, view.y + y);
      const auto b = volume.pixel(x, y);
      count += std::abs(int{a[1]} - int{b[1]}) > 24 ? 1 : 0;
    }
  return count;
}

TEST_F(ReplayProgram, says_replay_all_the_time_and_never_that_it_is_live) {
  const pipeline::Image picture = replay({"--volumes", "2"});
  EXPECT_GT(count_colour(picture, badge_row(picture), ui::palette::replay, 2), 5000);
  EXPECT_EQ(count_colour(picture, badge_row(picture), ui::palette::simulated), 0);
  const ui::Rect view = replay_layout(picture).view;
  EXPECT_GT(count_colour(picture, {view.x, view.y, 3, view.height}, ui::palette::replay, 2),
            view.height)
      << "a frame about the picture";
  EXPECT_EQ(report_["replayed"]["eye"], "left");
  EXPECT_EQ(report_["replayed"]["subject"], "4711");
  EXPECT_EQ(report_["hot_path"]["allocations"], 0);
  EXPECT_TRUE(report_["faults"].empty()) << report_["faults"].dump(2);
}

TEST_F(ReplayProgram, of_a_simulated_recording_says_that_too) {
  record(true);
  const pipeline::Image picture = replay({"--volumes", "2"});
  EXPECT_GT(count_colour(picture, badge_row(picture), ui::palette::replay, 2), 5000);
  EXPECT_GT(count_colour(picture, badge_row(picture), ui::palette::simulated), 100);
}

TEST_F(ReplayProgram, shows_the_levels_that_were_recorded) {
  for (const int at : {0, 3}) {
    const pipeline::Image screen = replay({"--from", std::to_string(at), "--volumes", "1"});
    const ui::Rect view = framed_view(screen);
    const int same = different_from(screen, render(view, at), view);
    const int other = different_from(screen, render(view, 3 - at), view);
    // The frame of the B-scan lies over it, and it may be drawn more coarsely.
    EXPECT_LT(same, view.width * view.height / 4 / 25) << "volume " << at;
    EXPECT_GT(other, 3 * same) << "it would be seen if it were another one";
  }
}

TEST_F(ReplayProgram, ends_after_the_last_volume_with_its_books_balanced) {
  replay({"--once", "--rate", "4"});
  const auto& v = report_["volumes"];
  EXPECT_EQ(v["published"], volumes);
  EXPECT_EQ(v["displayed"].get<int>() + v["skipped"].get<int>(), volumes);
  EXPECT_EQ(v["planned"], volumes + 1) << "one was lost when it was recorded";
  EXPECT_EQ(report_["lost"]["volumes"], 1);
  EXPECT_EQ(report_["lost"]["b_scans"], 32 + 1);
}

TEST_F(ReplayProgram, missing_b_scans_stay_missing) {
  const pipeline::Image picture = replay({"--from", "2", "--volumes", "1"});
  EXPECT_GT(count_colour(picture, badge_row(picture), ui::palette::warning), 100);
}

TEST_F(ReplayProgram, keeps_the_recorded_time) {
  const auto begin = WallClock::now();
  replay({"--once", "--rate", "0.5"}); // 0.8 s from the first to the last, twice as long
  EXPECT_GT(WallClock::now() - begin, 1600ms);
}

TEST_F(ReplayProgram, tells_when_the_file_goes_away_under_it) {
  ProgramRun run{octascope_command(words({"--rate", "10"}))};
  ASSERT_TRUE(run.wait_for_thread("octa-replay", 60s));
  std::this_thread::sleep_for(500ms);
  std::filesystem::resize_file(file_, 3000);
  const ProgramResult result = run.wait(60s);
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.err, HasSubstr("no volume could be read any more"));
}

struct BadReplay {
  std::string name;
  std::string words; // with FILE for a good recording
  int exit_status;
  std::string says;
};

class RefusedReplay : public ReplayProgram, public testing::WithParamInterface<BadReplay> {};

TEST_P(RefusedReplay, says_what_was_found_and_what_was_expected) {
  folder_.write("text.h5", "no recording at all");
  folder_.write("tree.swc", "1 3 0 0 0 0.1 -1\n2 3 1 0 0 0.1 1\n");
  folder_.write("right.toml", "[registration]\nvolume_from_tree = [[1, 0, 0, 0], [0, 1, 0, 0], "
                              "[0, 0, 1, 0], [0, 0, 0, 1]]\n[whose]\neye = \"right\"\n");
  std::filesystem::copy_file(file_, folder_ / "short.h5");
  std::filesystem::resize_file(folder_ / "short.h5",
                               std::filesystem::file_size(folder_ / "short.h5") / 3);
  std::vector<std::string> all;
  std::istringstream words{GetParam().words};
  for (std::string word; words >> word;) {
    if (word == "FILE")
      word = file_;
    else if (std::filesystem::path{word}.has_extension())
      word = folder_ / word;
    all.push_back(word);
  }
  pipeline::NrrdVolume nrrd{ball_facts(false).geometry, std::vector<float>(48 * 40 * 32)};
  ASSERT_TRUE(pipeline::write_nrrd(folder_ / "v.nrrd", nrrd));
  const ProgramResult result = run_octascope(all, 60s);
  EXPECT_EQ(result.exit_status, GetParam().exit_status) << result.describe();
  EXPECT_THAT(result.err, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedReplay,
    testing::Values(
        BadReplay{"no_file", "replay", 2, "file is required"},
        BadReplay{"absent", "replay none.h5", 1, "no such file"},
        BadReplay{"text", "replay text.h5", 1, "no recording"},
        BadReplay{"cut_off", "replay short.h5", 1, "short.h5"},
        BadReplay{"from_beyond", "replay FILE --from 4", 2, "expected 0 to 3"},
        BadReplay{"stands_still", "replay FILE --rate 0", 2, "--rate"},
        BadReplay{"both_ends", "replay FILE --duration 1 --volumes 1", 2, "--duration"},
        BadReplay{"others_vessels", "replay FILE --vessels tree.swc --registration right.toml", 2,
                  "expected those in the picture, of subject 4711, left eye"},
        BadReplay{"size", "replay FILE --size big", 2, "big"},
        BadReplay{"render_beyond", "render --volume FILE --at 4 --out v.png", 2, "expected 0 to 3"},
        BadReplay{"render_at_of_one", "render --volume v.nrrd --at 0 --out v.png", 2,
                  "no recording"},
        BadReplay{"render_text", "render --volume short.h5 --out v.png", 1, "short.h5"}),
    [](const auto& test) { return test.param.name; });

// By its content, whatever it is called.
TEST_F(ReplayProgram, is_rendered_by_any_name) {
  std::filesystem::rename(file_, folder_ / "volume.nrrd");
  file_ = (folder_ / "volume.nrrd").string();
  EXPECT_EQ(render({0, 0, 200, 120}, 1).width, 200);
}

} // namespace
} // namespace octascope::tests

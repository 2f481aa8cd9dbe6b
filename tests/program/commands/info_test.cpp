// octascope info as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "tests/support/files/small_recording.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Info : public testing::Test {
protected:
  std::string told(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"info", recording};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = run_well(words, 60s);
    EXPECT_EQ(result.err, "");
    return result.out;
  }
  void write_unfinished(const pipeline::RecordingFacts& facts, std::uint64_t volumes) {
    auto writer = pipeline::RecordingWriter::create(recording, facts);
    ASSERT_TRUE(writer) << writer.error().message;
    append_small_volumes(*writer, 0, volumes);
  }

  ScratchFolder folder;
  const std::string recording = folder / "r.h5";
};

TEST_F(Info, as_json_says_everything) {
  write_small_recording(recording, 5);
  json expected = json::parse(R"({
    "finished": true, "simulated": true, "volumes": 5, "duration_s": 0.705,
    "volume_period_s": 0.141, "first_index": 1, "last_index": 6,
    "geometry": {"depths": 12, "a_scans": 7, "b_scans": 5, "depth_spacing_um": 3.5,
                 "refractive_index": 1.38, "a_spacing_um": 10, "b_spacing_um": 37.5,
                 "extent_mm": {"depth": 0.042}},
    "level_scale": {"lowest_db": -40, "step_db": 0.5, "highest_db": 87.5},
    "begun": "2026-11-22T12:10:03+01:00", "recorded_by": "octascope, in a test",
    "source": "phantom eye", "subject": "Müller, 17", "eye": "left", "configuration": "# none\n",
    "lost": {"gaps": 1, "volumes_in_gaps": 1, "longest_gap": 1, "volumes_not_kept": 2,
             "b_scans": 5, "lines": 35, "saturated_lines": 15}
  })");
  expected["file"] = recording;
  expected["bytes"] = std::filesystem::file_size(recording);
  expected["rate_hz"] = 1 / 0.141;
  expect_all(json::parse(told({"--json"})), expected);
}

TEST_F(Info, speaks_to_people) {
  write_small_recording(recording, 5);
  const std::string said = told();
  for (const char* words :
       {"SIMULATED", "begun        2026-11-22T12:10:03+01:00, by octascope, in a test",
        "source       phantom eye", "subject      Müller, 17", "eye          left",
        "volumes      5, 0 to 4; the appliance's 1 to 6",
        "duration     0.71 s, 7.09 volumes/s; planned one in 141.0 ms",
        "12 depths × 7 A-scans × 5 B-scans", "every 3.5 × 10 × 37.5 µm: 0.042 × 0.07 × 0.1875 mm",
        "counts 0 to 255, -40 dB and 0.5 dB a count, to 87.5 dB", "finished     yes",
        "lost         volumes: 1, gaps: 1, the longest of 1",
        "not kept because the disk was too slow: 2", "B-scans: 5, lines: 35; saturated lines: 15"})
    EXPECT_THAT(said, HasSubstr(words));
}

TEST_F(Info, says_what_it_means_that_one_was_not_finished) {
  write_unfinished(small_recording_facts(), 2);
  const std::string said = told();
  EXPECT_THAT(said, HasSubstr("finished     no: it is being written, or power or program was lost; "
                              "what is there is whole"));
  EXPECT_THAT(said, HasSubstr("how many the disk was too slow for is not known"));
  EXPECT_THAT(said, HasSubstr("no volume between the first and the last"));
  const json as_json = json::parse(told({"--json"}));
  EXPECT_EQ(as_json.at("finished"), false);
  EXPECT_TRUE(as_json.at("lost").at("volumes_not_kept").is_null());
}

TEST_F(Info, says_not_said_where_nothing_was_said) {
  pipeline::RecordingFacts facts = small_recording_facts();
  facts.subject.clear();
  facts.eye = pipeline::Eye::not_said;
  facts.simulated = false;
  write_unfinished(facts, 1);
  const std::string said = told();
  EXPECT_THAT(said, HasSubstr("subject      not said"));
  EXPECT_THAT(said, HasSubstr("eye          not said"));
  EXPECT_THAT(said, Not(HasSubstr("SIMULATED")));
  EXPECT_THAT(said, Not(HasSubstr("volumes/s"))); // of one volume there is no rate
  const json as_json = json::parse(told({"--json"}));
  EXPECT_TRUE(as_json.at("subject").is_null());
  EXPECT_TRUE(as_json.at("eye").is_null());
  EXPECT_TRUE(as_json.at("rate_hz").is_null());
  EXPECT_EQ(as_json.at("simulated"), false);
}

TEST_F(Info, of_an_empty_recording_has_no_volumes) {
  write_unfinished(small_recording_facts(), 0);
  EXPECT_THAT(told(), HasSubstr("volumes      none"));
  EXPECT_EQ(json::parse(told({"--json"})).at("volumes"), 0);
}

TEST_F(Info, gives_the_configuration_back) {
  write_small_recording(recording, 1);
  EXPECT_EQ(told({"--configuration"}), "# none\n");
}

TEST_F(Info, refuses_what_is_no_recording) {
  const auto refused = [&](const std::string& file, int exit_status) {
    const ProgramResult result = run_octascope({"info", file}, 60s);
    EXPECT_EQ(result.exit_status, exit_status) << result.describe();
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr(file));
    return result.err;
  };
  EXPECT_THAT(refused(folder / "nowhere.h5", 1), HasSubstr("no such file"));
  EXPECT_THAT(refused(folder.write("text.h5", "a text"), 1), HasSubstr("no recording"));
  EXPECT_THAT(refused(folder.path(), 2), HasSubstr("found a folder"));
  EXPECT_EQ(run_octascope({"info"}, 60s).exit_status, 2);
}

} // namespace
} // namespace octascope::tests

// Recordings of a running appliance, by command and by pedal.
#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/recordings/recording_reader.h"
#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

pipeline::RecordingReader open_recording(const std::filesystem::path& file) {
  auto reader = pipeline::RecordingReader::open(file);
  if (!reader)
    throw std::runtime_error{reader.error().message};
  return std::move(*reader);
}

std::vector<std::string> small_record(const ScratchFolder& folder, std::vector<std::string> more) {
  std::vector<std::string> words = small_run(folder, std::move(more));
  words[0] = "record";
  words.insert(words.end(), {"--out", folder / "r.h5"});
  return words;
}

TEST(Record, keeps_every_volume_from_the_first_on) {
  const ScratchFolder folder;
  const std::string report_file = folder / "report.json";
  const ProgramResult result = run_well(small_record(
      folder, {"--volumes", "6", "--report", report_file, "--eye", "right", "--subject", "17"}));
  EXPECT_THAT(result.out, HasSubstr("r.h5, "));

  auto reader = open_recording(folder / "r.h5");
  EXPECT_TRUE(reader.end().finished);
  EXPECT_EQ(reader.volumes().size() + reader.end().not_kept,
            read_report(report_file)["volumes"]["acquired"]);
  const pipeline::RecordingFacts& facts = reader.facts();
  EXPECT_TRUE(facts.simulated);
  EXPECT_EQ(facts.eye, pipeline::Eye::right);
  EXPECT_EQ(facts.subject, "17");
  EXPECT_EQ(facts.geometry.b_scans, small_b_scans);
  EXPECT_EQ(facts.geometry.a_scans, small_a_scans);
  EXPECT_THAT(facts.recorded_by, HasSubstr("octascope 0."));
  EXPECT_THAT(facts.configuration, HasSubstr("[scan]"));
  EXPECT_THAT(facts.begun, testing::MatchesRegex("[0-9-]{10}T[0-9:]{8}[+-][0-9]{2}:[0-9]{2}"));

  pipeline::Volume volume{facts.geometry};
  std::int64_t last = 0;
  for (std::size_t n = 0; n < reader.volumes().size(); ++n) {
    ASSERT_TRUE(reader.read(n, volume));
    EXPECT_GT(std::ranges::max(volume.levels), 100) << "there is an eye in volume " << n;
    EXPECT_GT(reader.volumes()[n].published_ns, last);
    last = reader.volumes()[n].published_ns;
  }
}

TEST(Record, says_nothing_of_subject_and_eye_that_nobody_said) {
  const ScratchFolder folder;
  run_well(small_record(folder, {"--volumes", "2"}));
  const auto reader = open_recording(folder / "r.h5");
  EXPECT_EQ(reader.facts().eye, pipeline::Eye::not_said);
  EXPECT_EQ(reader.facts().subject, "");
}

TEST(Record, writes_over_nothing) {
  const ScratchFolder folder;
  folder.write("r.h5", "mine");
  const ProgramResult result = run_octascope(small_record(folder, {"--volumes", "2"}));
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.err, HasSubstr("never written over"));
  EXPECT_EQ(std::filesystem::file_size(folder / "r.h5"), 4U);
}

TEST(Record, needs_a_folder_that_is_there) {
  const ScratchFolder folder;
  auto words = small_record(folder, {"--volumes", "2"});
  words.back() = folder / "none/r.h5";
  const ProgramResult result = run_octascope(words);
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_THAT(result.err, HasSubstr("none"));
}

// As at a power cut, but for the disk's own part in it.
TEST(Record, of_a_program_that_was_killed_can_be_read) {
  const ScratchFolder folder;
  ProgramRun run{octascope_command(small_record(folder, {"--duration", "100"}))};
  ASSERT_TRUE(run.wait_for_thread("octa-recorder", 60s));
  const auto kept = [&] {
    const auto reader = pipeline::RecordingReader::open(folder / "r.h5");
    return reader ? reader->volumes().size() : 0;
  };
  for (int i = 0; i < 600 && kept() < 3; ++i)
    std::this_thread::sleep_for(100ms);
  run.send_signal(SIGKILL);
  static_cast<void>(run.wait(60s));
  auto reader = open_recording(folder / "r.h5");
  EXPECT_FALSE(reader.end().finished);
  ASSERT_GE(reader.volumes().size(), 3U);
  pipeline::Volume volume{reader.facts().geometry};
  for (std::size_t n = 0; n < reader.volumes().size(); ++n)
    EXPECT_TRUE(reader.read(n, volume)) << n;
}

} // namespace
} // namespace octascope::tests

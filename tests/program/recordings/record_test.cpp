// Recordings of a running appliance, by command and by pedal.
#include <csignal>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

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

TEST(Record, warns_that_flow_is_not_kept) {
  const ScratchFolder folder;
  const ProgramResult result =
      run_well(small_record(folder, {"--volumes", "1", "--repeats", "2", "--flow", "on"}));
  EXPECT_THAT(result.err, HasSubstr("recordings keep no flow"));
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

// What was asked for with --out and is not there at the end: told last, on stderr, by the status, and
// never praised.
ProgramResult record_while(const ScratchFolder& folder, const std::function<void()>& happen) {
  ProgramRun run{octascope_command(small_record(folder, {"--duration", "100"}))};
  EXPECT_TRUE(run.wait_for_thread("octa-recorder", 60s));
  for (int i = 0; i < 600; ++i) {
    const auto reader = pipeline::RecordingReader::open(folder / "r.h5");
    if (reader && !reader->volumes().empty())
      break;
    std::this_thread::sleep_for(100ms);
  }
  happen();
  run.send_signal(SIGINT);
  return run.wait(60s);
}

TEST(Record, fails_where_its_file_is_gone_at_the_end) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "r.h5";
  const auto fails = [&](const std::function<void()>& happen) {
    const ProgramResult result = record_while(folder, happen);
    EXPECT_EQ(result.exit_status, 1) << result.describe();
    EXPECT_THAT(result.out, testing::Not(HasSubstr("recording: ")));
    EXPECT_THAT(result.err, HasSubstr("octascope record: " + file.string() + ": "));
    std::filesystem::remove(file);
    return result.err;
  };
  EXPECT_THAT(fails([&] { std::filesystem::remove(file); }), HasSubstr("is lost"));
  EXPECT_THAT(fails([&] {
                folder.write("new.h5", "mine");
                std::filesystem::rename(folder / "new.h5", file);
              }),
              HasSubstr("another file took its place"));
  EXPECT_THAT(fails([&] { std::filesystem::rename(file, folder / "moved.h5"); }),
              HasSubstr("is in " + (folder / "moved.h5").string()));
  EXPECT_TRUE(open_recording(folder / "moved.h5").end().finished);
}

// A disk of that size, for one program alone; empty: none can be made here.
std::vector<std::string> with_small_disk(const std::filesystem::path& place,
                                         const std::string& size) {
  std::vector<std::string> words{"unshare",
                                 ::geteuid() == 0 ? "-m" : "-rm",
                                 "sh",
                                 "-c",
                                 "mount -t tmpfs -o size=" + size + " tmpfs \"$0\" && \"$@\"",
                                 place};
  std::vector<std::string> nothing = words;
  nothing.emplace_back("true");
  return run_program(nothing).exit_status == 0 ? words : std::vector<std::string>{};
}

TEST(Record, fails_where_the_disk_is_full_from_the_first_volume_on_or_later) {
  const ScratchFolder folder;
  const std::filesystem::path disk = folder / "disk";
  std::filesystem::create_directory(disk);
  const auto recorded = [&](const std::string& size) {
    std::vector<std::string> words = with_small_disk(disk, size);
    auto record = octascope_command(small_record(folder, {"--volumes", "6"}));
    record.back() = disk / "r.h5";
    words.insert(words.end(), record.begin(), record.end());
    return run_program(words);
  };
  if (with_small_disk(disk, "1m").empty())
    GTEST_SKIP() << "no disk can be mounted here";
  const ProgramResult none = recorded("200m");
  EXPECT_EQ(none.exit_status, 1) << none.describe();
  EXPECT_THAT(none.out, testing::Not(HasSubstr("recording: ")));
  EXPECT_THAT(none.err,
              testing::AllOf(HasSubstr("are left on its disk"), HasSubstr("it holds no volume")));
  const ProgramResult some = recorded("262260k"); // 256 MB stay free: room for some is left
  EXPECT_EQ(some.exit_status, 1) << some.describe();
  EXPECT_THAT(some.err, testing::ContainsRegex("it holds [1-9] volumes"));
  EXPECT_THAT(some.out, HasSubstr("recording: "));
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

// Raw spectra of the appliance: captured, recorded beside the levels, and turned into levels again.
#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "pipeline/files/nrrd.h"
#include "pipeline/files/text_curve.h"
#include "pipeline/recordings/raw/raw_reader.h"
#include "pipeline/recordings/recording_reader.h"
#include "tests/program/program_support.h"
#include "tests/support/files/test_data.h"
#include "tests/support/must.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

template <class Reader> Reader must_open(const std::filesystem::path& file) {
  auto reader = Reader::open(file);
  if (!reader)
    throw std::runtime_error{reader.error().message};
  return std::move(*reader);
}

// record --raw of twins in a small scan.
std::vector<std::string> small_raw_record(const ScratchFolder& folder,
                                          std::vector<std::string> more) {
  std::vector<std::string> words = small_run(folder, std::move(more));
  words[0] = "record";
  words.insert(words.end(), {"--raw", folder / "raw.h5"});
  return words;
}

// capture of twins in a small scan.
std::vector<std::string> small_capture(const ScratchFolder& folder,
                                       const std::vector<std::string>& more) {
  std::vector<std::string> words{"capture",  "--sim",
                                 "--config", write_small_configuration(folder).string(),
                                 "--out",    folder / "c.h5"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// Every volume of the recording that is whole in the raw one: its levels again, by reconstruct.
void expect_same_levels(const ScratchFolder& folder) {
  auto levels = must_open<pipeline::RecordingReader>(folder / "r.h5");
  const auto raw = must_open<pipeline::RawReader>(folder / "raw.h5");
  int compared = 0;
  for (std::size_t n = 0; n < levels.volumes().size(); ++n) {
    const auto same =
        std::ranges::find(raw.volumes(), levels.volumes()[n].index, &pipeline::RawVolume::index);
    if (same == raw.volumes().end() || !same->whole)
      continue;
    const std::string out = folder / "v.nrrd";
    run_well({"reconstruct", "--spectra", folder / "raw.h5", "--volume",
              std::to_string(same - raw.volumes().begin()), "--u8", "--out", out});
    pipeline::Volume volume{levels.facts().geometry};
    ASSERT_TRUE(levels.read(n, volume));
    const auto again = pipeline::read_nrrd(out);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->geometry.depths, volume.geometry.depths);
    EXPECT_NEAR(again->geometry.a_mm(), volume.geometry.a_mm(), 1e-9);
    EXPECT_NEAR(again->geometry.b_mm(), volume.geometry.b_mm(), 1e-9);
    EXPECT_EQ(std::get<std::vector<std::uint8_t>>(again->levels), volume.levels) << n;
    std::filesystem::remove(out);
    ++compared;
  }
  EXPECT_GE(compared, 2);
}

// Without the averaging of neighbours, which is not reconstruction.
void keep_neighbours_apart(const ScratchFolder& folder) {
  std::ostringstream text;
  text << std::ifstream{write_small_configuration(folder)}.rdbuf();
  std::string changed = text.str();
  changed.insert(changed.find("workers"), "neighbour_weights = [0.0, 1.0, 0.0]\n");
  folder.write("small.toml", changed);
}

TEST(RawSpectra, become_the_same_levels_again_bit_for_bit) {
  const ScratchFolder folder;
  auto words = small_raw_record(folder, {"--volumes", "5"});
  keep_neighbours_apart(folder);
  words.insert(words.end(), {"--out", folder / "r.h5", "--subject", "17"});
  const ProgramResult result = run_well(words);
  EXPECT_THAT(result.out, HasSubstr("raw.h5, "));
  const auto raw = must_open<pipeline::RawReader>(folder / "raw.h5");
  EXPECT_TRUE(raw.end().finished);
  EXPECT_EQ(raw.facts().subject, "17");
  EXPECT_TRUE(raw.facts().simulated);
  EXPECT_THAT(raw.end().camera, HasSubstr("simulated"));
  EXPECT_THAT(raw.facts().configuration, HasSubstr("neighbour_weights"));
  ASSERT_TRUE(raw.facts().has_backgrounds()); // the running one is there for each frame
  expect_same_levels(folder);
}

TEST(RawSpectra, of_a_bidirectional_scan_with_repeats_become_the_same_levels_again) {
  const ScratchFolder folder;
  auto words = small_raw_record(folder, {"--volumes", "4", "--bidirectional", "--repeats", "2"});
  keep_neighbours_apart(folder);
  words.insert(words.end(), {"--out", folder / "r.h5"});
  run_well(words);
  expect_same_levels(folder);
}

TEST(RawSpectra, are_kept_or_counted_while_they_are_shown) {
  const ScratchFolder folder;
  const std::string report = folder / "report.json";
  run_well(small_raw_record(folder, {"--duration", "3", "--report", report}));
  const auto raw = must_open<pipeline::RawReader>(folder / "raw.h5");
  const auto published = read_report(report)["volumes"]["published"].get<std::uint64_t>();
  EXPECT_GE(raw.frames().size() + raw.end().not_kept,
            (published - std::min<std::uint64_t>(published, 1)) * small_b_scans / 2);
  EXPECT_EQ(raw.end().not_kept, 0U);
  const auto spectra =
      raw.spectra(0, std::min<std::size_t>(raw.frames().size(), 200), pipeline::RawLines::all);
  ASSERT_TRUE(spectra) << spectra.error().message;
  for (int b = 0; b < spectra->shape().b_scans; ++b)
    EXPECT_EQ(spectra->find_fault(b), std::nullopt);
}

// Until so many frames can be read of the file.
bool keeps(const std::filesystem::path& file, std::size_t frames) {
  const auto kept = [&] {
    const auto reader = pipeline::RawReader::open(file);
    return reader ? reader->frames().size() : 0;
  };
  for (int i = 0; i < 600 && kept() < frames; ++i)
    std::this_thread::sleep_for(100ms);
  return kept() >= frames;
}

TEST(RawSpectra, of_a_program_that_was_killed_can_be_read) {
  const ScratchFolder folder;
  ProgramRun run{octascope_command(small_raw_record(folder, {"--duration", "100"}))};
  ASSERT_TRUE(keeps(folder / "raw.h5", 3 * small_b_scans));
  run.send_signal(SIGKILL);
  static_cast<void>(run.wait(60s));
  const auto reader = must_open<pipeline::RawReader>(folder / "raw.h5");
  EXPECT_FALSE(reader.end().finished);
  const auto spectra = reader.spectra(0, reader.frames().size(), pipeline::RawLines::all);
  ASSERT_TRUE(spectra) << spectra.error().message;
  for (int b = 0; b < spectra->shape().b_scans; ++b)
    EXPECT_EQ(spectra->find_fault(b), std::nullopt);
  run_well({"info", folder / "raw.h5"});
}

TEST(RawSpectra, whose_file_is_removed_are_a_failure) {
  const ScratchFolder folder;
  ProgramRun run{octascope_command(small_raw_record(folder, {"--duration", "100"}))};
  ASSERT_TRUE(keeps(folder / "raw.h5", 1));
  std::filesystem::remove(folder / "raw.h5");
  std::this_thread::sleep_for(1s);
  run.send_signal(SIGINT);
  const ProgramResult result = run.wait(60s);
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.err, HasSubstr("raw.h5: was removed or moved"));
}

TEST(RawSpectra, that_cannot_begin_leave_no_levels_in_the_way_of_another_attempt) {
  const ScratchFolder folder;
  folder.write("raw.h5", "mine");
  const ProgramResult result =
      run_octascope(small_raw_record(folder, {"--volumes", "2", "--out", folder / "r.h5"}));
  EXPECT_NE(result.exit_status, 0);
  EXPECT_THAT(result.err, HasSubstr("raw.h5: cannot be made"));
  EXPECT_FALSE(std::filesystem::exists(folder / "r.h5"));
}

// The status of a run whose socket lies there; null where nobody answers (yet).
nlohmann::json status_of(const std::filesystem::path& socket) {
  const ProgramResult result = run_octascope({"status", "--json", "--socket", socket});
  return result.exit_status == 0 ? nlohmann::json::parse(result.out, nullptr, false)
                                 : nlohmann::json{};
}

std::uint64_t displayed(const nlohmann::json& status) {
  return status.is_object() && status.contains("volumes")
             ? status["volumes"].value("displayed", std::uint64_t{0})
             : 0;
}

// A program that records to a disk which a file "stopped" on it brings to a stand.
class StoppedDisk : public testing::Test {
protected:
  void SetUp() override {
    if (sanitized)
      GTEST_SKIP() << "the sanitizer must be the first library";
    std::filesystem::create_directory(folder / "disk");
  }
  void start() {
    std::vector<std::string> words{"env", "RUNTIME_DIRECTORY=" + folder.path().string(),
                                   std::string{"LD_PRELOAD="} + OCTASCOPE_STOPPED_DISK_LIBRARY,
                                   "OCTASCOPE_STOPPED_DISK=" + stopped.string()};
    auto record = octascope_command(small_raw_record(folder, {"--duration", "300"}));
    record.back() = file;
    words.insert(words.end(), record.begin(), record.end());
    run = std::make_unique<ProgramRun>(words);
  }
  template <class Condition> bool comes_true(const Condition& condition) const {
    for (int i = 0; i < 1000 && run->running(); ++i, std::this_thread::sleep_for(100ms))
      if (condition(status_of(folder / "status.sock")))
        return true;
    return false;
  }
  bool displays(std::uint64_t volumes) const {
    return comes_true([&](const auto& status) { return displayed(status) >= volumes; });
  }
  void end() const {
    run->send_signal(SIGINT);
    const ProgramResult result = run->wait(60s);
    EXPECT_EQ(result.exit_status, 0) << result.describe();
    EXPECT_THAT(result.out, testing::ContainsRegex("raw.h5, [0-9]+ frames, [1-9][0-9]* not kept"));
  }

  const ScratchFolder folder;
  const std::filesystem::path stopped = folder / "disk/stopped";
  const std::filesystem::path file = folder / "disk/raw.h5";
  std::unique_ptr<ProgramRun> run;
};

// More than there are slots for comes meanwhile.
TEST_F(StoppedDisk, has_raw_spectra_counted_and_the_display_goes_on) {
  start();
  ASSERT_TRUE(run->wait_for_thread("octa-raw-sync", 60s));
  folder.write("disk/stopped", "");
  ASSERT_TRUE(displays(1));
  constexpr std::uint64_t most_slots = 1024; // of the recorder
  EXPECT_TRUE(
      displays(displayed(status_of(folder / "status.sock")) + most_slots / small_b_scans + 10));
  std::filesystem::remove(stopped);
  end();
  const auto raw = must_open<pipeline::RawReader>(file);
  EXPECT_GT(raw.end().not_kept, 0U);
  EXPECT_GE(raw.frames().size(), most_slots);
}

TEST_F(StoppedDisk, from_the_start_on_holds_up_no_display_and_is_recorded_to_later) {
  folder.write("disk/stopped", "");
  start();
  ASSERT_TRUE(displays(3));
  EXPECT_TRUE(comes_true([](const auto& status) {
    return status.is_object() &&
           status.dump().find("its disk has not made the file") != std::string::npos;
  }));
  std::filesystem::remove(stopped);
  EXPECT_TRUE(
      comes_true([this](const auto&) { return std::filesystem::file_size(file) > 1'000'000; }));
  end();
  const auto raw = must_open<pipeline::RawReader>(file);
  EXPECT_GT(raw.end().not_kept, 0U);
  EXPECT_GT(raw.frames().size(), 0U);
}

TEST(RawSpectra, end_before_the_disk_is_full) {
  const ScratchFolder folder;
  const std::filesystem::path disk = folder / "disk";
  std::filesystem::create_directory(disk);
  std::vector<std::string> words{"unshare",
                                 ::geteuid() == 0 ? "-m" : "-rm",
                                 "sh",
                                 "-c",
                                 "mount -t tmpfs -o size=257m tmpfs \"$0\" && \"$@\"",
                                 disk};
  std::vector<std::string> nothing = words;
  nothing.emplace_back("true");
  if (run_program(nothing).exit_status != 0)
    GTEST_SKIP() << "no disk can be mounted here";
  auto record = octascope_command(small_raw_record(folder, {"--volumes", "20"}));
  record.back() = disk / "raw.h5";
  words.insert(words.end(), record.begin(), record.end());
  const ProgramResult result = run_program(words);
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.err, testing::AllOf(HasSubstr("are left on its disk"),
                                         testing::ContainsRegex("it holds [1-9][0-9]* frames")));
}

TEST(Capture, keeps_whole_volumes_that_every_command_takes) {
  const ScratchFolder folder;
  const ProgramResult result = run_well(small_capture(folder, {"--volumes", "2"}));
  EXPECT_THAT(result.out, HasSubstr("SIMULATED"));
  const auto raw = must_open<pipeline::RawReader>(folder / "c.h5");
  EXPECT_EQ(raw.frames().size(), 2U * small_b_scans);
  EXPECT_TRUE(raw.first_whole_volume());
  const ProgramResult info = run_well({"info", folder / "c.h5"});
  EXPECT_THAT(info.out, testing::AllOf(HasSubstr("raw spectra"), HasSubstr("of which 24 are kept"),
                                       HasSubstr("2, of which 2 are whole")));
  run_well({"reconstruct", "--spectra", folder / "c.h5", "--out", folder / "v.nrrd"});
  run_well({"run", "--spectra", folder / "c.h5", "--display", "offscreen", "--size", "320x180",
            "--volumes", "2"});
  run_well({"render", "--spectra", folder / "c.h5", "--out", folder / "v.png"});
  const ProgramResult refused = run_octascope({"reconstruct", "--spectra", folder / "c.h5",
                                               "--shape", "3,3,1024", "--out", folder / "w.nrrd"});
  EXPECT_EQ(refused.exit_status, 2);
  EXPECT_THAT(refused.err, HasSubstr("expected none, or 20,24,128"));
}

// What a calibration does not say of the scan, the recording does.
TEST(Capture, says_how_wide_the_scan_is_to_another_calibration) {
  const ScratchFolder folder;
  run_well(small_capture(folder, {"--volumes", "1"}));
  const auto other = folder.write("other.toml", "[spectrometer]\nsamples = 128\n"
                                                "[k_linear]\npolynomial = [0.0, 127.0]\n"
                                                "[depth]\nspacing_um = 3.4\n");
  const ProgramResult result =
      run_well({"reconstruct", "--spectra", folder / "c.h5", "--calibration", other.string(),
                "--out", folder / "v.nrrd"});
  EXPECT_THAT(result.err, testing::Not(HasSubstr("assumed")));
  const auto volume = must(pipeline::read_nrrd(folder / "v.nrrd"));
  const auto plan = must_open<pipeline::RawReader>(folder / "c.h5").facts().plan;
  EXPECT_NEAR(volume.geometry.a_spacing_um, plan.a_spacing_um, 1e-6);
  EXPECT_NEAR(volume.geometry.b_spacing_um, plan.b_spacing_um, 1e-6);
  EXPECT_NEAR(volume.geometry.depth_spacing_um, 3.4, 1e-6);
}

// Spectra that are known, played slowly: every second line has three counts more.
std::vector<std::string> capture_of_known(const ScratchFolder& folder, const std::string& out,
                                          const std::vector<std::string>& more) {
  std::vector<std::uint16_t> counts(2 * 64 * 64);
  for (std::size_t i = 0; i < counts.size(); ++i)
    counts[i] = static_cast<std::uint16_t>(1000 + i % 64 + (i / 64 % 2 == 0 ? 0 : 3));
  const std::string file = folder / "known.raw";
  std::ofstream{file, std::ios::binary}.write(reinterpret_cast<const char*>(counts.data()),
                                              static_cast<std::streamsize>(2 * counts.size()));
  std::vector<std::string> words{"capture",
                                 "--spectra",
                                 file,
                                 "--shape",
                                 "2,64,64",
                                 "--config",
                                 write_small_configuration(folder).string(),
                                 "--out",
                                 folder / out};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(Capture, averages_lines_into_one) {
  const ScratchFolder folder;
  run_well(capture_of_known(folder, "mean.h5", {"--average", "--volumes", "3"}));
  const auto raw = must_open<pipeline::RawReader>(folder / "mean.h5");
  ASSERT_EQ(raw.frames().size(), 1U);
  const int lines = raw.facts().averaged_lines;
  EXPECT_EQ(lines % 64, 0);
  EXPECT_GE(lines, 3 * 64); // a busy machine loses sweeps
  EXPECT_LE(lines, 6 * 64);
  const auto spectra = raw.spectra(0, 1, pipeline::RawLines::all);
  ASSERT_TRUE(spectra) << spectra.error().message;
  EXPECT_EQ(spectra->find_fault(0), std::nullopt);
  const auto* const mean = reinterpret_cast<const float*>(spectra->b_scan(0).data());
  for (int p = 0; p < 64; ++p)
    EXPECT_FLOAT_EQ(mean[p], 1001.5F + static_cast<float>(p));
  EXPECT_THAT(run_well({"info", folder / "mean.h5"}).out, HasSubstr("one line, the mean of"));
  const ProgramResult refused =
      run_octascope({"reconstruct", "--spectra", folder / "mean.h5", "--out", folder / "v.nrrd"});
  EXPECT_EQ(refused.exit_status, 2);
  EXPECT_THAT(refused.err, HasSubstr("expected a volume of spectra"));
}

TEST(Capture, ends_after_so_many_lines) {
  const ScratchFolder folder;
  run_well(capture_of_known(folder, "lines.h5", {"--lines", "150"}));
  const auto raw = must_open<pipeline::RawReader>(folder / "lines.h5");
  EXPECT_EQ(raw.frames().size(), 3U); // of 64 lines
}

// The real mirrors as a camera of 12 bits has them; a mean serves as well as lines.
TEST(Capture, of_mirrors_is_what_calibrate_takes) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/mirror1_f32_1024.raw");
  const ScratchFolder folder;
  const auto captured = [&](const std::string& name, std::vector<std::string> more) {
    const auto curve = pipeline::read_float_curve(
        test_data_folder() / "sd-oct-tissue" / (name + "_f32_1024.raw"), 1024);
    EXPECT_TRUE(curve);
    std::vector<std::uint16_t> counts;
    for (int line = 0; curve && line < 64; ++line)
      for (const float value : *curve)
        counts.push_back(static_cast<std::uint16_t>(std::lround(value * 1000)));
    const std::string file = folder / (name + ".raw");
    std::ofstream{file, std::ios::binary}.write(reinterpret_cast<const char*>(counts.data()),
                                                static_cast<std::streamsize>(2 * counts.size()));
    more.insert(more.begin(),
                {"capture", "--spectra", file, "--shape", "2,32,1024", "--config",
                 write_small_configuration(folder).string(), "--out", folder / (name + ".h5")});
    run_well(more);
    return (folder / (name + ".h5")).string();
  };
  const ProgramResult found =
      run_well({"calibrate", "--mirror", captured("mirror1", {"--lines", "100"}), "--mirror",
                captured("mirror2", {"--lines", "100", "--average"}), "--out",
                folder / "found.toml", "--json"});
  const auto verdict = nlohmann::json::parse(found.out, nullptr, false);
  ASSERT_TRUE(verdict.is_object() && verdict["mirrors"].size() == 2) << found.describe();
  for (const auto& mirror : verdict["mirrors"]) {
    EXPECT_GT(mirror["fwhm_before_bins"].get<double>(), 7) << mirror;
    EXPECT_LE(mirror["fwhm_after_bins"].get<double>(), 2.5) << mirror;
  }
}

TEST(Capture, writes_over_nothing_and_needs_a_camera) {
  const ScratchFolder folder;
  folder.write("c.h5", "mine");
  EXPECT_THAT(run_octascope(small_capture(folder, {})).err, HasSubstr("never written over"));
  EXPECT_EQ(std::filesystem::file_size(folder / "c.h5"), 4U);
  const ProgramResult none = run_octascope({"record"});
  EXPECT_EQ(none.exit_status, 2);
  EXPECT_THAT(none.err, HasSubstr("--raw FILE.h5 or both"));
}

} // namespace
} // namespace octascope::tests

// octascope commission on the twins: from no configuration to a calibrated picture, by answers.
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/calibration/calibration.h"
#include "pipeline/calibration_finder/axial_psf.h"
#include "pipeline/calibration_finder/fringe.h"
#include "sim/spectrometer/spectrometer.h"
#include "tests/program/program_support.h"
#include "tests/support/must.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

// A scan that is soon over, but fine enough for the target's bars.
constexpr const char* small_scan = "\n\n120\n20\n60\n100000\n\n\n\n"; // "do", its numbers, "next"
constexpr const char* done = "\n\n";                                  // a step that asks nothing
constexpr const char* placed = "\n\n\n"; // one that asks to place something
constexpr const char* skipped = "skip\n";

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream{file, std::ios::binary}.rdbuf();
  return text.str();
}

// commission --sim into the folder "f"; `shell` comes before it.
ProgramResult commission(const ScratchFolder& folder, const std::string& answers,
                         const std::string& shell = "") {
  const auto file = folder.write("answers", answers);
  std::vector<std::string> words{"sh", "-c", shell + "exec \"$@\" < \"$0\"", file.string()};
  for (auto& word : octascope_command({"commission", "--sim", "--out", folder / "f"}))
    words.push_back(std::move(word));
  return run_program(std::move(words), 300s);
}

nlohmann::json state_in(const ScratchFolder& folder) {
  return read_report(folder / "f" / "commission.json");
}

std::string outcome(const nlohmann::json& state, const std::string& step) {
  return state.at("steps").value(step, nlohmann::json::object()).value("outcome", "");
}

// What is true of the twin.
pipeline::Calibration true_calibration(const sim::Spectrometer& spectrometer) {
  auto calibration = pipeline::Calibration::identity(spectrometer.samples());
  calibration.positions = spectrometer.true_k_positions();
  calibration.dispersion_rad = spectrometer.true_dispersion_rad();
  return calibration;
}

// Mirrors at depths that nobody calibrated with: as narrow as with the true curves, and where they
// are. Beyond half of the depth range the interpolation alone makes them a little broader than 2.5.
void expect_narrow_mirrors(const pipeline::Calibration& found) {
  const auto spectrometer = must(sim::Spectrometer::make({}));
  for (const double depth_bin : {60.0, 180.0, 240.0, 330.0}) {
    const std::vector<sim::Reflector> mirror{{depth_bin, 400, 1}};
    const auto line = pipeline::remove_slow_part(spectrometer.mean_counts(mirror));
    const auto spread = pipeline::measure_axial_psf(line, found);
    const auto best = pipeline::measure_axial_psf(line, true_calibration(spectrometer));
    EXPECT_LE(spread.fwhm_bins, depth_bin > 256 ? 2.55 : 2.5) << depth_bin;
    EXPECT_LE(spread.fwhm_bins, 1.02 * best.fwhm_bins) << depth_bin;
    EXPECT_NEAR(spread.peak_bin, depth_bin, 0.5) << depth_bin;
  }
}

TEST(Commission, leads_from_nothing_to_a_calibrated_picture) {
  const ScratchFolder folder;
  const std::string answers = std::string{small_scan} + done + placed + placed + placed + placed +
                              placed + placed + "\n\n\n\n\n" + done + done;
  const ProgramResult result = commission(folder, answers);
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("pulses answered        5 of 5"),
                    HasSubstr("orientation            upright"), Not(HasSubstr("FAILED"))));
  const auto state = state_in(folder);
  EXPECT_NEAR(state.at("values").at("a_spacing_um").get<double>(), 25, 0.5);
  EXPECT_NEAR(state.at("values").at("b_spacing_um").get<double>(), 50, 1.5);

  const auto calibration =
      must(pipeline::Calibration::load(folder / "f" / "calibration.toml", 1024));
  expect_narrow_mirrors(calibration);
  EXPECT_NEAR(calibration.depth_spacing_um, 3.5, 0.02);

  run_well({"run", "--config", folder / "f" / "octascope.toml", "--display", "offscreen", "--size",
            "640x360", "--volumes", "2", "--snapshot", folder / "p.png", "--report",
            folder / "r.json"});
  EXPECT_GT(read_report(folder / "r.json").at("volumes").at("displayed"), 0);
  EXPECT_EQ(read_snapshot(folder / "p.png").width, 640);

  const std::string report = text_of(folder / "f" / "report.html");
  EXPECT_THAT(report,
              AllOf(HasSubstr("SIMULATED"), HasSubstr("FWHM"), HasSubstr("upright"),
                    HasSubstr("src=\"data:image/png;base64,iVBORw0KGgo"), HasSubstr("an upright F"),
                    HasSubstr("file = &quot;calibration.toml&quot;"), HasSubstr("</html>"),
                    Not(HasSubstr("src=\"http"))));
}

// A mirror for the tissue: the spreads are narrow, but the depths are wrong.
TEST(Commission, doubts_a_calibration_that_a_wrong_tissue_decided) {
  const ScratchFolder folder;
  const ProgramResult result =
      commission(folder, std::string{small_scan} + skipped + skipped + placed + placed + placed +
                             "\nmirror_far\nyes\n\n" + placed + "quit\n");
  EXPECT_THAT(result.out, HasSubstr("WARNING: the mirrors lay on either side of zero delay"))
      << result.describe();
  EXPECT_EQ(outcome(state_in(folder), "calibration"), "done") << result.describe();
}

TEST(Commission, goes_on_where_it_was_left_and_repeats_what_is_asked_for) {
  const ScratchFolder folder;
  // "repeat" after the dark, then the answers end.
  const ProgramResult first =
      commission(folder, std::string{small_scan} + skipped + skipped + "\n\nrepeat\n\n\n");
  EXPECT_EQ(first.exit_status, 1) << first.describe();
  EXPECT_THAT(first.err, HasSubstr("the input has ended; the same command goes on from there"));
  EXPECT_EQ(outcome(state_in(folder), "dark"), "done");
  EXPECT_EQ(state_in(folder).at("values").at("dark"), "dark-2.h5");
  const std::string dark = text_of(folder / "f" / "dark.h5");
  EXPECT_FALSE(dark.empty());

  // Keeps the camera, skips the trigger again, keeps the dark, ends at the near mirror.
  const ProgramResult second =
      commission(folder, std::string{"\n"} + skipped + skipped + "keep\nquit\n");
  EXPECT_EQ(second.exit_status, 1) << second.describe();
  EXPECT_THAT(second.err, HasSubstr("ended at step 5 of 11, \"Mirror, near\""));
  EXPECT_EQ(state_in(folder).at("values").at("a_scans"), 120);
  EXPECT_EQ(outcome(state_in(folder), "trigger"), "skipped");
  EXPECT_EQ(text_of(folder / "f" / "dark.h5"), dark); // nothing was overwritten
}

// The dark is done again after the calibration that is made of it.
TEST(Commission, says_what_is_outdated_until_it_is_repeated) {
  const ScratchFolder folder;
  const std::string begun = std::string{small_scan} + skipped + skipped;
  const std::string calibrated = begun + placed + placed + placed + skipped + placed;
  commission(folder, calibrated + "quit\n"); // at the target
  ASSERT_EQ(outcome(state_in(folder), "calibration"), "done");
  EXPECT_THAT(text_of(folder / "f" / "report.html"), Not(HasSubstr("Outdated")));

  const std::string to_dark = std::string{"keep\n"} + skipped + skipped;
  const std::string after_dark = std::string{"keep\nkeep\n"} + skipped;
  const ProgramResult redone =
      commission(folder, to_dark + "repeat\n" + "\n\n" + after_dark + "keep\nquit\n");
  EXPECT_THAT(redone.out, HasSubstr("OUTDATED: done before \"Dark\" was last done\n"
                                    "Repeat it? (repeat, keep, quit) [repeat]"))
      << redone.describe();
  EXPECT_THAT(text_of(folder / "f" / "report.html"),
              HasSubstr("<b>Outdated:</b> done before \"Dark\" was last done."));

  const ProgramResult repeated =
      commission(folder, to_dark + "keep\n" + after_dark + placed + "quit\n");
  EXPECT_THAT(repeated.out, HasSubstr("OUTDATED")) << repeated.describe();
  EXPECT_THAT(text_of(folder / "f" / "report.html"), Not(HasSubstr("Outdated")));
  EXPECT_EQ(state_in(folder).at("values").at("calibration"), "calibration-2.toml");
}

TEST(Commission, a_step_that_is_done_again_and_finds_the_same_makes_nothing_outdated) {
  const ScratchFolder folder;
  commission(folder, std::string{small_scan} + skipped + skipped + "\n\n\nquit\n");
  const auto dark = [&] {
    return commission(folder,
                      "repeat\n\n\n\n\n\n\n\n\n" + std::string{skipped} + skipped + "keep\nquit\n")
        .out;
  };
  EXPECT_THAT(dark(), AllOf(HasSubstr("Done before"), Not(HasSubstr("OUTDATED"))));
  const ProgramResult other = commission(
      folder, "repeat\n\n\n\n61\n\n\n\n\n" + std::string{skipped} + skipped + "keep\nquit\n");
  EXPECT_THAT(other.out, HasSubstr("OUTDATED: done before \"Camera\" was last done"))
      << other.describe();
}

// A folder of before the steps knew what they are made of.
TEST(Commission, takes_a_step_of_an_older_folder_for_up_to_date) {
  const ScratchFolder folder;
  commission(folder, std::string{small_scan} + skipped + skipped + "\n\n\nquit\n");
  auto state = state_in(folder);
  for (auto& step : state["steps"]) {
    step.erase("revision");
    step.erase("made_of");
  }
  folder.write("f/commission.json", state.dump());
  const ProgramResult result =
      commission(folder, "keep\n" + std::string{skipped} + skipped + "keep\nquit\n");
  EXPECT_THAT(result.out, AllOf(HasSubstr("Done before"), Not(HasSubstr("OUTDATED"))));
}

TEST(Commission, ends_with_quit_at_any_question) {
  const ScratchFolder folder;
  const auto expect_end = [&](const std::string& answers, const std::string& place) {
    const ProgramResult result = commission(folder, answers);
    EXPECT_EQ(result.exit_status, 1) << result.describe();
    EXPECT_THAT(result.out, Not(HasSubstr("FAILED")));
    EXPECT_THAT(result.err, HasSubstr("ended at step " + place));
  };
  expect_end("quit\n", "1 of 11");
  expect_end("\n\n120\nquit\n", "1 of 11"); // a number
  EXPECT_EQ(outcome(state_in(folder), "camera"), "");
  EXPECT_FALSE(state_in(folder).at("values").contains("a_scans"));
  const std::string to_dark = std::string{small_scan} + skipped + skipped;
  expect_end(to_dark + "\nquit\n", "4 of 11"); // a phantom
  EXPECT_EQ(outcome(state_in(folder), "camera"), "done");
  expect_end("\n" + std::string{skipped} + skipped + "\n\nq\n", "4 of 11"); // "Go on?"
  EXPECT_EQ(outcome(state_in(folder), "dark"), "done");
}

TEST(Commission, tells_a_mirror_and_a_tissue_that_are_none_at_their_own_step) {
  const ScratchFolder folder;
  const std::string begun = std::string{small_scan} + skipped + skipped + placed;
  const ProgramResult result =
      commission(folder, begun + "\ndark\nrepeat\nnothing\n\n\n" + // the near mirror
                             "\ndark\nskip\n" +                    // no far one
                             "\ndark\n\nquit\n");                  // no tissue
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("this is no mirror: contrast of the mean"),
                    HasSubstr("found \"nothing\", expected one of: anterior_eye, "),
                    HasSubstr("this is no tissue: nothing stands out of the noise at any depth"),
                    HasSubstr("Keep it all the same? (no, yes, quit) [no]")))
      << result.describe();
  const auto state = state_in(folder);
  EXPECT_EQ(outcome(state, "mirror_near"), "done");
  EXPECT_EQ(outcome(state, "mirror_far"), "skipped");
  EXPECT_EQ(outcome(state, "tissue"), "");
  EXPECT_THAT(text_of(folder / "f" / "report.html"),
              HasSubstr("<b>The last attempt failed:</b> tissue.h5: this is no tissue"));
}

TEST(Commission, warns_at_the_spectrum_of_what_is_not_good) {
  const ScratchFolder folder;
  const ProgramResult result =
      commission(folder, std::string{small_scan} + skipped + "\ndark\nrepeat\n\nquit\n");
  EXPECT_THAT(result.out, HasSubstr("WARNING: the fringe's contrast is ")) << result.describe();
  EXPECT_THAT(state_in(folder).at("steps").at("spectrum").at("warnings"), testing::SizeIs(0))
      << "of the mirror, at the second time";
}

TEST(Commission, tells_a_dark_that_is_none_and_one_mirror_taken_twice) {
  const ScratchFolder folder;
  const std::string answers = std::string{small_scan} + skipped + skipped +
                              "\nmirror_near\nrepeat\n\n\n" + // the dark, at the second time
                              placed +                        // the near mirror
                              "\nmirror_near\nrepeat\ndark\nskip\n" + // no far one
                              skipped + "\nskip\nquit\n";             // no calibration
  const ProgramResult result = commission(folder, answers);
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.out, AllOf(HasSubstr("this is no dark"), HasSubstr("too close to each other"),
                                HasSubstr("no mirror_far yet")));
  const auto state = state_in(folder);
  EXPECT_EQ(state.at("values").at("dark"), "dark-2.h5");
  EXPECT_FALSE(state.at("values").contains("mirror_far"));
  EXPECT_EQ(outcome(state, "mirror_far"), "skipped");
  EXPECT_EQ(outcome(state, "calibration"), "skipped");
}

TEST(Commission, asks_again_after_a_wrong_answer_but_not_for_ever) {
  const ScratchFolder folder;
  const ProgramResult result = commission(
      folder,
      "maybe\ndo\nmany\n3\n1024.5\n1024\n-5\n120\n20\n2\n60\nnan\n1e300\n100000\n0\n\n\n\nquit\n");
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("found \"maybe\", expected one of: do, skip, quit"),
                    HasSubstr("found \"many\", expected a whole number from 64 to 65536"),
                    HasSubstr("found \"nan\", expected a number from 1 to")));
  EXPECT_EQ(state_in(folder).at("values").at("b_scans"), 60);

  const ProgramResult never = commission(folder, "keep\na\nb\nc\ne\nf\ng\n");
  EXPECT_EQ(never.exit_status, 2) << never.describe();
  EXPECT_THAT(never.err, HasSubstr("5 answers in a row did not do"));
}

TEST(Commission, leaves_a_configuration_that_somebody_edited) {
  const ScratchFolder folder;
  std::string answers = small_scan;
  for (int step = 0; step < 9; ++step)
    answers += skipped;
  ASSERT_EQ(commission(folder, answers + done).exit_status, 0);
  const auto file = folder / "f" / "octascope.toml";
  std::ofstream{file, std::ios::app} << "# mine\n";
  std::string again = "keep\n";
  for (int step = 0; step < 9; ++step)
    again += skipped;
  const ProgramResult result = commission(folder, again + "repeat\n\n");
  EXPECT_EQ(result.exit_status, 0) << result.describe();
  EXPECT_THAT(result.out, HasSubstr("octascope.toml was changed by hand and is left as it is"));
  EXPECT_THAT(text_of(file), HasSubstr("# mine"));
  EXPECT_THAT(listing(folder / "f"), Contains(EndsWith("/octascope-2.toml")));
}

TEST(Commission, writes_no_configuration_that_a_run_would_refuse) {
  const ScratchFolder folder;
  std::string skips;
  for (int step = 0; step < 9; ++step)
    skips += skipped;
  ASSERT_EQ(commission(folder, small_scan + skips + done).exit_status, 0);
  const std::string good = text_of(folder / "f" / "octascope.toml");
  auto state = state_in(folder);
  state["values"]["b_scans"] = 70000;
  folder.write("f/commission.json", state.dump());
  const ProgramResult result = commission(folder, "keep\n" + skips + "repeat\nquit\n");
  EXPECT_THAT(result.out, AllOf(HasSubstr("FAILED: "), HasSubstr("b_scans is 70000")));
  EXPECT_EQ(text_of(folder / "f" / "octascope.toml"), good);
  EXPECT_THAT(listing(folder / "f"), Not(Contains(HasSubstr("unchecked"))));
}

TEST(Commission, says_so_when_the_folder_is_of_no_use) {
  const ScratchFolder folder;
  const auto refuse = [&](const std::string& place, const std::string& why, int status,
                          std::vector<std::string> more = {"--sim"}) {
    more.insert(more.begin(), {"commission", "--out", place});
    EXPECT_THAT(run_refused(folder, more, status), HasSubstr(why));
  };
  const auto file = folder.write("file", "");
  refuse(file, "cannot be made: ", 1);
  refuse(file / "below", "cannot be made: ", 1);
  refuse("/proc/none", "cannot be made: ", 1);
  refuse(folder.path(), "has files in it that are not of a commissioning", 2);
  std::filesystem::create_directory(folder / "f");
  const auto state = folder.write("f/commission.json", "{\"steps\": 3");
  refuse(folder / "f", "is damaged", 1);
  folder.write("f/commission.json",
               R"({"simulated": false, "steps": {}, "values": {"dark": ["x"]}})");
  refuse(folder / "f", "is damaged", 1);
  folder.write("f/commission.json", R"({"simulated": false, "steps": {}, "values": {}})");
  refuse(folder / "f", "was begun without --sim", 2);
}

// As on a full disk: files may grow to 16 KiB and no further, SIGXFSZ (25) is ignored.
TEST(Commission, loses_nothing_where_the_disk_is_full) {
  const ScratchFolder folder;
  const ProgramResult result =
      commission(folder, std::string{small_scan} + skipped + skipped + "\n\nquit\n",
                 "trap '' 25; ulimit -f 32; ");
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_EQ(result.signal, 0) << result.describe();
  EXPECT_THAT(result.out, HasSubstr("FAILED: "));
  EXPECT_EQ(outcome(state_in(folder), "camera"), "done");
  EXPECT_EQ(outcome(state_in(folder), "dark"), "");
}

} // namespace
} // namespace octascope::tests

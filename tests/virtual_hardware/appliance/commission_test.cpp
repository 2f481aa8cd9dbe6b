// octascope commission on the kernel's own devices: from no configuration to a calibrated live
// picture, by somebody who answers its questions and lays under the beam what it asks for.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "pipeline/calibration/calibration.h"
#include "tests/support/program/program_run.h"
#include "tests/virtual_hardware/appliance/virtual_rig.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::filesystem::path folder = "/tmp/microscope-1";
const std::filesystem::path log_file = "/tmp/commission.log";
const std::filesystem::path answers_file = "/tmp/commission.answers";

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream{file, std::ios::binary}.rdbuf();
  return text.str();
}

struct Answer {
  const char* question;    // what it says
  const char* answer = ""; // what stands in brackets
};

struct Step {
  std::vector<Answer> answers;
  const char* phantom = nullptr;          // what lies under the beam by then; null: as before
  std::vector<const char*> troubles = {}; // that it may tell of, beside a failure
  std::vector<std::uint8_t> treads = {};  // on the pedal, when it asks for that
};

const Answer placed{"Enter when it is so:"};

// The program, and who sits before it. A kernel of one processor in a busy machine loses a frame now
// and then: a step that fails for it, or did not go well, is done again, as anybody would.
class Operator {
public:
  explicit Operator(VirtualRig& rig) : rig_(rig) {
    ::mkfifo(answers_file.c_str(), 0600);
    std::vector<std::string> words{
        "sh", "-c", "exec \"$@\" < \"$0\" > " + log_file.string() + " 2>&1", answers_file};
    for (auto& word : octascope_command({"commission", "--out", folder}))
      words.push_back(std::move(word));
    run_ = std::make_unique<ProgramRun>(std::move(words));
    answers_.open(answers_file); // waits for the program
  }

  // False: a question did not come, or the step did not go well in five attempts.
  bool take(const Step& step) {
    if (step.phantom != nullptr) {
      auto phantom = virtual_rig_phantom(1, step.phantom);
      EXPECT_TRUE(phantom);
      rig_.look_at(std::move(*phantom));
    }
    if (!wait_for("Do it?"))
      return false;
    say("");
    for (int attempt = 0; attempt < 5; ++attempt) {
      const std::size_t before = heard_;
      if (!give(step, before))
        return false;
      const bool well = went_well(step, text_of(log_file).substr(before));
      say(well ? "" : "repeat");
      if (well)
        return true;
    }
    ADD_FAILURE() << text_of(log_file);
    return false;
  }

  ProgramResult end() {
    answers_.close();
    return run_->wait(60s);
  }

private:
  static bool went_well(const Step& step, const std::string& said) {
    const auto is_told = [&](const char* trouble) {
      return said.find(trouble) != std::string::npos;
    };
    return !is_told("FAILED: ") && std::ranges::none_of(step.troubles, is_told);
  }

  // Until the step asks what comes next. What it says is in the log from `since` on.
  bool give(const Step& step, std::size_t since) {
    for (const Answer& answer : step.answers) {
      if (!wait_for(answer.question))
        return false;
      if (asked_.find("Again?") != std::string::npos)
        return true;
      say(answer.answer);
    }
    return tread(step.treads, since) && wait_for("Go on?");
  }

  // Once it asks for that, or has failed.
  bool tread(const std::vector<std::uint8_t>& treads, std::size_t since) {
    const auto asked = [&] {
      const std::string log = text_of(log_file);
      return log.find("Press each switch", since) != log.npos ||
             log.find("Again?", since) != log.npos;
    };
    const auto deadline = WallClock::now() + 60s;
    while (!treads.empty() && !asked() && run_->running() && WallClock::now() < deadline)
      std::this_thread::sleep_for(10ms);
    for (const std::uint8_t switches : treads) {
      EXPECT_TRUE(rig_.tread(switches));
      std::this_thread::sleep_for(100ms);
    }
    return true;
  }

  void say(const std::string& answer) { answers_ << answer << std::endl; }

  // Also true where the step failed.
  bool wait_for(const std::string& question) {
    const auto deadline = WallClock::now() + 60s;
    for (;;) {
      const bool running = run_->running(); // what it said last is looked at, too
      const std::string log = text_of(log_file);
      asked_ = log.substr(std::min(log.size(), std::max(heard_, log.rfind('\n') + 1)));
      // The prompt ends with the brackets.
      const auto asks = [this](std::string_view what) {
        return asked_.find(what) != std::string::npos;
      };
      if (asked_.ends_with("] ") && asks("Keep it all the same?")) {
        heard_ = log.size();
        say("no"); // to Again?
        continue;
      }
      if (asked_.ends_with("] ") && (asks(question) || asks("Again?"))) {
        heard_ = log.size();
        return true;
      }
      if (!running || WallClock::now() > deadline) {
        ADD_FAILURE() << "\"" << question << "\" was not asked:\n" << log;
        return false;
      }
      std::this_thread::sleep_for(10ms);
    }
  }

  VirtualRig& rig_;
  std::unique_ptr<ProgramRun> run_;
  std::ofstream answers_;
  std::size_t heard_ = 0;
  std::string asked_; // the last question
};

const std::vector<Step> steps{
    {.answers = {{"Line camera:"},
                 {"Samples of a line"},
                 {"A-scans kept", "96"},
                 {"fly-back", "32"},
                 {"B-scans of a volume", "24"},
                 {"Lines a second", "3750"},
                 {"along a B-scan", "3.84"},
                 {"first B-scan to the last", "2.52"},
                 {"Significant bits", "12"}}},
    {.answers = {{"GPIO line of the trigger"},
                 {"scanner answers", "octascope-sync"},
                 {"Width of a pulse", "60000"}},
     .troubles = {"expected 3750", // lines a second, by stamps of which some come late
                  "not every pulse"}},
    {.answers = {placed}, .phantom = "mirror_near"},
    {.answers = {placed}, .phantom = "dark"},
    {.answers = {placed}, .phantom = "mirror_near"},
    {.answers = {placed}, .phantom = "mirror_far"},
    {.answers = {placed}, .phantom = "anterior_eye"},
    {.answers = {{"How far apart", "630"}}},
    {.answers = {placed, {"Side of the target's square"}, {"Use them?"}}, .phantom = "target"},
    {.answers = {{"Learn a pedal"}, {"Try it now?"}},
     .troubles = {"nothing came"},
     .treads = {1, 0, 2, 0, 4, 0}},
    {.answers = {}}};

TEST(CommissionOnVirtualRig, leads_from_nothing_to_a_calibrated_live_picture) {
  if (const std::string missing = virtual_rig_missing(); !missing.empty())
    GTEST_SKIP() << missing;
  std::filesystem::remove("/etc/octascope/octascope.toml");
  auto phantom = virtual_rig_phantom(1, "dark");
  ASSERT_TRUE(phantom) << phantom.error().message;
  auto rig = VirtualRig::make(std::move(*phantom));
  ASSERT_TRUE(rig) << rig.error().message;
  Operator person{**rig};
  const bool all = std::ranges::all_of(steps, [&](const Step& step) { return person.take(step); });
  const ProgramResult result = person.end();
  const std::string log = text_of(log_file);
  ASSERT_TRUE(all && result.exit_status == 0) << log;
  EXPECT_THAT(log, AllOf(HasSubstr("v4l2: "), HasSubstr("gpio: "),
                         HasSubstr("pulses answered        5 of 5"),
                         HasSubstr("orientation            upright"), HasSubstr("12 bits"),
                         HasSubstr("pressed or turned      left pedal, centre pedal, right pedal"),
                         Not(HasSubstr("SIMULATED"))));
  const auto calibration = pipeline::Calibration::load(folder / "calibration.toml", 1024);
  ASSERT_TRUE(calibration) << calibration.error().message;
  EXPECT_NEAR(calibration->depth_spacing_um, 3.5, 0.02);
  EXPECT_THAT(text_of(folder / "report.html"),
              AllOf(HasSubstr("FWHM"), HasSubstr("src=\"data:image/png;base64,"),
                    HasSubstr("</html>"), Not(HasSubstr("SIMULATED"))));

  auto eye = virtual_rig_phantom(1);
  ASSERT_TRUE(eye);
  (*rig)->look_at(std::move(*eye));
  const ProgramResult run =
      run_octascope({"run", "--config", folder / "octascope.toml", "--volumes", "2", "--snapshot",
                     "/tmp/p.png", "--report", "/tmp/r.json"});
  ASSERT_EQ(run.exit_status, 0) << run.describe();
  EXPECT_THAT(run.err, Not(HasSubstr("warning"))) << "calibrated, and nothing assumed";
  std::ifstream file{"/tmp/r.json"};
  const nlohmann::json report = nlohmann::json::parse(file, nullptr, false);
  EXPECT_EQ(report["simulated"], false);
  EXPECT_EQ(report["devices"]["line_camera"], "v4l2");
  EXPECT_GT(report["volumes"]["displayed"], 0);
}

} // namespace
} // namespace octascope::tests

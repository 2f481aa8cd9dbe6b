// Every volume that was planned is found again in the report, whatever broke and however it ended.
#include <csignal>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "tests/support/devices/random_faults.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/program/report_sums.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;

struct LedgerCase {
  std::string name;
  bool faults = false;
  std::string controls = {}; // what the pedal does
  std::vector<std::string> end = {"--duration", "3.3"};
};

class Ledger : public testing::TestWithParam<LedgerCase> {};

struct LedgerRun {
  std::string script; // of the faults
  ProgramResult result;
  nlohmann::json report;

  int planned() const { return report.at("volumes").at("planned"); }
};

LedgerRun run_of(const LedgerCase& wanted) {
  const ScratchFolder folder;
  const std::string report_file = folder / "report.json";
  std::vector<std::string> more{"--report", report_file};
  more.insert(more.end(), wanted.end.begin(), wanted.end.end());
  if (!wanted.controls.empty())
    more.insert(more.end(), {"--controls", folder.write("controls.toml", wanted.controls)});
  LedgerRun run;
  if (wanted.faults) {
    run.script = random_faults(fresh_seed(), 0, 10, 0.3);
    more.insert(more.end(), {"--faults", folder.write("faults.toml", run.script)});
  }
  run.result = run_octascope(small_run(folder, more));
  run.report = read_report(report_file);
  return run;
}

TEST_P(Ledger, accounts_for_every_planned_volume) {
  // Faults may keep the camera away for the whole of so short a run: then others are drawn.
  int planned = 0;
  for (int attempt = 0; attempt < (GetParam().faults ? 5 : 1) && planned == 0; ++attempt) {
    const LedgerRun run = run_of(GetParam());
    ASSERT_EQ(run.result.exit_status, 0) << run.result.describe() << run.script;
    EXPECT_EQ(unbalanced(run.report), "") << run.report.dump(2) << run.script;
    EXPECT_LE(run.report["volumes"]["unfinished"], 3 + 3)
        << "no more are built or passed over at once";
    planned = run.planned();
  }
  EXPECT_GE(planned, 1);
}

constexpr const char* freezes_at_the_end = "[[event]]\ntime_s = 2.0\nswitch = 1\nvalue = 1\n"
                                           "[[event]]\ntime_s = 2.1\nswitch = 1\nvalue = 0\n";

INSTANTIATE_TEST_SUITE_P(
    Runs, Ledger,
    testing::Values(LedgerCase{.name = "undisturbed"},
                    LedgerCase{.name = "of_a_number_of_volumes", .end = {"--volumes", "7"}},
                    LedgerCase{.name = "frozen_at_the_end", .controls = freezes_at_the_end},
                    LedgerCase{.name = "random_faults", .faults = true},
                    LedgerCase{.name = "random_faults_cut_short",
                               .faults = true,
                               .end = {"--duration", "2.05"}},
                    LedgerCase{.name = "random_faults_frozen",
                               .faults = true,
                               .controls = freezes_at_the_end,
                               .end = {"--duration", "4.7"}}),
    [](const auto& test) { return test.param.name; });

TEST(LedgerAfterASignal, balances_wherever_the_run_was) {
  std::mt19937 random{fresh_seed()};
  const ScratchFolder folder;
  const std::string report_file = folder / "report.json";
  ProgramRun run{
      octascope_command(small_run(folder, {"--duration", "100", "--report", report_file}))};
  ASSERT_TRUE(run.wait_for_thread("octa-camera", 60s));
  std::this_thread::sleep_for(std::chrono::milliseconds{400 + random() % 400});
  run.send_signal(SIGTERM);
  const ProgramResult result = run.wait(60s);
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  EXPECT_EQ(unbalanced(read_report(report_file)), "");
}

} // namespace
} // namespace octascope::tests

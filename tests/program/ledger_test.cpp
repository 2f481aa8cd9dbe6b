// Every volume that was planned is found again in the report, whatever broke and however it ended.
#include <csignal>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "tests/support/fresh_seed.h"
#include "tests/support/random_faults.h"
#include "tests/support/report_sums.h"

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

TEST_P(Ledger, accounts_for_every_planned_volume) {
  const ScratchFolder folder;
  const std::string report_file = folder / "report.json";
  std::vector<std::string> more{"--report", report_file};
  more.insert(more.end(), GetParam().end.begin(), GetParam().end.end());
  if (!GetParam().controls.empty())
    more.insert(more.end(), {"--controls", folder.write("controls.toml", GetParam().controls)});
  std::string script;
  if (GetParam().faults) {
    script = random_faults(fresh_seed(), 0, 10, 0.3);
    more.insert(more.end(), {"--faults", folder.write("faults.toml", script)});
  }
  const ProgramResult result = run_octascope(small_run(folder, more));
  ASSERT_EQ(result.exit_status, 0) << result.describe() << script;
  const nlohmann::json report = read_report(report_file);
  EXPECT_EQ(unbalanced(report), "") << report.dump(2) << script;
  EXPECT_GE(report["volumes"]["planned"], 1);
  EXPECT_LE(report["volumes"]["unfinished"], 3) << "no more are built at once";
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

// octascope commission at a terminal: the live spectrum, in a window beside it and without one.
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/program/program_support.h"
#include "tests/support/pictures/virtual_screen.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;

// "do", the numbers of a small scan, "next"; the trigger is skipped; "do" and a mirror is placed.
constexpr const char* up_to_the_spectrum = "\n\n120\n20\n20\n100000\n\n\n\nskip\n\n\n";

// The program at a terminal of its own, on the twins, with this environment; what is typed comes from
// a pipe that stays open.
class AtTerminal {
public:
  explicit AtTerminal(const std::string& environment = {}) {
    EXPECT_EQ(::mkfifo(pipe_.c_str(), 0600), 0);
    typed_.open(pipe_, std::ios::in | std::ios::out); // waits for no reader
    const auto command = octascope_command({"commission", "--sim", "--out", folder_ / "f"});
    run_ = std::make_unique<ProgramRun>(
        std::vector<std::string>{"sh", "-c", "exec script -qec \"$1\" /dev/null < \"$0\"", pipe_,
                                 fmt::format("{} {}", environment, fmt::join(command, " "))});
  }
  void type(const std::string& keys) { typed_ << keys << std::flush; }
  ProgramResult end() { return run_->wait(60s); }
  // Whether the step is done, or comes to be.
  bool spectrum_done() const {
    const auto is_done = [this] {
      const auto steps = read_report(folder_ / "f" / "commission.json").at("steps");
      return steps.contains("spectrum") && steps.at("spectrum").value("outcome", "") == "done";
    };
    for (int i = 0; i < 600 && !is_done(); ++i)
      std::this_thread::sleep_for(100ms);
    return is_done();
  }

private:
  const ScratchFolder folder_;
  const std::string pipe_ = folder_ / "typed";
  std::fstream typed_;
  std::unique_ptr<ProgramRun> run_;
};

TEST(SpectrumWindow, shows_the_live_spectrum_until_enter_there) {
  const VirtualScreen screen;
  if (!screen.running())
    GTEST_SKIP() << screen.problem();
  if (!program_exists("xdotool"))
    GTEST_SKIP() << "no xdotool here to press keys with";
  AtTerminal terminal;
  terminal.type(up_to_the_spectrum);
  const std::string window = "xdotool search --sync --onlyvisible --name '^octascope$'";
  const ProgramResult pressed =
      run_program({"sh", "-c", window + " windowfocus --sync key Return"}, 60s);
  ASSERT_EQ(pressed.exit_status, 0) << pressed.describe();
  EXPECT_TRUE(terminal.spectrum_done()); // nothing was typed at the terminal
  terminal.type("quit\n");
  const ProgramResult result = terminal.end();
  EXPECT_THAT(result.out, testing::HasSubstr("fringe contrast")) << result.describe();
  EXPECT_THAT(result.out, testing::Not(testing::HasSubstr("No display")));
}

TEST(SpectrumWindow, without_a_display_is_on_the_terminal_alone_and_says_so) {
  std::error_code none;
  const std::filesystem::directory_iterator cards{"/dev/dri", none};
  if (cards != std::filesystem::directory_iterator{})
    GTEST_SKIP() << "this machine has a console's display";
  AtTerminal terminal{"env -u DISPLAY -u WAYLAND_DISPLAY"};
  terminal.type(std::string{up_to_the_spectrum} + "\nquit\n");
  const ProgramResult result = terminal.end();
  EXPECT_THAT(result.out, testing::AllOf(testing::HasSubstr("No display: no window system"),
                                         testing::HasSubstr("on the terminal alone"),
                                         testing::HasSubstr("fringe contrast")))
      << result.describe();
  EXPECT_TRUE(terminal.spectrum_done());
}

} // namespace
} // namespace octascope::tests

// The console display under fire: each system call of opening, showing and closing fails once, with
// each error; it ends with success or an Error in words, gives back what it took, and works the
// next time. The calls are the display's own and those of libdrm, GBM, EGL and udev below it.
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hal/linux/kms/kms_display.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/virtual_hardware/kms/vkms_card.h"
#include "tests/virtual_hardware/support/fire.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::KmsConfig;
using hal::linux_backend::KmsDisplay;

class KmsFire : public testing::Test {
protected:
  void SetUp() override {
    if (!find_vkms())
      GTEST_SKIP() << no_vkms;
    config_.mode = "320x200M@60";
    config_.seat = KmsConfig::SeatUse::plain;
  }

  // What is wrong with how it ended.
  static std::optional<std::string> judge(const hal::Error& error, hal::DeviceState found,
                                          hal::DeviceState expected) {
    if (error.message.size() < 20)
      return "no words: \"" + error.message + '"';
    if (found != expected)
      return "the state is " + std::string{to_string(found)} + " after: " + error.message;
    return std::nullopt;
  }

  static std::optional<std::string> open(KmsDisplay& display) {
    const auto opened = display.open({});
    return opened ? std::nullopt : judge(opened.error(), display.state(), hal::DeviceState::absent);
  }

  static std::optional<std::string> show(KmsDisplay& display) {
    const auto flip = display.present();
    return flip ? std::nullopt : judge(flip.error(), display.state(), hal::DeviceState::failed);
  }

  static bool survives(Shot shot, const std::function<std::optional<std::string>()>& scenario) {
    const Holdings before = Holdings::now();
    std::optional<std::string> wrong;
    {
      const Firing firing{every_kind, shot};
      wrong = scenario();
    }
    if (!wrong && !(Holdings::now() == before))
      wrong = "descriptors or mappings are left";
    if (wrong)
      std::cerr << *wrong << std::endl;
    return !wrong;
  }

  static void expect_good(const FireReport& report) {
    for (const std::string& complaint : report.complaints)
      ADD_FAILURE() << complaint;
    RecordProperty("calls", static_cast<int>(report.calls));
    RecordProperty("runs", static_cast<int>(report.runs));
  }

  hal::linux_backend::MonotonicClock clock_;
  KmsConfig config_;
};

// Each shot in a process of its own: Mesa's software rasteriser writes to memory whether or not the
// kernel let it map the buffer, and dies of it. That one call is known; nothing else may end so.
TEST_F(KmsFire, opening_and_closing_survive_any_call_that_fails) {
  const auto scenario = [&]() -> std::optional<std::string> {
    KmsDisplay display{clock_, config_};
    if (auto wrong = open(display))
      return wrong;
    return display.state() == hal::DeviceState::ready ? show(display) : std::nullopt;
  };
  ASSERT_EQ(scenario(), std::nullopt);
  unsigned calls = 0;
  {
    const Firing counting{every_kind};
    ASSERT_EQ(scenario(), std::nullopt);
    calls = counting.calls();
  }
  EXPECT_GT(calls, 200U);
  RecordProperty("calls", static_cast<int>(calls));

  std::set<unsigned> deadly;
  // Every one takes minutes where there is one processor: every third, unless all are asked for.
  const unsigned step = std::getenv("OCTASCOPE_EVERY_CALL") != nullptr ? 1 : 3;
  for (unsigned call = 0; call < calls; call += step) {
    const int error = call % 2 == 0 ? ENODEV : ENOMEM; // both take the same ways, mostly
    const pid_t child = ::fork();
    if (child == 0) {
      ::alarm(30); // a hang ends here
      ::_exit(survives({call, error}, scenario) ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGSEGV)
      deadly.insert(call);
    else
      EXPECT_EQ(status, 0) << "call " << call << " with " << std::strerror(error);
  }
  EXPECT_LE(deadly.size(), 1U) << testing::PrintToString(deadly);
  EXPECT_EQ(scenario(), std::nullopt);
}

TEST_F(KmsFire, showing_survives_any_call_that_fails_with_any_error) {
  KmsDisplay display{clock_, config_};
  unsigned reopened = 0;
  const auto scenario = [&]() -> std::optional<std::string> {
    if (display.state() != hal::DeviceState::ready) {
      ++reopened;
      display.close();
      if (auto wrong = open(display))
        return wrong;
      return display.state() == hal::DeviceState::ready ? std::nullopt
                                                        : std::optional{"was not opened again"};
    }
    return show(display);
  };
  ASSERT_EQ(scenario(), std::nullopt);
  FireReport report = under_fire(every_kind, usual_errors(), scenario, false);
  // A run that ends with a display lost holds less than it began with; the next one takes it again.
  std::erase_if(report.complaints, [](const std::string& complaint) {
    return complaint.find("descriptors and") != std::string::npos;
  });
  expect_good(report);
  EXPECT_GE(report.calls, 4U);
  EXPECT_GE(reopened, 1U);
}

} // namespace
} // namespace octascope::tests

// The console display while system calls fail: each site of one of opening and closing, and each
// call of showing, fails once with each error; it ends with success or an Error in words, gives
// back what it took, and works the next time. The calls are the display's own and those of libdrm,
// GBM, EGL and udev below it.
#include <cerrno>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "hal/linux/kms/kms_display.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/virtual_hardware/kms/vkms_card.h"
#include "tests/virtual_hardware/support/site_sweep.h"
#include "tests/virtual_hardware/support/syscall_faults.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::KmsConfig;
using hal::linux_backend::KmsDisplay;

class KmsSyscallFaults : public testing::Test {
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

  hal::linux_backend::MonotonicClock clock_;
  KmsConfig config_;
};

// The two calls by which Mesa's software rasteriser maps the buffer that it draws into. It asks
// neither whether it succeeded, and nothing of ours is called between them and the drawing.
constexpr KnownDeath known_deaths[]{
    {"ioctl c01064b3: libdrm.so.2 drmIoctl < ", "_dri.so < libEGL_mesa.so.0 < ",
     "draws, although the buffer has no place to be mapped from (MODE_MAP_DUMB)"},
    {"mmap: ", "_dri.so < libEGL_mesa.so.0 < ", "draws, although the buffer was not mapped"},
};

TEST_F(KmsSyscallFaults, opening_and_closing_survive_whatever_fails_at_any_site) {
  SweepPlan plan;
  plan.scenario = [&]() -> std::optional<std::string> {
    KmsDisplay display{clock_, config_};
    if (auto wrong = open(display))
      return wrong;
    return display.state() == hal::DeviceState::ready ? show(display) : std::nullopt;
  };
  plan.known = known_deaths;
  const SweepReport report = sweep_sites(plan);
  print(report);
  for (const std::string& complaint : report.complaints)
    ADD_FAILURE() << complaint;
  EXPECT_GT(report.sites, 100U);
  EXPECT_EQ(report.missed, 0U);
  EXPECT_EQ(report.left_behind, 0U);
}

TEST_F(KmsSyscallFaults, showing_survives_any_call_that_fails_with_any_error) {
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
  SyscallFaultReport report = inject_faults(every_kind, usual_errors(), scenario, false);
  // A run that ends with a display lost holds less than it began with; the next one takes it again.
  std::erase_if(report.complaints, [](const std::string& complaint) {
    return complaint.find("descriptors and") != std::string::npos;
  });
  expect_good(report, 4);
  EXPECT_GE(reopened, 1U);
}

} // namespace
} // namespace octascope::tests

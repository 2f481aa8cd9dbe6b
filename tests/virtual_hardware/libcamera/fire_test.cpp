// The libcamera backend while system calls of its own and of libcamera's fail, one after the other.
#include <array>
#include <cerrno>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "hal/linux/libcamera/libcamera_scope_camera.h"
#include "tests/virtual_hardware/libcamera/vimc.h"
#include "tests/virtual_hardware/support/fire.h"

namespace octascope::tests {
namespace {

namespace backend = hal::linux_backend;
using namespace std::chrono_literals;

class LibcameraUnderFire : public testing::Test {
protected:
  void SetUp() override {
    if (!has_vimc())
      GTEST_SKIP() << no_vimc;
    auto started = backend::LibcameraSession::start();
    ASSERT_TRUE(started) << started.error().message;
    session_ = std::move(*started);
    ASSERT_TRUE(replug_vimc(*session_)) << backend::explain_absence().message;
  }
  // Opens, takes two pictures and closes: what is wrong with how it ended.
  std::optional<std::string> take_two_pictures() {
    backend::LibcameraScopeCamera camera{*session_, {}, clock_};
    if (const auto opened = camera.open({64, 48, 30}); !opened) {
      if (camera.state() != hal::DeviceState::absent)
        return "not opened, and not absent";
      return opened.error().message.empty() ? std::optional<std::string>{"no message"}
                                            : std::nullopt;
    }
    if (const auto started = camera.start(); !started)
      return started.error().message.empty() ? std::optional<std::string>{"no message"}
                                             : std::nullopt;
    for (int i = 0; i < 2; ++i) {
      const auto frame = camera.wait_frame(500ms);
      if (!frame)
        return camera.state() == hal::DeviceState::failed
                   ? std::nullopt
                   : std::optional<std::string>{"an error, and not failed"};
      if (*frame)
        camera.release((*frame)->buffer);
    }
    camera.close();
    return std::nullopt;
  }

  backend::MonotonicClock clock_;
  std::unique_ptr<backend::LibcameraSession> session_;
};

// Nothing crashes, hangs or lies, and the next run succeeds or says why not. Some hits make
// libcamera 0.0.3 unable to stop its camera, which is then abandoned with what it holds: that is
// counted apart.
TEST_F(LibcameraUnderFire, pictures_end_well) {
  constexpr std::array errors{EIO, EINTR};
  const FireReport report =
      under_fire(static_cast<unsigned>(CallKind::control) | static_cast<unsigned>(CallKind::map),
                 errors, [&] { return take_two_pictures(); });
  int left_behind = 0;
  for (const std::string& complaint : report.complaints) {
    if (complaint.find("descriptors and") != std::string::npos)
      ++left_behind;
    else
      ADD_FAILURE() << complaint;
  }
  std::printf("  %u calls, %u runs, after %d something was left behind\n", report.calls,
              report.runs, left_behind);
  EXPECT_GT(report.calls, 20U);
  EXPECT_LT(left_behind, static_cast<int>(report.runs) / 10);
}

} // namespace
} // namespace octascope::tests

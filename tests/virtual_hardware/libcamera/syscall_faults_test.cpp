// The libcamera backend while system calls fail, its own, libcamera's and libudev's: each site with
// each error that the kernel may give there. A fault has a process of its own, since libcamera
// 0.0.3 ends the program at some: those are known by name, and no other may.
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "hal/linux/libcamera/libcamera_scope_camera.h"
#include "tests/virtual_hardware/libcamera/vimc.h"
#include "tests/virtual_hardware/support/site_sweep.h"

namespace octascope::tests {
namespace {

namespace backend = hal::linux_backend;
using namespace std::chrono_literals;

// What libcamera 0.0.3 does, and nothing of ours can fix. None is a fault that Linux is known to
// give there: an eventfd is written to and read without waiting and without memory.
constexpr KnownDeath known_deaths[]{
    // Camera::configure(), start(), stop() … and CameraManager::stop() leave their work to the
    // thread of libcamera and wait without a limit until it is done. The appliance goes on: it says
    // that the microscope's camera does not answer (supervision/thread_watch.h).
    {"write: libcamera-base.so.0.0.3 libcamera::EventDispatcherPoll::interrupt < ",
     "pthread_cond_wait < libcamera-base.so.0.0.3 libcamera::",
     "waits for its thread, which it could not wake"},
};

class LibcameraSyscallFaults : public testing::Test {
protected:
  void SetUp() override {
    if (!has_vimc())
      GTEST_SKIP() << no_vimc;
  }

  std::optional<std::string> in_words(const hal::Error& error) {
    said_ = error.message;
    if (error.message.size() > 20)
      return std::nullopt;
    return "the message is only \"" + error.message + '"';
  }

  // Opens, takes two pictures and closes: what is wrong with how it ended.
  std::optional<std::string> take_two_pictures(backend::LibcameraSession& session) {
    backend::LibcameraScopeCamera camera{session, {}, clock_};
    taken_ = 0;
    said_.clear();
    if (const auto opened = camera.open({64, 48, 30}); !opened)
      return camera.state() == hal::DeviceState::absent ? in_words(opened.error())
                                                        : "not opened, and not absent";
    if (const auto started = camera.start(); !started)
      return in_words(started.error());
    for (int i = 0; i < 2; ++i) {
      const auto frame = camera.wait_frame(500ms);
      if (!frame)
        return camera.state() == hal::DeviceState::failed ? in_words(frame.error())
                                                          : "an error, and not failed";
      if (!*frame)
        continue;
      camera.release((*frame)->buffer);
      ++taken_;
    }
    camera.close();
    return std::nullopt;
  }

  bool start_session() {
    auto started = backend::LibcameraSession::start();
    if (started)
      session_ = std::move(*started);
    return started.has_value();
  }

  // Nothing fails any more, so there are pictures, as soon as it was closed and opened again a few
  // times: the appliance does that for as long as it runs.
  std::optional<std::string> use_again() {
    constexpr int most_tries = 3;
    const bool had_session = session_ != nullptr;
    if (!had_session && !start_session())
      return "libcamera cannot be started any more";
    std::optional<std::string> wrong;
    taken_ = 0;
    for (int tries = 0; tries < most_tries && taken_ == 0 && !wrong; ++tries)
      wrong = take_two_pictures(*session_);
    if (!wrong && taken_ == 0)
      wrong = "no picture came; it said: " + said_;
    if (!had_session)
      session_.reset();
    return wrong;
  }

  static void expect_good(const SweepReport& report, unsigned least_sites) {
    print(report);
    for (const std::string& complaint : report.complaints)
      ADD_FAILURE() << complaint;
    EXPECT_GE(report.sites, least_sites);
  }

  std::unique_ptr<backend::LibcameraSession> session_;
  int taken_ = 0;    // pictures
  std::string said_; // by the last Error
  backend::MonotonicClock clock_;
};

TEST_F(LibcameraSyscallFaults, cameras_are_looked_for_and_whatever_fails_ends_well) {
  SweepPlan plan;
  plan.scenario = [this]() -> std::optional<std::string> {
    const auto session = backend::LibcameraSession::start();
    if (!session)
      return in_words(session.error());
    (void)(*session)->cameras(); // perhaps fewer than there are
    return std::nullopt;
  };
  plan.afterwards = [this] { return use_again(); };
  plan.known = known_deaths;
  expect_good(sweep_sites(plan), 60);
}

TEST_F(LibcameraSyscallFaults, pictures_are_taken_and_whatever_fails_ends_well) {
  SweepPlan plan;
  // What a session makes once, it makes with the first picture.
  plan.begin = [this] { return start_session() && !use_again(); };
  plan.scenario = [this] { return take_two_pictures(*session_); };
  plan.end = [this] { session_.reset(); };
  plan.afterwards = [this] { return use_again(); };
  plan.known = known_deaths;
  expect_good(sweep_sites(plan), 40);
}

} // namespace
} // namespace octascope::tests

// That libcamera leaves the program's handling of its children's ends alone: what it does there may end it.
#include <csignal>

#include <gtest/gtest.h>

#include "hal/linux/libcamera/libcamera_session.h"
#include "hal/linux/system/system_error.h"
#include "hal/linux/system/system_files.h"

namespace octascope::tests {
namespace {

using Handler = void (*)(int, siginfo_t*, void*);

void of_ours(int, siginfo_t*, void*) {}

Handler handler() {
  struct sigaction now {};
  ::sigaction(SIGCHLD, nullptr, &now);
  return now.sa_sigaction;
}

std::size_t threads() {
  return hal::linux_backend::entries("/proc/self/task").size();
}

TEST(ChildSignals, are_handled_as_before_once_libcamera_runs_and_when_it_has_ended) {
  if (hal::linux_backend::udev_is_at_work())
    GTEST_SKIP() << "udev is at work, until when libcamera is not started; run it again";
  struct sigaction before {};
  struct sigaction ours {};
  ours.sa_sigaction = of_ours;
  ours.sa_flags = SA_SIGINFO | SA_RESTART;
  ASSERT_EQ(::sigaction(SIGCHLD, &ours, &before), 0);
  auto session = hal::linux_backend::LibcameraSession::start();
  ASSERT_TRUE(session) << session.error().message;
  const std::size_t without_libcamera = threads();
  (*session)->cameras();
  EXPECT_GT(threads(), without_libcamera) << "it was not started";
  EXPECT_EQ(handler(), of_ours);
  (*session)->restart();
  (*session)->cameras();
  EXPECT_EQ(handler(), of_ours);
  session->reset();
  EXPECT_EQ(handler(), of_ours);
  ::sigaction(SIGCHLD, &before, nullptr);
}

} // namespace
} // namespace octascope::tests

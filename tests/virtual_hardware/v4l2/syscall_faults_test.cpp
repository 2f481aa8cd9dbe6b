// The line camera while system calls fail: opened, started, one frame fetched and given back,
// stopped, started again, closed. It ends with success or an Error in words, and the next time all
// is well again.
#include <cerrno>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hal/linux/monotonic_clock.h"
#include "hal/linux/v4l2/v4l2_line_camera.h"
#include "tests/virtual_hardware/support/loopback_feeder.h"
#include "tests/virtual_hardware/support/syscall_faults.h"
#include "tests/virtual_hardware/v4l2/vivid.h"

namespace octascope::tests {
namespace {

using namespace hal;
using namespace hal::linux_backend;
using namespace std::chrono_literals;

constexpr unsigned ours = every_kind & ~static_cast<unsigned>(CallKind::write); // the feeder writes

LineCameraConfig small_config() {
  return {.format = {.samples_per_line = 256,
                     .lines_per_frame = 64,
                     .sample_type = SampleType::u16,
                     .significant_bits = 16,
                     .right_shift = 0},
          .line_rate_hz = 64e3,
          .buffers = 4};
}

std::optional<std::string> in_words(const Error& error) {
  if (error.message.size() > 20)
    return std::nullopt;
  return fmt::format("the message is only \"{}\"", error.message);
}

// One frame, or an Error; silence is what is wrong.
std::optional<std::string> fetch_one(LineCamera& camera) {
  const auto frame = camera.wait_frame(2s);
  if (!frame)
    return in_words(frame.error());
  if (!*frame)
    return "no frame came";
  camera.release((*frame)->buffer);
  return std::nullopt;
}

std::optional<std::string> use(LineCamera& camera, LoopbackFeeder* feeder) {
  if (const auto opened = camera.open(small_config()); !opened)
    return camera.state() == DeviceState::absent ? in_words(opened.error())
                                                 : "a failed open left it not absent";
  for (int round = 0; round < 2 && camera.state() == DeviceState::ready; ++round) {
    if (const auto started = camera.start(); !started)
      return in_words(started.error());
    if (feeder != nullptr) {
      const std::vector<std::byte> frame(feeder->frame_bytes());
      if (const auto written = feeder->write(frame); !written)
        return written.error().message;
    }
    if (auto wrong = fetch_one(camera))
      return wrong;
    camera.stop();
  }
  return std::nullopt;
}

// By its name, or looked for among all nodes.
void inject_into_loopback(bool by_name, unsigned kinds, std::span<const int> errors,
                          unsigned least_calls) {
  const auto node = LoopbackFeeder::find();
  if (!node)
    GTEST_SKIP() << "no v4l2loopback node: load the module, or run this in the bench's kernel";
  const LineFormat format = small_config().format;
  auto feeder = LoopbackFeeder::open(*node, format.samples_per_line, format.lines_per_frame);
  ASSERT_TRUE(feeder) << feeder.error().message;
  MonotonicClock clock;
  const auto scenario = [&] {
    V4l2LineCamera camera{{.node = by_name ? *node : ""}, clock};
    return use(camera, &*feeder);
  };
  const bool check_recovery = by_name;
  expect_good(inject_faults(kinds, errors, scenario, check_recovery), least_calls);
}

TEST(SyscallFaults, v4l2loopback) {
  inject_into_loopback(true, ours, usual_errors(), 30);
}

TEST(SyscallFaults, v4l2loopback_looked_for_among_all) {
  constexpr int errors[] = {EINTR, ENODEV, EACCES};
  inject_into_loopback(false, static_cast<unsigned>(CallKind::open), errors, 2);
}

TEST(SyscallFaults, vivid) {
  const auto vivid = Vivid::find();
  if (!vivid)
    GTEST_SKIP() << "no vivid device: `modprobe vivid`, or run this in the bench's kernel";
  vivid->reset();
  MonotonicClock clock;
  constexpr int errors[] = {ENODEV, ENOMEM};
  expect_good(
      inject_faults(
          ours, errors,
          [&]() -> std::optional<std::string> {
            V4l2LineCamera camera{{.node = vivid->node(), .input = Vivid::any_size_input}, clock};
            return use(camera, nullptr);
          },
          false),
      30);
}

} // namespace
} // namespace octascope::tests

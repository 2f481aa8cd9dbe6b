// The libcamera backend against vimc: pictures, faults, and what is left behind.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "hal/linux/libcamera/libcamera_scope_camera.h"
#include "pipeline/controls/scope_thread.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/libcamera/vimc.h"
#include "tests/virtual_hardware/support/resource_count.h"

namespace octascope::tests {
namespace {

namespace backend = hal::linux_backend;
using namespace std::chrono_literals;

class Vimc : public testing::Test {
protected:
  void SetUp() override {
    if (!has_vimc())
      GTEST_SKIP() << no_vimc;
    auto started = backend::LibcameraSession::start();
    ASSERT_TRUE(started) << started.error().message;
    session_ = std::move(*started);
    ASSERT_TRUE(replug_vimc(*session_)) << backend::explain_absence().message;
    camera_ = make_camera({});
  }
  std::unique_ptr<backend::LibcameraScopeCamera>
  make_camera(const backend::LibcameraScopeOptions& options) {
    return std::make_unique<backend::LibcameraScopeCamera>(*session_, options, clock_);
  }
  void open_and_start(hal::ScopeCameraConfig wanted = {}) {
    const auto opened = camera_->open(wanted);
    ASSERT_TRUE(opened) << opened.error().message;
    const auto started = camera_->start();
    ASSERT_TRUE(started) << started.error().message;
  }
  hal::ScopeFrame next_frame() {
    const auto frame = camera_->wait_frame(3s);
    if (!frame || !*frame) {
      ADD_FAILURE() << (frame ? "no frame in time" : frame.error().message);
      return {};
    }
    return **frame;
  }

  backend::MonotonicClock clock_;
  std::unique_ptr<backend::LibcameraSession> session_;
  std::unique_ptr<backend::LibcameraScopeCamera> camera_;
};

// libcamera's own threads and heap among it.
void expect_nothing_left_since(const ResourceCount& before) {
  const ResourceCount after = expect_no_leak(before, {.mappings = 3, .heap_bytes = 100'000});
  EXPECT_EQ(after.threads, before.threads);
}

// The sensor's test pattern of eight bars at 75 %, after a debayering that is rough at their edges:
// in each bar's middle the channels that are on exceed those that are off.
TEST_F(Vimc, picture_shows_the_eight_bars) {
  open_and_start();
  const hal::ScopeFrame frame = next_frame();
  ASSERT_EQ(frame.format, hal::PixelFormat::rgb8);
  EXPECT_NEAR(frame.width, 640, 6) << "the driver takes multiples of six";
  EXPECT_NEAR(frame.height, 480, 6);
  constexpr std::array<std::array<bool, 3>, 8> bars{{{true, true, true},
                                                     {true, true, false},
                                                     {false, true, true},
                                                     {false, true, false},
                                                     {true, false, true},
                                                     {true, false, false},
                                                     {false, false, true},
                                                     {false, false, false}}};
  for (std::size_t bar = 0; bar < bars.size(); ++bar) {
    const auto x = (2 * bar + 1) * static_cast<std::size_t>(frame.width) / 16;
    const auto y = static_cast<std::size_t>(frame.height / 2);
    const auto pixel =
        frame.pixels.subspan(y * static_cast<std::size_t>(frame.stride_bytes) + 3 * x, 3);
    for (std::size_t c = 0; c < 3; ++c) {
      const int value = std::to_integer<int>(pixel[c]);
      if (bars[bar][c])
        EXPECT_GT(value, 80) << "bar " << bar << ", channel " << c;
      else
        EXPECT_LT(value, 20) << "bar " << bar << ", channel " << c;
    }
  }
  camera_->release(frame.buffer);
}

TEST_F(Vimc, size_follows_the_request) {
  for (const auto& [width, height] : {std::pair{320, 240}, std::pair{1280, 720}}) {
    open_and_start({width, height, 30});
    const hal::ScopeFrame frame = next_frame();
    EXPECT_NEAR(frame.width, width, 6);
    EXPECT_NEAR(frame.height, height, 6);
    camera_->release(frame.buffer);
    camera_->close();
  }
}

TEST_F(Vimc, is_listed_and_chosen_by_name_and_never_when_it_is_the_line_cameras) {
  const auto cameras = session_->cameras();
  ASSERT_EQ(cameras.size(), 1U);
  EXPECT_NE(cameras[0].id.find("vimc"), std::string::npos);
  EXPECT_FALSE(cameras[0].taken);

  EXPECT_TRUE(make_camera({cameras[0].id, {}})->open({}));
  EXPECT_THAT(make_camera({"another camera", {}})->open({}),
              FailsWith(hal::ErrorCode::absent, cameras[0].id));

  std::vector<std::string> nodes;
  for (int i = 0; i < 64; ++i)
    nodes.push_back("/dev/video" + std::to_string(i));
  EXPECT_TRUE(session_->cameras(nodes)[0].taken);
  EXPECT_THAT(make_camera({"", nodes})->open({}), FailsWith(hal::ErrorCode::absent, "line camera"));
}

TEST_F(Vimc, a_camera_in_use_is_busy_and_then_free) {
  ASSERT_TRUE(camera_->open({}));
  const auto second = make_camera({});
  EXPECT_THAT(second->open({}), FailsWith(hal::ErrorCode::busy, "fuser"));
  camera_->close();
  EXPECT_TRUE(second->open({}));
}

TEST_F(Vimc, a_second_session_is_refused_in_words) {
  const auto second = backend::LibcameraSession::start();
  ASSERT_THAT(second, FailsWith(hal::ErrorCode::busy));
}

TEST_F(Vimc, opens_many_times_and_leaves_nothing) {
  const auto cycle = [&] {
    open_and_start();
    camera_->release(next_frame().buffer);
    camera_->stop();
    camera_->close();
  };
  for (int i = 0; i < 10; ++i)
    cycle();
  const ResourceCount before = resources_in_use();
  for (int i = 0; i < leak_cycles() && !HasFailure(); ++i)
    cycle();
  expect_nothing_left_since(before);
}

TEST_F(Vimc, is_unplugged_many_times_and_leaves_nothing) {
  const auto cycle = [&] {
    ASSERT_TRUE(camera_->open({}));
    unplug_vimc();
    camera_->close();
    EXPECT_THAT(camera_->open({}), FailsWith(hal::ErrorCode::absent));
    ASSERT_TRUE(replug_vimc(*session_));
  };
  for (int i = 0; i < 3; ++i)
    cycle();
  const ResourceCount before = resources_in_use();
  for (int i = 0; i < leak_cycles() && !HasFailure(); ++i) // each takes udevd about a second
    cycle();
  expect_nothing_left_since(before);
}

// libcamera 0.0.3 can neither stop nor drop a streaming camera that is gone, unless it is a USB
// one: what it holds then stays. This says how much, and that it is no more than that.
TEST_F(Vimc, unplugged_in_mid_stream_it_leaves_what_libcamera_cannot_drop_and_no_more) {
  constexpr std::size_t cycles = 5;
  const ResourceCount before = resources_in_use();
  for (std::size_t i = 0; i < cycles && !HasFailure(); ++i) {
    open_and_start();
    camera_->release(next_frame().buffer);
    unplug_vimc();
    auto frame = camera_->wait_frame(2s);
    for (int n = 0; n < 100 && frame; ++n) {
      if (*frame)
        camera_->release((*frame)->buffer);
      frame = camera_->wait_frame(2s);
    }
    ASSERT_THAT(frame, FailsWith(hal::ErrorCode::disconnected));
    camera_->close();
    ASSERT_TRUE(replug_vimc(*session_));
  }
  const ResourceCount after = resources_in_use();
  std::cout << "  before: " << before << "\n  after:  " << after << '\n';
  EXPECT_LE(after.descriptors, before.descriptors + 25 * cycles);
  EXPECT_LE(after.threads, before.threads + cycles);
}

// As the appliance runs it: the fault is recorded, and pictures come again by themselves.
TEST_F(Vimc, the_scope_thread_survives_unplug_and_replug) {
  pipeline::FaultLog faults;
  pipeline::Wakeup news;
  pipeline::ScopeThread thread{*camera_, {}, clock_, faults, news};
  const auto pictures = [&](int wanted) {
    int count = 0;
    for (int i = 0; i < 1000 && count < wanted; ++i) {
      std::this_thread::sleep_for(10ms);
      if (const hal::ScopeFrame* frame = thread.take_newest()) {
        EXPECT_NEAR(frame->width, 640, 6);
        ++count;
      }
    }
    return count;
  };
  thread.start({});
  EXPECT_EQ(pictures(5), 5);
  unplug_vimc();
  for (int i = 0; i < 500 && camera_->state() == hal::DeviceState::streaming; ++i)
    std::this_thread::sleep_for(10ms);
  EXPECT_NE(camera_->state(), hal::DeviceState::streaming);
  std::this_thread::sleep_for(500ms);
  while (thread.take_newest() != nullptr)
    ;
  ASSERT_TRUE(write_to_driver("bind"));
  EXPECT_EQ(pictures(5), 5) << "by itself";
  thread.stop();
  const auto records = faults.records();
  EXPECT_TRUE(std::any_of(records.begin(), records.end(), [](const auto& record) {
    return record.kind == fault_of(pipeline::Device::scope_camera, hal::ErrorCode::disconnected);
  }));
  for (const auto& record : records)
    std::printf("  %s, %d times: %s\n", std::string{facts_of(record.kind).key}.c_str(),
                static_cast<int>(record.count), record.message.c_str());
}

// What is ours in a frame's way allocates nothing; libcamera's message to its own thread does.
TEST_F(Vimc, a_frame_costs_no_more_allocations_than_libcameras_own) {
  open_and_start();
  for (int i = 0; i < 10; ++i)
    camera_->release(next_frame().buffer);
  constexpr int frames = 50;
  const auto before = allocations_of_this_thread();
  for (int i = 0; i < frames; ++i) {
    const auto frame = camera_->wait_frame(2s);
    ASSERT_TRUE(frame && *frame);
    const auto at_release = allocations_of_this_thread();
    camera_->release((*frame)->buffer);
    EXPECT_EQ(allocations_of_this_thread(), at_release);
  }
  const auto allocations = allocations_of_this_thread() - before;
  std::printf("allocations of the waiting thread: %.1f a frame\n",
              static_cast<double>(allocations) / frames);
  EXPECT_LE(allocations, 10U * frames) << "its message, and a request's empty lists";
}

// As where udevd's rules are applied to all devices once more, which says that each has come.
TEST_F(Vimc, nodes_that_are_told_of_again_hurt_nothing) {
  open_and_start();
  camera_->release(next_frame().buffer);
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(std::system("udevadm trigger --action=add --subsystem-match=video4linux "
                          "--subsystem-match=media && udevadm settle"),
              0);
    camera_->release(next_frame().buffer);
  }
}

// The last, because it ends udevd and starts it again.
TEST_F(Vimc, without_udevd_it_says_so_and_with_it_the_camera_is_there_again) {
  if (std::system("udevadm control --exit 2>/dev/null") != 0)
    GTEST_SKIP() << "udevd cannot be ended here";
  // It says so before it has ended, and would set up what is bound below.
  ASSERT_EQ(std::system("while pgrep -x systemd-udevd >/dev/null; do sleep 0.1; done"), 0);
  camera_.reset();
  session_.reset();
  unplug_vimc();
  std::this_thread::sleep_for(200ms);
  std::filesystem::remove_all("/run/udev");
  ASSERT_TRUE(write_to_driver("bind"));
  auto started = backend::LibcameraSession::start();
  ASSERT_TRUE(started) << started.error().message;
  session_ = std::move(*started);
  camera_ = make_camera({});
  EXPECT_THAT(camera_->open({}), FailsWith(hal::ErrorCode::absent, "no udev daemon runs"));
  ASSERT_EQ(std::system("/lib/systemd/systemd-udevd --daemon && udevadm trigger && "
                        "udevadm settle"),
            0);
  ASSERT_TRUE(wait_for_cameras(*session_, true)) << backend::explain_absence().message;
  open_and_start();
  camera_->release(next_frame().buffer);
}

} // namespace
} // namespace octascope::tests

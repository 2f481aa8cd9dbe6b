// What goes wrong with a GenICam camera, and what is refused; against Aravis's own on the loopback.
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <unistd.h>

#include "hal/linux/aravis/aravis_library.h"
#include "hal/linux/aravis/genicam_camera.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/hal/aravis/fake_camera.h"
#include "tests/support/fails_with.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using hal::ErrorCode;
using hal::FrameIntegrity;
using hal::linux_backend::AravisLibrary;
using hal::linux_backend::GenicamAddress;
using hal::linux_backend::GenicamCameraOptions;
using testing::HasSubstr;

hal::LineCameraConfig small_config() {
  return {.format = {.samples_per_line = 256,
                     .lines_per_frame = 64,
                     .sample_type = hal::SampleType::u16,
                     .significant_bits = 12,
                     .right_shift = 0},
          .line_rate_hz = 64e3,
          .buffers = 16};
}

int open_files() {
  int count = 0;
  for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator{"/proc/self/fd"})
    ++count;
  return count;
}

int threads() {
  int count = 0;
  for ([[maybe_unused]] const auto& task : std::filesystem::directory_iterator{"/proc/self/task"})
    ++count;
  return count;
}

long resident_kib() {
  std::ifstream statm{"/proc/self/statm"};
  long size = 0;
  long resident = 0;
  statm >> size >> resident;
  return resident * ::sysconf(_SC_PAGESIZE) / 1024;
}

class GenicamCamera : public testing::Test {
protected:
  std::unique_ptr<hal::LineCamera> make(GenicamCameraOptions options) {
    options.address = {GenicamAddress::Bus::gige_vision, FakeCamera::address};
    return hal::linux_backend::make_genicam_camera(options, clock_);
  }

  hal::linux_backend::MonotonicClock clock_;
};

TEST_F(GenicamCamera, frames_with_lost_packets_are_told_as_corrupted_and_the_stream_goes_on) {
  for (const bool resend : {true, false}) {
    FakeCamera fake{0.05};
    const auto camera = make({.trigger = "Software", .packet_resend = resend});
    ASSERT_TRUE(camera->open(small_config()));
    ASSERT_TRUE(camera->start());
    fake.trigger(100);
    int good = 0;
    int corrupted = 0;
    std::uint64_t last = 0;
    while (const auto frame = *camera->wait_frame(1s)) {
      (frame->integrity == FrameIntegrity::good ? good : corrupted) += 1;
      EXPECT_NE(frame->integrity, FrameIntegrity::wrong_size);
      EXPECT_EQ(frame->bytes.size(), small_config().format.frame_bytes());
      EXPECT_TRUE(last == 0 || frame->sequence > last);
      last = frame->sequence;
      camera->release(frame->buffer);
    }
    EXPECT_GT(good, 0);
    EXPECT_GT(corrupted, 0);
    EXPECT_GE(last + 1, static_cast<std::uint64_t>(good + corrupted));
    EXPECT_EQ(camera->state(), hal::DeviceState::streaming);
  }
}

TEST_F(GenicamCamera, two_hundred_opens_and_closes_leave_nothing_behind) {
  const FakeCamera fake;
  const auto camera = make({});
  int files = 0;
  int tasks = 0;
  [[maybe_unused]] long memory = 0;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(camera->open(small_config()));
    if (i % 4 == 0) {
      ASSERT_TRUE(camera->start());
      const auto frame = camera->wait_frame(1s);
      ASSERT_TRUE(frame && *frame) << "it runs free, at the rate that it has";
    }
    camera->close();
    if (i == 40) { // what libraries keep for ever, they have by now
      files = open_files();
      tasks = threads();
      memory = resident_kib();
    }
  }
  EXPECT_EQ(open_files(), files);
  EXPECT_EQ(threads(), tasks);
#ifndef OCTASCOPE_SANITIZED // which keeps what was freed, and looks for leaks itself
  EXPECT_LT(resident_kib(), memory + 4096);
#endif
}

TEST_F(GenicamCamera, one_that_is_not_there_is_absent_and_leaves_nothing_behind) {
  const auto camera = make({});
  EXPECT_THAT(camera->open(small_config()), FailsWith(ErrorCode::absent));
  const int files = open_files();
  EXPECT_THAT(camera->open(small_config()), FailsWith(ErrorCode::absent));
  EXPECT_EQ(open_files(), files);
  EXPECT_EQ(camera->state(), hal::DeviceState::absent);
}

TEST_F(GenicamCamera, its_features_are_set_and_what_it_cannot_is_refused_with_the_range) {
  const FakeCamera fake;
  const auto refused = [&](GenicamCameraOptions options, const char* why) {
    const auto opened = make(std::move(options))->open(small_config());
    ASSERT_FALSE(opened.has_value()) << why;
    EXPECT_THAT(opened.error().message, HasSubstr(why));
  };
  refused({.exposure_us = 1}, "exposure_us is 1, expected 10 to");
  refused({.gain = 99}, "gain is 99, expected 0 to 10");
  refused({.trigger = "Line77"}, "setting the trigger to \"Line77\"");
  const auto camera = make({.exposure_us = 20, .gain = 2, .trigger = "Software"});
  const auto opened = camera->open(small_config());
  EXPECT_TRUE(opened.has_value()) << (opened ? "" : opened.error().message);
}

TEST_F(GenicamCamera, a_frame_that_it_cannot_give_is_refused) {
  const FakeCamera fake;
  const auto camera = make({});
  hal::LineCameraConfig wide = small_config();
  wide.format.samples_per_line = 4096;
  const auto opened = camera->open(wide);
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, ErrorCode::invalid_argument);
  EXPECT_THAT(opened.error().message, HasSubstr("samples_per_line is 4096, expected 1 to 2048"));
}

TEST_F(GenicamCamera, samples_of_8_bits_come_as_they_are) {
  FakeCamera fake;
  const auto camera = make({.trigger = "Software"});
  hal::LineCameraConfig config = small_config();
  config.format.sample_type = hal::SampleType::u8;
  config.format.significant_bits = 8;
  ASSERT_TRUE(camera->open(config));
  ASSERT_TRUE(camera->start());
  fake.trigger(1);
  const auto frame = camera->wait_frame(5s);
  ASSERT_TRUE(frame && *frame);
  const auto bytes = (*frame)->bytes;
  ASSERT_EQ(bytes.size(), config.format.frame_bytes());
  // Its picture is a diagonal ramp: a line is the line above, moved by one.
  int moved = 0;
  for (std::size_t i = 0; i + 1 < 256; ++i)
    moved += bytes[256 + i] == bytes[i + 1] ? 1 : 0;
  EXPECT_GT(moved, 250);
}

TEST_F(GenicamCamera, tells_what_it_is_and_offers) {
  const FakeCamera fake;
  const auto found = hal::linux_backend::find_genicam_camera(
      {GenicamAddress::Bus::gige_vision, FakeCamera::address});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_EQ(found->camera, "Aravis Fake OCT1");
  EXPECT_THAT(found->pixel_formats, testing::Contains("Mono16"));
}

TEST(AravisLibrary, one_that_is_missing_or_another_is_refused_with_the_remedy) {
  for (const char* file : {"libaravis-none.so.0", "libm.so.6"}) {
    const auto loaded = AravisLibrary::load(file);
    ASSERT_FALSE(loaded.has_value());
    EXPECT_EQ(loaded.error().code, ErrorCode::unsupported);
    EXPECT_THAT(loaded.error().message, HasSubstr("apt install libaravis-0.8-0"));
  }
}

} // namespace
} // namespace octascope::tests

// The line camera on the kernel's own virtual camera: formats, loans, times, settings.
#include <algorithm>
#include <chrono>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/v4l2/v4l2_line_camera.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/v4l2/vivid_fixture.h"

namespace octascope::tests {
namespace {

using namespace hal;
using namespace hal::linux_backend;
using namespace std::chrono_literals;
using testing::Contains;
using testing::HasSubstr;

class VividStream : public VividTest {};

struct FormatCase {
  SampleType type;
  int bits;
  const char* name;
};

TEST_F(VividStream, every_grey_format_streams_at_the_size_of_a_b_scan) {
  for (const auto& [type, bits, name] :
       {FormatCase{SampleType::u8, 8, "GREY"}, FormatCase{SampleType::u16, 10, "Y10"},
        FormatCase{SampleType::u16, 12, "Y12"}, FormatCase{SampleType::u16, 16, "Y16"}}) {
    SCOPED_TRACE(name);
    LineCameraConfig config = usual_config();
    config.format.sample_type = type;
    config.format.significant_bits = bits;
    ASSERT_NO_FATAL_FAILURE(open_and_start(config));
    EXPECT_THAT(camera_.notes(), Contains(std::string{name} + " at 1024×379"));
    const LineFrame frame = next_frame();
    EXPECT_EQ(frame.integrity, FrameIntegrity::good);
    ASSERT_EQ(frame.bytes.size(), config.format.frame_bytes());
    // Low-justified: no sample above full scale, and some light.
    const unsigned full_scale = (1U << bits) - 1;
    unsigned most = 0;
    for (std::size_t i = 0; i < frame.bytes.size();
         i += hal::bytes_per_sample(config.format.sample_type)) {
      auto sample = std::to_integer<unsigned>(frame.bytes[i]);
      if (type == SampleType::u16)
        sample |= std::to_integer<unsigned>(frame.bytes[i + 1]) << 8;
      most = std::max(most, sample);
    }
    EXPECT_LE(most, full_scale);
    EXPECT_GT(most, full_scale / 2);
    camera_.close();
  }
}

TEST_F(VividStream, a_twelve_bit_format_is_left_for_a_larger_one_only_if_it_must) {
  LineCameraConfig config = usual_config();
  config.format.significant_bits = 12;
  config.format.right_shift = 4;
  ASSERT_TRUE(camera_.open(config));
  EXPECT_THAT(camera_.notes(), Contains(HasSubstr("Y16 at")));
}

TEST_F(VividStream, buffers_are_fewer_than_asked_for_and_that_is_said) {
  LineCameraConfig config = usual_config();
  config.buffers = 96;
  ASSERT_TRUE(camera_.open(config));
  EXPECT_THAT(camera_.notes(), Contains(HasSubstr("32 buffers, 96 asked for")));
  EXPECT_EQ(camera_.fewer_buffers(), 32);
}

TEST_F(VividStream, loans_stay_as_they_are_and_frames_without_buffers_are_a_gap) {
  LineCameraConfig config = usual_config();
  config.buffers = 4;
  ASSERT_NO_FATAL_FAILURE(open_and_start(config));
  std::vector<LineFrame> loans;
  std::vector<std::vector<std::byte>> copies;
  std::set<int> numbers;
  for (int i = 0; i < config.buffers; ++i) {
    loans.push_back(next_frame());
    copies.emplace_back(loans.back().bytes.begin(), loans.back().bytes.end());
    numbers.insert(loans.back().buffer);
  }
  EXPECT_EQ(numbers.size(), loans.size());
  const auto none = camera_.wait_frame(100ms);
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_FALSE(none->has_value()) << "all buffers are on loan";
  for (std::size_t i = 0; i < loans.size(); ++i)
    EXPECT_TRUE(std::ranges::equal(loans[i].bytes, copies[i]));

  camera_.stop(); // and over a stop and a start, without a free buffer
  ASSERT_TRUE(camera_.start());
  EXPECT_FALSE(*camera_.wait_frame(30ms));
  for (std::size_t i = 0; i < loans.size(); ++i)
    EXPECT_TRUE(std::ranges::equal(loans[i].bytes, copies[i]));
  for (const LineFrame& loan : loans)
    camera_.release(loan.buffer);
  EXPECT_EQ(next_frame().sequence, 0U);
}

TEST_F(VividStream, a_loan_given_back_twice_makes_room_for_one) {
  LineCameraConfig config = usual_config();
  config.buffers = 4;
  ASSERT_NO_FATAL_FAILURE(open_and_start(config));
  std::vector<LineFrame> loans;
  for (int i = 0; i < config.buffers; ++i)
    loans.push_back(next_frame());
  for (const int number : {-1, 4, 1000, INT32_MAX, INT32_MIN})
    camera_.release(number);
  camera_.release(loans[2].buffer);
  camera_.release(loans[2].buffer);
  const LineFrame frame = next_frame();
  EXPECT_EQ(frame.buffer, loans[2].buffer);
  EXPECT_GT(frame.sequence, loans.back().sequence);
  EXPECT_FALSE(*camera_.wait_frame(60ms));
}

TEST_F(VividStream, stamps_of_both_kinds_give_exposures_that_lie_before_now) {
  for (const int source : {0, 1}) { // end of frame, start of exposure
    SCOPED_TRACE(source);
    ASSERT_TRUE(vivid_->set("Timestamp Source", source));
    ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
    TimePoint before{};
    for (int i = 0; i < 5; ++i) {
      const LineFrame frame = next_frame();
      EXPECT_LE(frame.last_line, clock_.now());
      EXPECT_GT(frame.last_line, frame.first_line);
      EXPECT_GT(frame.first_line, before);
      EXPECT_LT(clock_.now() - frame.first_line, 2s);
      before = frame.first_line;
      camera_.release(frame.buffer);
    }
    EXPECT_EQ(camera_.tally().own_stamps, 0U);
    camera_.close();
  }
}

TEST_F(VividStream, the_hot_path_allocates_nothing) {
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  camera_.release(next_frame().buffer);
  const std::uint64_t before = allocations_of_this_thread();
  for (int i = 0; i < 20; ++i) {
    const auto frame = camera_.wait_frame(1s);
    if (frame && *frame)
      camera_.release((*frame)->buffer);
  }
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST_F(VividStream, settings_are_checked_and_told) {
  V4l2CameraOptions options = usual_options();
  options.settings.gain = 17;
  options.settings.others = {{"contrast", 100}};
  V4l2LineCamera camera{options, clock_};
  const auto opened = camera.open(usual_config());
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_THAT(camera.notes(), Contains("Gain set to 17"));
  EXPECT_THAT(camera.notes(), Contains("Contrast set to 100"));
  EXPECT_THAT(camera.notes(), Contains(HasSubstr("no control of the line rate")));
  const hal::CameraControls controls = camera.controls();
  EXPECT_FALSE(controls.exposure_us);
  ASSERT_TRUE(controls.gain);
  EXPECT_EQ(controls.gain->value, 17);
  EXPECT_EQ(controls.gain->least, 0);
  EXPECT_EQ(controls.gain->most, 255);
  camera.close();
  EXPECT_FALSE(camera.controls().gain);

  options.settings.gain = 100'000;
  V4l2LineCamera too_loud{options, clock_};
  EXPECT_THAT(too_loud.open(usual_config()),
              FailsSaying("\"Gain\" is configured to be 100000, expected"));

  options.settings = {.exposure_us = 5, .gain = {}, .others = {}};
  V4l2LineCamera without{options, clock_};
  const auto none = without.open(usual_config());
  ASSERT_THAT(none, FailsWith(ErrorCode::unsupported, "no control \"Exposure Time\""));
}

TEST_F(VividStream, a_sensor_window_is_set_or_refused_with_what_it_became) {
  V4l2CameraOptions options = usual_options();
  options.window = SensorWindow{.left = 64, .top = 32, .width = 512, .height = 256};
  V4l2LineCamera camera{options, clock_};
  const auto opened = camera.open(usual_config());
  ASSERT_TRUE(opened) << opened.error().message;
  options.window->width = 100'000;
  V4l2LineCamera too_wide{options, clock_};
  const auto refused = too_wide.open(usual_config());
  ASSERT_FALSE(refused);
  std::printf("  %s\n", refused.error().message.c_str());
}

} // namespace
} // namespace octascope::tests

// What goes wrong with a GenICam camera, and what is refused; against Aravis's own on the loopback.
#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <unistd.h>

#include "hal/linux/aravis/aravis_library.h"
#include "hal/linux/aravis/aravis_line_camera.h"
#include "hal/linux/aravis/genicam_camera.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/hal/aravis/fake_camera.h"
#include "tests/hal/aravis/packed_by_definition.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/program/genicam_description.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using hal::ErrorCode;
using hal::FrameIntegrity;
using hal::linux_backend::AravisLibrary;
using hal::linux_backend::Depths;
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

  // What libraries keep for ever, they have after that.
  int threads_without_camera() {
    {
      const FakeCamera fake;
      EXPECT_TRUE(make({})->open(small_config()));
    }
    return threads();
  }

  void wait_for_threads(int expected) {
    for (int i = 0; i < 600 && threads() > expected; ++i)
      clock_.sleep_for(100ms);
    EXPECT_EQ(threads(), expected);
  }

  hal::linux_backend::MonotonicClock clock_;
};

// Of the next frame, which has to be good; empty: none came.
std::vector<std::uint16_t> next_samples(hal::LineCamera& camera) {
  const auto frame = camera.wait_frame(20s);
  if (!frame || !*frame)
    return {};
  EXPECT_EQ((*frame)->integrity, FrameIntegrity::good);
  std::vector<std::uint16_t> samples((*frame)->bytes.size() / 2);
  std::memcpy(samples.data(), (*frame)->bytes.data(), 2 * samples.size());
  camera.release((*frame)->buffer);
  return samples;
}

TEST_F(GenicamCamera, frames_with_lost_packets_are_told_as_corrupted_and_the_stream_goes_on) {
  for (const bool resend : {true, false}) {
    FakeCamera fake{{.lost = 0.05}};
    const auto camera = make({.trigger = "Software", .packet_resend = resend});
    ASSERT_TRUE(camera->open(small_config()));
    ASSERT_TRUE(camera->start());
    fake.trigger(100);
    int good_since = 0; // the first that is not
    int corrupted = 0;
    std::uint64_t last = 0;
    while (corrupted == 0 || good_since < 3) {
      const auto frame = camera->wait_frame(20s);
      ASSERT_TRUE(frame && *frame) << good_since << " good after " << corrupted << " broken ones";
      if ((*frame)->integrity == FrameIntegrity::corrupted)
        ++corrupted;
      else if (corrupted > 0)
        ++good_since;
      EXPECT_NE((*frame)->integrity, FrameIntegrity::wrong_size);
      EXPECT_EQ((*frame)->bytes.size(), small_config().format.frame_bytes());
      EXPECT_TRUE(last == 0 || (*frame)->sequence > last);
      last = (*frame)->sequence;
      camera->release((*frame)->buffer);
    }
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
      const auto frame = camera->wait_frame(20s);
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
  const int idle = threads_without_camera();
  FakeCamera fake;
  fake.unplug(); // and no other test has one now
  const int files = open_files();
  for (int i = 0; i < 3; ++i) { // Aravis asks for longer than open() waits
    const auto camera = make({});
    EXPECT_THAT(camera->open(small_config()), FailsWith(ErrorCode::absent));
    EXPECT_THAT(camera->open(small_config()), FailsWith(ErrorCode::absent));
    EXPECT_EQ(camera->state(), hal::DeviceState::absent);
  }
  wait_for_threads(idle);
  EXPECT_EQ(open_files(), files);
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
  const hal::CameraControls controls = camera->controls();
  ASSERT_TRUE(controls.exposure_us && controls.gain);
  EXPECT_EQ(controls.exposure_us->value, 20);
  EXPECT_EQ(controls.exposure_us->least, 10);
  EXPECT_EQ(controls.gain->value, 2);
  EXPECT_EQ(controls.gain->most, 10);
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
  const auto frame = camera->wait_frame(20s);
  ASSERT_TRUE(frame && *frame);
  const auto bytes = (*frame)->bytes;
  ASSERT_EQ(bytes.size(), config.format.frame_bytes());
  // Its picture is a diagonal ramp: a line is the line above, moved by one.
  int moved = 0;
  for (std::size_t i = 0; i + 1 < 256; ++i)
    moved += bytes[256 + i] == bytes[i + 1] ? 1 : 0;
  EXPECT_GT(moved, 250);
}

// Aravis's camera with one pixel format more.
std::string description_with(const char* format, unsigned number) {
  std::string text = FakeCamera::usual_description();
  const std::string before = "<EnumEntry Name=\"Mono8\"";
  text.insert(text.find(before), "<EnumEntry Name=\"" + std::string{format} +
                                     "\" NameSpace=\"Standard\"><Value>" + std::to_string(number) +
                                     "</Value></EnumEntry>\n");
  return text;
}

TEST_F(GenicamCamera, packed_samples_come_unpacked) {
  using hal::linux_backend::Packing;
  const ScratchFolder folder;
  FakeCamera fake{
      {.description = folder.write("camera.xml", description_with("Mono12p", 0x010C0047))}};
  std::vector<int> samples(256 * 64);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<int>(i * 7 % 4096);
  fake.send_bytes(pack_by_definition(Packing::mono12p, samples));
  const auto camera = make({.trigger = "Software"});
  ASSERT_TRUE(camera->open(small_config()));
  ASSERT_TRUE(camera->start());
  fake.trigger(2);
  for (int i = 0; i < 2; ++i) { // the second is not disturbed by the first
    EXPECT_THAT(next_samples(*camera), testing::ElementsAreArray(samples));
  }
}

TEST_F(GenicamCamera, one_of_another_depth_is_taken_where_any_serves_and_scaled) {
  const ScratchFolder folder;
  FakeCamera fake{{.description = folder.write(
                       "camera.xml", with_8_bits_alone(FakeCamera::usual_description()))}};
  const auto refused = make({})->open(small_config());
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::unsupported) << refused.error().message;
  std::vector<std::byte> samples(256 * 64);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<std::byte>(i % 251 * 7);
  fake.send_bytes(samples);
  const auto camera = make({.trigger = "Software", .depths = Depths::any});
  ASSERT_TRUE(camera->open(small_config()));
  ASSERT_TRUE(camera->start());
  fake.trigger(2);
  for (int i = 0; i < 2; ++i) {
    const auto received = next_samples(*camera);
    ASSERT_EQ(received.size(), samples.size());
    for (std::size_t s = 0; s < samples.size(); ++s)
      ASSERT_NEAR(received[s], std::to_integer<int>(samples[s]) * 4095.0 / 255, 1) << s;
  }
}

TEST_F(GenicamCamera, one_that_sends_no_stamps_is_told_after_5_s_of_frames) {
  FakeCamera fake;
  auto aravis = AravisLibrary::load();
  ASSERT_TRUE(aravis.has_value()) << aravis.error().message;
  aravis->buffer_get_timestamp = [](ArvBuffer*) -> guint64 { return 0; };
  hal::linux_backend::AravisLineCamera camera{
      {.address = {GenicamAddress::Bus::gige_vision, FakeCamera::address}, .trigger = "Software"},
      clock_,
      *aravis};
  ASSERT_TRUE(camera.open(small_config()));
  ASSERT_TRUE(camera.start());
  const hal::TimePoint began = clock_.now();
  for (bool told = false; !told;) {
    fake.trigger(1);
    const auto frame = camera.wait_frame(20s);
    ASSERT_TRUE(frame && *frame);
    told = (*frame)->timed_by_host;
    camera.release((*frame)->buffer);
    clock_.sleep_for(20ms);
  }
  EXPECT_GE(clock_.now() - began, 5s);
}

// Aravis waits 3 s for each answer, and asks twice or thrice.
TEST_F(GenicamCamera, ends_soon_after_it_went_and_what_is_left_ends_by_itself) {
  const int idle = threads_without_camera();
  FakeCamera fake;
  auto camera = make({.trigger = "Software"});
  ASSERT_TRUE(camera->open(small_config()));
  ASSERT_TRUE(camera->start());
  fake.unplug();
  const hal::TimePoint began = clock_.now();
  camera->stop();
  EXPECT_EQ(camera->state(), hal::DeviceState::failed);
  camera->close();
  EXPECT_EQ(camera->state(), hal::DeviceState::absent);
  camera.reset();
  EXPECT_LT(clock_.now() - began, 2500ms) << "a second, and a machine may stand still for another";
  wait_for_threads(idle);
}

// Aravis, whose question for a stream is not answered before a test lets it.
class HeldStart {
public:
  HeldStart() {
    held_ = this;
    EXPECT_TRUE(aravis_.has_value()) << aravis_.error().message;
    asks_ = std::exchange(aravis_->camera_create_stream, &wait_and_ask);
  }
  ~HeldStart() { held_ = nullptr; }
  HeldStart(const HeldStart&) = delete;
  HeldStart& operator=(const HeldStart&) = delete;

  AravisLibrary aravis() const { return *aravis_; }
  void let_go() { may_.post(); }
  // Frames that the stream has and nobody has fetched.
  int frames_waiting() const {
    gint idle = 0;
    gint filled = 0;
    if (ArvStream* const stream = stream_)
      arv_stream_get_n_buffers(stream, &idle, &filled);
    return filled;
  }

private:
  static ArvStream* wait_and_ask(ArvCamera* camera, ArvStreamCallback callback, void* data,
                                 GError** error) {
    held_->may_.wait();
    held_->stream_ = held_->asks_(camera, callback, data, error);
    return held_->stream_;
  }

  static inline HeldStart* held_ = nullptr;
  hal::Result<AravisLibrary> aravis_ = AravisLibrary::load();
  decltype(&arv_camera_create_stream) asks_ = nullptr;
  hal::Semaphore may_;
  std::atomic<ArvStream*> stream_{nullptr}; // the camera's
};

class GenicamCameraStart : public GenicamCamera {
protected:
  // Open, and being started.
  void begin_start() {
    ASSERT_TRUE(camera_->open(small_config()));
    EXPECT_THAT(camera_->start(), FailsWith(ErrorCode::absent));
    EXPECT_EQ(camera_->state(), hal::DeviceState::ready);
  }
  // Whatever a busy machine takes for it.
  template <class Call> static hal::Result<> at_last(Call call) {
    hal::Result<> done = call();
    while (!done && done.error().code == ErrorCode::absent)
      done = call();
    return done;
  }
  void expect_frame_of_a_new_stream() {
    fake_.trigger(1);
    const auto frame = camera_->wait_frame(20s);
    ASSERT_TRUE(frame && *frame);
    EXPECT_EQ((*frame)->sequence, 0U);
    EXPECT_EQ((*frame)->integrity, FrameIntegrity::good);
    camera_->release((*frame)->buffer);
  }

  const int idle_ = threads_without_camera();
  FakeCamera fake_;
  HeldStart held_;
  std::unique_ptr<hal::Clock> its_clock_ = std::make_unique<hal::linux_backend::MonotonicClock>();
  std::unique_ptr<hal::LineCamera> camera_ = std::make_unique<hal::linux_backend::AravisLineCamera>(
      GenicamCameraOptions{.address = {GenicamAddress::Bus::gige_vision, FakeCamera::address},
                           .trigger = "Software"},
      *its_clock_, held_.aravis());
};

TEST_F(GenicamCameraStart, what_came_of_a_start_has_the_next_one) {
  begin_start();
  EXPECT_THAT(camera_->start(), FailsWith(ErrorCode::absent)) << "it is asked once";
  held_.let_go();
  ASSERT_TRUE(at_last([&] { return camera_->start(); }));
  EXPECT_EQ(camera_->state(), hal::DeviceState::streaming);
  expect_frame_of_a_new_stream();
}

// They are of the time before anybody asked for frames, and would be taken for those of the first
// pulse.
TEST_F(GenicamCameraStart, frames_that_came_before_it_was_done_are_forgotten) {
  begin_start();
  held_.let_go();
  fake_.trigger(3); // it sends when it was started
  for (int i = 0; i < 2000 && held_.frames_waiting() < 3; ++i)
    clock_.sleep_for(10ms);
  ASSERT_EQ(held_.frames_waiting(), 3);
  ASSERT_TRUE(at_last([&] { return camera_->start(); }));
  std::vector<std::byte> new_one(std::size_t{256} * 64 * 2);
  for (std::size_t i = 0; i < new_one.size(); i += 2)
    new_one[i] = std::byte{77};
  fake_.trigger(0); // all of the old ones are sent
  fake_.send_bytes(new_one);
  fake_.trigger(1);
  EXPECT_THAT(next_samples(*camera_), testing::AllOf(testing::SizeIs(256 * 64), testing::Each(77)));
}

TEST_F(GenicamCameraStart, a_start_under_way_is_ended_by_stop_and_by_close) {
  for (const bool by_stop : {true, false}) {
    begin_start();
    if (by_stop) {
      camera_->stop();
      EXPECT_EQ(camera_->state(), hal::DeviceState::failed) << "it was waited for in vain";
    }
    camera_->close();
    EXPECT_EQ(camera_->state(), hal::DeviceState::absent);
    held_.let_go();
    ASSERT_TRUE(at_last([&] { return camera_->open(small_config()); }));
    held_.let_go();
    ASSERT_TRUE(at_last([&] { return camera_->start(); }));
    expect_frame_of_a_new_stream();
    camera_->close();
  }
}

TEST_F(GenicamCameraStart, may_end_with_its_clock_while_a_start_is_under_way) {
  begin_start();
  camera_.reset();
  its_clock_.reset();
  held_.let_go();
  wait_for_threads(idle_ + 1); // the fake camera's own
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

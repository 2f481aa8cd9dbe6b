#include <algorithm>
#include <thread>

#include "hal/linux/monotonic_clock.h"
#include "sim/clock/virtual_clock.h"
#include "sim/devices/sim_scope_camera.h"
#include "tests/contract/scope_camera_contract.h"

namespace octascope::tests {
namespace {

ScopeCameraRig twin_on_a_virtual_clock() {
  ScopeCameraRig rig;
  const auto clock = std::make_shared<sim::VirtualClock>();
  sim::SimScopeCameraOptions options;
  options.width = 64;
  options.height = 48;
  auto twin = *sim::SimScopeCamera::make(options, *clock);
  rig.unplug = [camera = twin.get()] { camera->unplug(); };
  rig.replug = [camera = twin.get()] { camera->replug(); };
  rig.clock = clock.get();
  rig.keeper = clock;
  rig.camera = std::move(twin);
  return rig;
}

INSTANTIATE_TEST_SUITE_P(Sim, ScopeCameraContract,
                         testing::Values(std::function{twin_on_a_virtual_clock}));

} // namespace
} // namespace octascope::tests

namespace octascope::sim {
namespace {

SimScopeCameraOptions eye_options() {
  SimScopeCameraOptions options;
  options.width = 160;
  options.height = 120;
  options.field = make_phantom("anterior_eye", 1).value()->suggested_plan().geometry();
  return options;
}

std::vector<std::byte> picture(SimScopeCamera& camera, VirtualClock& clock, hal::Duration later) {
  clock.advance(later);
  const auto frame = camera.wait_frame(std::chrono::seconds{1});
  EXPECT_TRUE(frame && *frame);
  const std::vector<std::byte> pixels((*frame)->pixels.begin(), (*frame)->pixels.end());
  camera.release((*frame)->buffer);
  return pixels;
}

TEST(SimScopeCamera, the_scan_field_is_centred_and_as_large_as_the_plan_says) {
  VirtualClock clock;
  const auto camera = *SimScopeCamera::make(eye_options(), clock);
  const PictureRectangle field = camera->scan_field();
  EXPECT_NEAR(field.x + field.width / 2, 0.5, 1e-9);
  EXPECT_NEAR(field.y + field.height / 2, 0.5, 1e-9);
  EXPECT_NEAR(field.width, 300 * 0.032 / 15, 1e-6);
  EXPECT_NEAR(field.height, 80 * 0.115 / (15 * 0.75), 1e-6);
}

TEST(SimScopeCamera, the_instrument_moves_round_a_loop_over_a_still_eye) {
  VirtualClock clock;
  SimScopeCameraOptions options = eye_options();
  options.loop = std::chrono::seconds{1};
  const auto camera = *SimScopeCamera::make(options, clock);
  ASSERT_TRUE(camera->open({640, 480, 10}));
  ASSERT_TRUE(camera->start());
  const auto first = picture(*camera, clock, std::chrono::milliseconds{150});
  const auto moved = picture(*camera, clock, std::chrono::milliseconds{400});
  const auto round = picture(*camera, clock, std::chrono::milliseconds{600});
  EXPECT_EQ(first, round);
  EXPECT_NE(first, moved);
  // The upper left quarter has no instrument in it.
  for (std::size_t row = 0; row < 50; ++row)
    ASSERT_TRUE(std::equal(first.begin() + static_cast<std::ptrdiff_t>(row * 480),
                           first.begin() + static_cast<std::ptrdiff_t>(row * 480 + 180),
                           moved.begin() + static_cast<std::ptrdiff_t>(row * 480)));
}

TEST(SimScopeCamera, a_pupil_is_dark_and_a_sclera_is_bright) {
  VirtualClock clock;
  const auto camera = *SimScopeCamera::make(eye_options(), clock);
  ASSERT_TRUE(camera->open({}));
  ASSERT_TRUE(camera->start());
  const auto pixels = picture(*camera, clock, std::chrono::milliseconds{40});
  const auto brightness = [&](double x_mm, double y_mm) {
    const auto column = static_cast<std::size_t>((x_mm / 15 + 0.5) * 160);
    const auto row = static_cast<std::size_t>((y_mm / 11.25 + 0.5) * 120);
    const std::size_t at = (row * 160 + column) * 3;
    return std::to_integer<int>(pixels[at]) + std::to_integer<int>(pixels[at + 1]) +
           std::to_integer<int>(pixels[at + 2]);
  };
  EXPECT_LT(brightness(-1.2, 0.8), 120);
  EXPECT_GT(brightness(6.5, -4.5), 300);
}

TEST(SimScopeCamera, no_frame_comes_before_its_exposure_is_over) {
  VirtualClock clock;
  const auto camera = *SimScopeCamera::make(eye_options(), clock);
  ASSERT_TRUE(camera->open({640, 480, 30}));
  ASSERT_TRUE(camera->start());
  const auto frame = camera->wait_frame(std::chrono::milliseconds{33});
  ASSERT_TRUE(frame);
  EXPECT_FALSE(*frame);
}

TEST(SimScopeCamera, frames_that_nobody_fetched_are_missing_from_the_sequence) {
  VirtualClock clock;
  const auto camera = *SimScopeCamera::make(eye_options(), clock);
  ASSERT_TRUE(camera->open({640, 480, 30}));
  ASSERT_TRUE(camera->start());
  clock.advance(std::chrono::seconds{1});
  const auto frame = camera->wait_frame(std::chrono::seconds{1});
  ASSERT_TRUE(frame && *frame);
  EXPECT_GE((*frame)->sequence, 28U);
  EXPECT_LT(clock.now() - (*frame)->time, std::chrono::milliseconds{34});
}

TEST(SimScopeCamera, the_cable_may_be_pulled_by_another_thread) {
  hal::linux_backend::MonotonicClock clock;
  const auto camera = *SimScopeCamera::make(eye_options(), clock);
  ASSERT_TRUE(camera->open({}));
  ASSERT_TRUE(camera->start());
  std::thread hand([&] { camera->unplug(); });
  auto frame = camera->wait_frame(std::chrono::milliseconds{100});
  for (int i = 0; i < 100 && frame; ++i) {
    if (*frame)
      camera->release((*frame)->buffer);
    frame = camera->wait_frame(std::chrono::milliseconds{100});
  }
  hand.join();
  ASSERT_FALSE(frame);
  EXPECT_EQ(camera->state(), hal::DeviceState::failed);
}

TEST(SimScopeCamera, impossible_options_are_refused) {
  VirtualClock clock;
  SimScopeCameraOptions options = eye_options();
  options.phantom = "teapot";
  EXPECT_FALSE(SimScopeCamera::make(options, clock));
  options = eye_options();
  options.width = 0;
  EXPECT_FALSE(SimScopeCamera::make(options, clock));
  options = eye_options();
  options.loop = hal::Duration::zero();
  EXPECT_FALSE(SimScopeCamera::make(options, clock));
}

} // namespace
} // namespace octascope::sim

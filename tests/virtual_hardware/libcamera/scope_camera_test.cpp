// The libcamera backend against vimc: what every scope camera promises.
#include "hal/linux/libcamera/libcamera_scope_camera.h"
#include "tests/contract/scope_camera_contract.h"
#include "tests/virtual_hardware/libcamera/vimc.h"

namespace octascope::tests {
namespace {

struct Keeper {
  hal::linux_backend::MonotonicClock clock;
  std::unique_ptr<hal::linux_backend::LibcameraSession> session;
};

ScopeCameraRig rig_with_vimc() {
  auto keeper = std::make_shared<Keeper>();
  auto session = hal::linux_backend::LibcameraSession::start();
  if (!session)
    throw std::runtime_error{session.error().message};
  keeper->session = std::move(*session);
  if (!replug_vimc(*keeper->session))
    throw std::runtime_error{hal::linux_backend::explain_absence().message};
  ScopeCameraRig rig;
  rig.clock = &keeper->clock;
  rig.camera = std::make_unique<hal::linux_backend::LibcameraScopeCamera>(
      *keeper->session, hal::linux_backend::LibcameraScopeOptions{}, keeper->clock);
  rig.unplug = unplug_vimc;
  rig.replug = [k = keeper.get()] { EXPECT_TRUE(replug_vimc(*k->session)); };
  rig.keeps_rate = false; // vimc has 60 Hz of its own, less what the kernel's ticks lose
  rig.keeper = keeper;
  return rig;
}

std::vector<std::function<ScopeCameraRig()>> rigs() {
  if (!has_vimc())
    return {};
  return {rig_with_vimc};
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ScopeCameraContract);
INSTANTIATE_TEST_SUITE_P(Vimc, ScopeCameraContract, testing::ValuesIn(rigs()));

} // namespace
} // namespace octascope::tests

#include "firmware-host/commands/bench/undisplayed_chain.h"

#include <algorithm>
#include <memory>

#include "firmware-host/devices/devices.h"
#include "firmware-host/reconstruction/reconstruction.h"
#include "firmware-host/supervision/thread_roles.h"
#include "hal/linux/monotonic_clock.h"
#include "pipeline/acquisition/acquisition.h"
#include "pipeline/acquisition/volume_thread.h"

namespace octascope::firmware_host {

hal::Result<pipeline::VolumeCounters> run_undisplayed(const Configuration& configuration,
                                                      double seconds) {
  RunOptions options;
  options.simulate = true;
  options.display = DisplayChoice::offscreen; // made, never opened
  hal::linux_backend::MonotonicClock clock;
  pipeline::FaultLog faults;
  pipeline::Wakeup arrived;
  pipeline::Wakeup news;
  auto real =
      std::make_unique<RealDevices>(configuration.devices, plan_of(options, configuration), clock);
  const DeviceChoices choices =
      choose_devices(real->find_for(options), options, configuration.devices);
  Devices devices{std::move(real), choices, clock};
  HAL_CHECK(devices.make_others(choices, options, configuration, clock));
  ReconstructionCache cache;
  HAL_TRY(auto reconstruction,
          Reconstruction::make(devices, configuration, configuration.flow, cache));
  const hal::LineCameraConfig camera = devices.camera_config();
  pipeline::Acquisition acquisition{devices.line_camera(), camera, clock, faults, arrived};
  pipeline::VolumeThreadSetup setup =
      reconstruction->volume_thread_setup(devices.plan(), camera.buffers);
  setup.trigger = {.pulse_width = configuration.devices.pulse_width};
  pipeline::VolumeThread volumes{std::move(setup),
                                 devices.galvo_trigger(),
                                 acquisition,
                                 devices.line_camera(),
                                 clock,
                                 faults,
                                 arrived,
                                 news};
  const pipeline::ThreadSetup threads =
      make_thread_setup(clock, faults, reconstruction->worker_cores());
  const hal::TimePoint end = clock.now() + hal::from_seconds(seconds);
  HAL_CHECK(acquisition.start(threads));
  volumes.start(threads);
  for (hal::TimePoint now = clock.now(); now < end; now = clock.now()) {
    static_cast<void>(volumes.take_newest());
    clock.sleep_for(std::min<hal::Duration>(end - now, std::chrono::milliseconds{5}));
  }
  volumes.stop();
  acquisition.stop();
  return volumes.counters();
}

} // namespace octascope::firmware_host

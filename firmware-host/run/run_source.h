// Where the volumes of a run come from, with what belongs to it: the devices of a live run, or a
// recording. The rest is the same for both and is put together in appliance.cpp.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "firmware-host/devices/device_choice.h"
#include "firmware-host/devices/devices.h"
#include "firmware-host/run/render_loop.h"
#include "firmware-host/run/run_statistics.h"
#include "firmware-host/run/status_writer.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/acquisition/volume_feed.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/wakeup.h"
#include "pipeline/threads/worker_pool.h"
#include "pipeline/volume/patient_eye.h"

namespace octascope::firmware_host {

class CrashReport;
struct ChosenConfiguration;

// Everything must outlive the source.
struct RunContext {
  const RunOptions& options;
  const Configuration& configuration;
  hal::Clock& clock;
  pipeline::FaultLog& faults;
  pipeline::Wakeup& news; // for the render thread
};

// As in RenderLoopParts; valid as long as the source.
struct SourceParts {
  pipeline::VolumeFeed& volumes;
  const pipeline::Acquisition* acquisition = nullptr;
  pipeline::ScopeThread* scope = nullptr;
  std::function<std::string_view()> record = {};
  PictureProof* proof = nullptr;
};

// Bound to the render thread. Call in the order given.
class RunSource {
public:
  virtual ~RunSource() = default;

  // Reads the needed files, before any device is looked for.
  virtual hal::Result<> open() { return {}; }
  // Makes the devices besides the display, and what makes volumes; starts nothing. `devices` must
  // outlive the source.
  virtual hal::Result<> prepare(Devices& devices, DeviceChoices choices) = 0;
  virtual pipeline::PatientEye whose() const = 0;
  virtual void configure(RenderLoopSetup& setup) const = 0;
  virtual SourceParts parts() = 0;
  virtual pipeline::ThreadSetup thread_setup() = 0; // for every thread of the run

  virtual void opening_display() {}
  virtual hal::Result<> start() = 0;

  // At every turn of the render loop.
  virtual void describe(HostStatus& host, hal::TimePoint now) = 0;
  // Takes precedence over the configuration's notice; empty: nothing.
  virtual std::string_view notice(hal::TimePoint) const { return {}; }
  virtual void advance(const RenderLoop& loop) = 0; // the display has been told
  virtual bool done(const RenderLoop& loop) const = 0;

  virtual void ending() {} // the last picture is still to be taken
  virtual void stop() = 0;
  virtual hal::Result<> report(const RenderLoop& loop, const RunTimes& times) const = 0;
  virtual hal::Result<> outcome() const { return {}; }

protected:
  explicit RunSource(const RunContext& run)
      : options_(run.options), configuration_(run.configuration), clock_(run.clock),
        faults_(run.faults), news_(run.news) {}

  const RunOptions& options_;
  const Configuration& configuration_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  pipeline::Wakeup& news_;
};

// Real and simulated devices, under supervision. `crash_report` must outlive it.
std::unique_ptr<RunSource> make_live_source(const RunContext& run,
                                            const ChosenConfiguration& chosen,
                                            CrashReport& crash_report);

// The recording that the options name; no camera, trigger or supervision.
std::unique_ptr<RunSource> make_replay_source(const RunContext& run);

} // namespace octascope::firmware_host

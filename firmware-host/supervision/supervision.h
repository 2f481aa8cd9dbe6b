// Watches the running appliance and reports to systemd, `octascope status`, the journal, a metrics
// file and, after a crash, to whoever fixes it.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "firmware-host/crash/crash_report.h"
#include "firmware-host/crash/run_marker.h"
#include "firmware-host/supervision/appliance_status.h"
#include "firmware-host/supervision/fault_journal.h"
#include "firmware-host/supervision/host_watch.h"
#include "firmware-host/supervision/picture_proof.h"
#include "firmware-host/supervision/service_manager.h"
#include "firmware-host/supervision/status_server.h"
#include "firmware-host/supervision/thread_watch.h"
#include "firmware-host/supervision/watchdog.h"
#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::firmware_host {

struct SupervisionSetup {
  ServiceFolders folders;
  std::optional<std::filesystem::path> configuration; // the file in use
  ui::ConfigurationState configuration_state = ui::ConfigurationState::own;
  std::optional<std::filesystem::path> metrics; // empty: metrics.prom in the runtime folder
  bool journal = false;                         // faults go there, too
};

// Its own ordinary thread looks ten times a second, more often before the first picture. It never
// blocks the render thread, which passes it counters and, once a second, a copy behind a lock.
//
// Begins with start(). Must outlive all threads that it watches.
class Supervision {
public:
  // The references must outlive this.
  Supervision(SupervisionSetup setup, CrashReport& crash_report, hal::Clock& clock,
              pipeline::FaultLog& faults);
  ~Supervision(); // in good order: the next run finds no crash

  // Before start(): tells systemd which start-up step has begun.
  bool is_service() const { return manager_.there(); } // of systemd
  void starting(std::string_view step) const { manager_.starting(step); }

  // `process_start` is when the program began.
  void start(hal::TimePoint process_start);

  // Tells systemd that the end was requested. The watchdog is no longer kicked.
  void stop();

  ThreadWatch& threads() { return threads_; }
  PictureProof& picture() { return picture_; }
  CrashReport& crash_report() { return crash_report_; }

  // The render thread passes its status at most once a second.
  bool wants_status(hal::TimePoint now) const { return now >= next_status_; }
  void tell(PictureStatus status);

private:
  void check_last_run();
  void run();
  void step(hal::TimePoint now);
  void look(hal::TimePoint now); // once a second
  void write_metrics(hal::TimePoint now);
  ApplianceStatus status() const;

  const SupervisionSetup setup_;
  CrashReport& crash_report_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  std::optional<RunMarker> marker_;
  ThreadWatch threads_;
  PictureProof picture_;
  ServiceManager manager_;
  Watchdog watchdog_;
  HostWatch host_;
  FaultJournal journal_;
  hal::TimePoint process_start_;
  hal::TimePoint next_status_{};
  hal::TimePoint next_look_{}, next_metrics_{};
  bool ready_ = false;
  bool volume_told_ = false; // the journal was told that there is one

  mutable std::mutex mutex_;
  std::optional<PictureStatus> told_; // by the render thread
  HostFindings host_findings_;

  std::unique_ptr<StatusServer> server_;
  pipeline::Wakeup wakeup_;
  pipeline::RoleThread thread_{&wakeup_};
};

} // namespace octascope::firmware_host

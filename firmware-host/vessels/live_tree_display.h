// Which tree traced in the live flow is drawn, how old it is, and when it no longer may be.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "firmware-host/vessels/live_tree.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/threads/background_task.h"
#include "pipeline/threads/wakeup.h"
#include "pipeline/volume/volume.h"
#include "ui/status/status.h"

namespace octascope::firmware_host {

// The newest tree is drawn, unless it was refused or is older than TracedTreeStatus::removed_after. Of a
// frozen picture the age is the one that the tree had then; the frozen volume itself is traced, too.
// A tree is drawn in the picture after that of a new volume, or when none has come for `longest_wait`.
//
// Bound to the render thread.
class LiveTreeDisplay {
public:
  // As LiveTreeThread.
  LiveTreeDisplay(hal::Clock& clock, pipeline::Wakeup& news, pipeline::ThreadSetup setup = {})
      : clock_{clock}, thread_{clock, news, std::move(setup)} {}

  static constexpr hal::Duration longest_wait = std::chrono::milliseconds{500};
  // Trees more often than that would show nothing more, and tracing takes memory's time from the picture: a
  // tree that nobody sees is only kept young enough to be shown at once when it is asked for.
  static constexpr hal::Duration interval_seen = std::chrono::milliseconds{500};
  static constexpr hal::Duration interval_unseen = std::chrono::seconds{5};

  // `shown`: the whole volume of the picture; null while there is none. True: drawn() is another one. The
  // one before it stays in memory until the next call.
  bool advance(const pipeline::Volume* shown, bool frozen);

  // Has that volume traced, if it is time; `seen`: its tree is drawn or needed otherwise. Best after a frame,
  // as it copies.
  void trace(const pipeline::Volume& shown, bool seen) {
    thread_.offer(shown, seen ? interval_seen : interval_unseen);
  }

  // Null: none is to be drawn.
  const LiveTree* drawn() const { return drawn_.get(); }
  // Drawn or not; null until the first.
  const std::shared_ptr<const LiveTree>& newest() const { return newest_; }
  // Empty until the first.
  const std::optional<ui::TracedTreeStatus>& status() const { return status_; }
  LiveTreeThread::Counters counters() const { return thread_.counters(); }

  // Writes the drawn tree into `folder` as SWC, beside the running display; only its owner may read it.
  // Nothing if none is drawn, or while the last one is being written.
  void keep(const std::filesystem::path& folder);
  // The file or the error, once for each that was written.
  std::optional<hal::Result<std::filesystem::path>> take_kept() { return writing_.take(); }

private:
  bool may_take(const pipeline::Volume* shown);

  hal::Clock& clock_;
  LiveTreeThread thread_;
  std::shared_ptr<const LiveTree> newest_, drawn_, before_;
  std::optional<ui::TracedTreeStatus> status_;
  std::optional<hal::TimePoint> shown_last_; // the last line of that volume
  bool was_new_ = false;                     // in the last call
  hal::TimePoint volume_came_{};
  pipeline::BackgroundTask<hal::Result<std::filesystem::path>> writing_;
};

} // namespace octascope::firmware_host

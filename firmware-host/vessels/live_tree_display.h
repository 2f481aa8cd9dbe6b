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
//
// Bound to the render thread.
class LiveTreeDisplay {
public:
  // As LiveTreeThread.
  LiveTreeDisplay(hal::Clock& clock, pipeline::Wakeup& news, pipeline::ThreadSetup setup = {})
      : clock_{clock}, thread_{clock, news, std::move(setup)} {}

  // `shown`: the whole volume of the picture; null while there is none. True: drawn() is another one. The
  // one before it stays in memory until the next call.
  bool advance(const pipeline::Volume* shown, bool frozen);

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
  hal::Clock& clock_;
  LiveTreeThread thread_;
  std::shared_ptr<const LiveTree> newest_, drawn_, before_;
  std::optional<ui::TracedTreeStatus> status_;
  pipeline::BackgroundTask<hal::Result<std::filesystem::path>> writing_;
};

} // namespace octascope::firmware_host

// Keeps a loaded tree where the tissue is, beside the running display (tree_following.h).
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "firmware-host/vessels/live_tree.h"
#include "firmware-host/vessels/vessel_source.h"
#include "hal/clock.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/wakeup.h"
#include "pipeline/vessels/following/tree_following.h"
#include "pipeline/volume/volume.h"

namespace octascope::firmware_host {

// One job at a time, as LiveTreeThread: nothing is locked.
class VesselFollower {
public:
  // `vessels` is read by the thread until this ends; `start` is where they lie, if somebody said.
  // `news` is posted with each new place; it and `clock` outlive this.
  VesselFollower(const LoadedVessels& vessels, const std::optional<pipeline::RigidTransform>& start,
                 hal::Clock& clock, pipeline::Wakeup& news, pipeline::ThreadSetup setup = {});
  VesselFollower(const VesselFollower&) = delete;
  VesselFollower& operator=(const VesselFollower&) = delete;

  // All of these: the render thread.

  // Copies the volume's levels, some milliseconds, if the thread is idle, the volume is another than the last
  // one, and that was at least `least_interval` ago.
  void offer(const pipeline::Volume& volume);
  // A tree that was traced, the same as often as one likes; the newest that was not refused waits for the
  // thread. Null is none.
  void offer(const std::shared_ptr<const LiveTree>& tree);
  // Somebody says that it lies about there: it is looked for anew.
  void begin_at(const pipeline::RigidTransform& place);
  // Where the tree lies now, once for each time that it was looked for.
  std::optional<pipeline::FollowedPlace> take();

  static constexpr hal::Duration least_interval = std::chrono::milliseconds{200};

private:
  enum class Turn : std::uint8_t { starting, idle, at_work, finished };

  void run();
  void follow(pipeline::TreeFollowing& following);

  const LoadedVessels& vessels_;
  const std::optional<pipeline::RigidTransform> start_;
  hal::Clock& clock_;
  pipeline::Wakeup& news_;
  const pipeline::ThreadSetup setup_;
  pipeline::Wakeup wakeup_;
  std::atomic<Turn> turn_{Turn::idle};

  // The render thread's.
  std::optional<hal::TimePoint> offered_;
  std::shared_ptr<const LiveTree> waiting_;
  std::uint64_t offered_tree_ = 0; // its number
  std::optional<pipeline::RigidTransform> begin_at_;
  bool outdated_ = false; // what the thread is at has begun before begin_at()

  // Of the thread while it is at work or starts, else of the render thread.
  pipeline::VolumeGeometry geometry_;
  std::vector<std::uint8_t> levels_;
  std::vector<pipeline::BScanState> states_;
  std::uint64_t index_ = 0;
  std::shared_ptr<const LiveTree> tree_; // null: none is new
  std::optional<pipeline::RigidTransform> begins_at_;
  pipeline::FollowedPlace place_;

  pipeline::RoleThread thread_{&wakeup_}; // last: it uses all of the above
};

} // namespace octascope::firmware_host

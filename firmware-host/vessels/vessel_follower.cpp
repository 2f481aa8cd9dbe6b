#include "firmware-host/vessels/vessel_follower.h"

#include <utility>

#include "pipeline/vessels/clusters/cluster_unpacker.h"

namespace octascope::firmware_host {

VesselFollower::VesselFollower(const LoadedVessels& vessels,
                               const std::optional<pipeline::RigidTransform>& start,
                               hal::Clock& clock, pipeline::Wakeup& news,
                               pipeline::ThreadSetup setup)
    : vessels_{vessels}, start_{start}, clock_{clock}, news_{news}, setup_{std::move(setup)} {}

void VesselFollower::offer(const pipeline::Volume& volume) {
  if (turn_.load(std::memory_order_acquire) != Turn::idle)
    return;
  if (!thread_.started()) {
    geometry_ = volume.geometry;
    turn_.store(Turn::starting, std::memory_order_relaxed);
    thread_.start({"follower"}, setup_, [this] { run(); });
    return;
  }
  const hal::TimePoint now = clock_.now();
  // In a frozen volume, too, a tree may be traced, or its place be kept.
  const bool nothing_new = volume.metadata.index == index_ && !waiting_ && !begin_at_;
  if (offered_ && (nothing_new || now - *offered_ < least_interval))
    return;
  offered_ = now;
  index_ = volume.metadata.index;
  geometry_ = volume.geometry;
  levels_.assign(volume.levels.begin(), volume.levels.end());
  states_.assign(volume.b_scan_states.begin(), volume.b_scan_states.end());
  tree_ = std::move(waiting_);
  begins_at_ = std::exchange(begin_at_, std::nullopt);
  turn_.store(Turn::at_work, std::memory_order_release);
  wakeup_.post();
}

void VesselFollower::offer(const std::shared_ptr<const LiveTree>& tree) {
  if (!tree || tree->number == offered_tree_)
    return;
  offered_tree_ = tree->number;
  if (tree->refusal.empty())
    waiting_ = tree;
}

void VesselFollower::begin_at(const pipeline::RigidTransform& place) {
  begin_at_ = place;
  const Turn turn = turn_.load(std::memory_order_acquire);
  outdated_ = turn == Turn::at_work || turn == Turn::finished;
}

std::optional<pipeline::FollowedPlace> VesselFollower::take() {
  if (turn_.load(std::memory_order_acquire) != Turn::finished)
    return std::nullopt;
  std::optional<pipeline::FollowedPlace> place;
  if (!std::exchange(outdated_, false))
    place = std::move(place_);
  turn_.store(Turn::idle, std::memory_order_relaxed);
  return place;
}

void VesselFollower::run() {
  levels_.reserve(geometry_.voxels());
  states_.reserve(static_cast<std::size_t>(geometry_.b_scans));
  auto tree = pipeline::unpack_tree(vessels_.clusters());
  // What is drawn was checked when it was read: with the rings that this refuses, nothing is found.
  pipeline::TreeFollowing following{tree ? std::move(*tree) : pipeline::VesselTree{}, start_};
  turn_.store(Turn::idle, std::memory_order_release);
  while (!thread_.stopping()) {
    wakeup_.wait();
    if (!thread_.stopping() && turn_.load(std::memory_order_acquire) == Turn::at_work)
      follow(following);
  }
}

void VesselFollower::follow(pipeline::TreeFollowing& following) {
  if (begins_at_)
    following.begin_at(*begins_at_);
  following.add_volume(geometry_, levels_, states_, index_);
  if (tree_)
    following.add_tree(tree_->tree, tree_->volume_index);
  tree_.reset();
  place_ = following.place();
  turn_.store(Turn::finished, std::memory_order_release);
  news_.post();
}

} // namespace octascope::firmware_host

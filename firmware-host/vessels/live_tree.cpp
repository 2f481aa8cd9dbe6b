#include "firmware-host/vessels/live_tree.h"

#include <algorithm>
#include <utility>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "pipeline/vessels/clusters/cluster_facts.h"
#include "pipeline/vessels/straight_nodes.h"
#include "pipeline/vessels/tree_summary.h"

namespace octascope::firmware_host {

namespace {

// Each branch point joins three vessels or more, and makes one of them two or more.
std::uint64_t vessels_of(const pipeline::VesselTree& tree) {
  std::vector<std::uint8_t> children(tree.nodes());
  for (const std::uint32_t parent : tree.parents)
    if (parent != pipeline::no_parent)
      children[parent] = static_cast<std::uint8_t>(std::min(children[parent] + 1, 2));
  std::uint64_t ends = 0; // of vessels, away from their root
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    ends += tree.parents[i] != pipeline::no_parent && children[i] != 1 ? 1U : 0U;
  return ends;
}

// Less than the finest voxel. The flat pictures have room for so many segments (ui/vessels/sections/near_segments.h), of which
// tracing makes one for each radius of length, and then leave out the thinnest.
constexpr double unseen_mm = 0.003;

void pack(LiveTree& found, const std::stop_token& stop) {
  if (!found.refusal.empty() || found.tree.nodes() == 0)
    return;
  const pipeline::VesselTree drawn = pipeline::without_straight_nodes(found.tree, unseen_mm);
  pipeline::ClusterArrays arrays = pipeline::build_clusters(drawn, stop);
  auto facts = pipeline::facts_of(drawn, arrays.error, "traced in the live volume");
  found.packed.emplace(std::move(arrays), std::move(facts));
  found.vessels = vessels_of(found.tree);
  found.length_mm = pipeline::summarise(found.tree).length_mm;
}

} // namespace

LiveTreeThread::LiveTreeThread(hal::Clock& clock, pipeline::Wakeup& news,
                               pipeline::ThreadSetup setup)
    : clock_{clock}, news_{news}, setup_{std::move(setup)} {}

LiveTreeThread::~LiveTreeThread() {
  stop_.request_stop();
}

void LiveTreeThread::offer(const pipeline::Volume& volume, hal::Duration interval) {
  const std::uint64_t index = volume.metadata.index;
  const bool just_came = std::exchange(seen_index_, index) != index;
  if (!volume.has_flow() || turn_.load(std::memory_order_acquire) != Turn::idle)
    return;
  if (!thread_.started()) {
    geometry_ = volume.geometry;
    turn_.store(Turn::starting, std::memory_order_relaxed);
    thread_.start({"tree"}, setup_, [this] { run(); });
    return;
  }
  const hal::TimePoint now = clock_.now();
  if (offered_ && (index == traced_index_ ||
                   now - *offered_ < interval + (just_came ? hal::Duration{} : patience)))
    return;
  offered_ = now;
  traced_index_ = index;
  geometry_ = volume.geometry;
  flow_.assign(volume.flow.begin(), volume.flow.end());
  tree_ = std::make_shared<LiveTree>();
  tree_->of_volume = volume.metadata.last_line;
  tree_->volume_index = index;
  tree_->number = ++count_;
  turn_.store(Turn::at_work, std::memory_order_release);
  wakeup_.post();
}

std::shared_ptr<const LiveTree> LiveTreeThread::take() {
  if (turn_.load(std::memory_order_acquire) != Turn::finished)
    return nullptr;
  refused_ += tree_->refusal.empty() ? 0U : 1U;
  std::shared_ptr<const LiveTree> found = std::move(tree_);
  turn_.store(Turn::idle, std::memory_order_relaxed);
  return found;
}

LiveTreeThread::Counters LiveTreeThread::counters() const {
  const pipeline::DurationSummary took = took_.summary();
  return {took.count - std::min(refused_, took.count), refused_, took};
}

void LiveTreeThread::run() {
  flow_.resize(geometry_.voxels());
  turn_.store(Turn::idle, std::memory_order_release);
  news_.post();
  while (!thread_.stopping()) {
    wakeup_.wait();
    if (!thread_.stopping() && turn_.load(std::memory_order_acquire) == Turn::at_work)
      trace();
  }
}

void LiveTreeThread::trace() {
  const hal::TimePoint begin = clock_.now();
  auto traced = tracer_.trace(geometry_, flow_, stop_.get_token());
  if (traced) {
    tree_->tree = std::move(traced->tree);
    tree_->quality = traced->quality;
    tree_->refusal = std::move(traced->refusal);
  } else {
    tree_->refusal = traced.error().message;
  }
  pack(*tree_, stop_.get_token());
  took_.add(clock_.now() - begin);
  turn_.store(Turn::finished, std::memory_order_release);
  news_.post();
}

} // namespace octascope::firmware_host

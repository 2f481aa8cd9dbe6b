#include "pipeline/vessels/following/tree_following.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace octascope::pipeline {

namespace {

// A tree takes less time to trace than as many volumes that are 200 ms apart, on a busy machine, too.
constexpr std::size_t most_seen = 16;

std::uint64_t apart(std::uint64_t a, std::uint64_t b) {
  return a < b ? b - a : a - b;
}

} // namespace

TreeFollowing::TreeFollowing(VesselTree tree, const std::optional<RigidTransform>& start)
    : tree_{std::move(tree)}, registered_{start.value_or(RigidTransform{})} {}

void TreeFollowing::begin_at(const RigidTransform& start) {
  registered_ = start;
  known_ = false;
  misses_ = 0;
  left_alone_ = 0;
  place_ = {};
}

void TreeFollowing::add_volume(const VolumeGeometry& geometry, std::span<const std::uint8_t> levels,
                               std::span<const BScanState> states, std::uint64_t index) {
  if (geometry_ != geometry) {
    geometry_ = geometry;
    motion_.emplace(geometry);
    seen_.clear();
    reference_.reset();
    if (known_)
      lose("the volume has another shape");
  }
  auto spectrum = motion_->spectrum(levels, states);
  if (!spectrum)
    return; // the display says that it is incomplete
  if (known_) {
    place_.volume_from_tree = moved_to(*spectrum);
    if (!place_.volume_from_tree)
      lose("the volume has moved too far or is of another place");
  }
  seen_.push_back({index, std::move(*spectrum)});
  if (seen_.size() > most_seen)
    seen_.pop_front();
}

const TreeFollowing::Seen& TreeFollowing::nearest(std::uint64_t index) const {
  return *std::ranges::min_element(seen_, {},
                                   [&](const Seen& seen) { return apart(seen.index, index); });
}

std::optional<RigidTransform> TreeFollowing::moved_to(const VolumeSpectrum& volume) {
  if (!reference_)
    return registered_;
  const VolumeShift moved = motion_->shift(*reference_, volume);
  if (!moved.found)
    return std::nullopt;
  RigidTransform shift;
  shift.shift_mm = moved.shift_mm;
  return shift * registered_;
}

void TreeFollowing::add_tree(const VesselTree& live, std::uint64_t volume_index) {
  if (!geometry_)
    return;
  if (left_alone_ > 0) {
    --left_alone_;
    return;
  }
  // What moved since a volume that was not seen is not known.
  if (seen_.empty() || volume_index < seen_.front().index)
    return;
  const Seen& traced_in = nearest(volume_index);
  const RigidTransform start =
      known_ ? moved_to(traced_in.spectrum).value_or(registered_) : registered_;
  if (known_)
    if (const auto found = register_trees(tree_, live, start, next_reach); found.refusal.empty())
      return accept(found, traced_in);
  const double side_mm = std::max(geometry_->a_mm(), geometry_->b_mm());
  const auto found = register_trees(tree_, live, start, first_reach(side_mm));
  if (found.refusal.empty())
    accept(found, traced_in);
  else
    miss(found.refusal);
}

void TreeFollowing::accept(const TreeRegistration& found, const Seen& traced_in) {
  registered_ = found.live_from_planned;
  reference_ = traced_in.spectrum;
  known_ = true;
  misses_ = 0;
  place_ = {.volume_from_tree = registered_,
            .residual_mm = found.residual_mm,
            .overlap = found.overlap,
            .refusal = {}};
  place_.volume_from_tree = moved_to(seen_.back().spectrum);
  if (!place_.volume_from_tree)
    lose("the volume has moved too far or is of another place");
}

void TreeFollowing::miss(const std::string& refusal) {
  ++misses_;
  if (known_ && misses_ < most_misses) {
    place_.refusal = refusal;
    return;
  }
  left_alone_ = trees_between_searches;
  lose(refusal);
}

void TreeFollowing::lose(std::string refusal) {
  known_ = false;
  misses_ = 0;
  place_.volume_from_tree.reset();
  place_.refusal = std::move(refusal);
}

} // namespace octascope::pipeline
